/* The step as the paper states it, cell by cell: two arrays of full populations, the moment matrix, a search for the
 * source cell of every population. Slow; the reference of every fast kernel in tests and benchmarks. */
#ifndef DELBM_BENCH_REFERENCE_H
#define DELBM_BENCH_REFERENCE_H

#include "fluid/sweep.h"

/* A ghost cell of an outlet: d and cut of fluid/boundary.c, and 3 (rho - j) of the cell beside it one step ago. */
struct reference_ghost {
  double drift, cut, last;
};

struct reference {
  int nx, ny;
  double *f, *collided;                      /* [(y * nx + x) * Q + i] */
  struct reference_ghost *ghost[SIDE_COUNT]; /* of outlets, by cell of the box */
  bool stepped;
};

/* Per cell B and B v, over the whole box; NULL arrays for fluid alone. */
struct reference_cover {
  enum coupling_form form;
  const double *b, *bvx, *bvy;
};

bool reference_create(struct reference *reference, int nx, int ny, struct status *status);
void reference_destroy(struct reference *reference);
void reference_step(struct reference *reference, const struct side side[SIDE_COUNT],
                    const struct sweep_constants *constants, const struct reference_cover *cover);

#endif
