/* A case while it is read: the scene as far as it is known, the tree it comes from, and the errors found so far. The table
 * of keys says which field each key fills in. */
#ifndef DELBM_CASE_CASE_DRAFT_H
#define DELBM_CASE_CASE_DRAFT_H

#include "case/case_errors.h"
#include "case/case_tree.h"
#include "model/scene.h"

/* A listed disc while it is read; a density of 0 is not given. */
struct disc_draft {
  struct disc_spec spec;
  bool fixed;
  bool driven;
};

struct draft {
  struct tree_node *root;
  struct case_errors *errors;
  struct disc_draft disc; /* defaults of a listed disc */
  struct scene scene;
  const char *title;        /* these two lie in the tree */
  const char *kernel;       /* NULL: auto */
  int pattern;              /* the one there is */
  double lattice_viscosity; /* units.viscosity; 0: not given */
  double density;           /* particles.density; 0: not given */
  double size_as_given[2];  /* domain.size before it was rounded to whole cells; 0: it was not */
};

#endif
