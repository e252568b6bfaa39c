/* A case while it is read: the scene as far as it is known, the tree it comes from, and the errors found so far. */
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
  double magic;             /* 0: not given */
  double lattice_viscosity; /* units.viscosity; 0: not given */
  double density;           /* particles.density; 0: not given */
  double size_as_given[2];  /* domain.size before it was rounded to whole cells; 0: it was not */
};

/* True if the case gives the key (with any value). */
bool draft_gives(const struct draft *draft, const char *path);

/* True if the key's value can be relied on: given as the table allows, or left to its default. */
bool draft_knows(const struct draft *draft, const char *path);

/* fluid.collision as given, or what the other keys imply. */
enum collision draft_collision(const struct draft *draft);

/* Records an error at the key's place: `got` its value, or that it is missing, and what is expected instead. */
void draft_refuse(struct draft *draft, const char *path, const char *expected, ...)
    __attribute__((format(printf, 3, 4)));

/* The region of particles.fill: as given, or the box. */
void draft_fill_region(const struct draft *draft, double region[4]);

#endif
