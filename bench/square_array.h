/* The drag of a square array of discs, K = F/(mu U): exact values, and results of scenes. */
#ifndef DELBM_BENCH_SQUARE_ARRAY_H
#define DELBM_BENCH_SQUARE_ARRAY_H

#include "accuracy.h"

/* Solid fraction, and the converged series of Sangani & Acrivos (1982), who print 51.53 at 0.2. */
struct square_array {
  double fraction, drag;
};

enum { SQUARE_ARRAYS = 6 };
static const struct square_array square_arrays[SQUARE_ARRAYS] = {{0.05, 15.55782}, {0.1, 24.83168}, {0.2, 51.52695},
                                                                 {0.3, 102.8813},  {0.4, 217.8943}, {0.5, 532.5481}};

/* Drag in the steady state of scene_square_array. */
bool square_array_drag(const struct scene *scene, double *drag, struct accuracy_outcome *cost, struct status *status);

/* Relative error of the drag with the centre at `offset` from a corner of cells. */
bool square_array_error(const struct square_array *array, const struct accuracy_choice *choice, double radius,
                        double viscosity, const struct offset *offset, double *error, struct accuracy_outcome *cost,
                        struct status *status);

#endif
