/* A case while it is read: scene so far, source tree, errors so far. The table of keys maps each key to a field. */
#ifndef DELBM_CASE_CASE_DRAFT_H
#define DELBM_CASE_CASE_DRAFT_H

#include "case/case_errors.h"
#include "case/case_tree.h"
#include "model/scene.h"

/* A listed disc while it is read. A density of 0: not specified. */
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
  const char *title;        /* title and kernel point into the tree */
  const char *kernel;       /* NULL: auto */
  int pattern;              /* particles.fill.pattern */
  double lattice_viscosity; /* units.viscosity; 0: not specified */
  double density;           /* particles.density; 0: not specified */
  double size_as_given[2];  /* domain.size before rounding to whole cells; 0: not rounded */
};

#endif
