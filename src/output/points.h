/* Discs as points: all discs in order, then the images of discs that cross a periodic side. */
#ifndef DELBM_OUTPUT_POINTS_H
#define DELBM_OUTPUT_POINTS_H

#include "solid/discs.h"

struct points {
  size_t count, capacity;
  int64_t *id;                 /* of the disc */
  double *position, *velocity; /* three numbers each, the third 0 */
  double *radius, *angle, *spin;
};

/* Replaces the points (at first {0}) by the discs' points. Fails only for want of memory. */
bool points_take(struct points *points, const struct scene *scene, const struct discs *discs, struct status *status);
void points_clear(struct points *points);

#endif
