/* Shape of a heap of discs that lies against the side x = 0: its contiguous mass, front and free surface. */
#ifndef DELBM_BENCH_HEAP_H
#define DELBM_BENCH_HEAP_H

#include "solid/discs.h"

struct heap {
  size_t count;  /* discs of the mass: the largest group of free discs that touch, directly or by others */
  double front;  /* right end of the mass, x */
  double height; /* mean height of the free surface over the first 3 R from the side, above the floor */
  double
      slope; /* of the free surface, least squares between 0.1 and 0.9 of the front: tangent of its angle, downwards */
  double kinetic; /* mean square of the speeds in the mass */
};

/* Discs touch if the gap is below `gap`; `floor`: height of the ground; `radius`: mean radius. Fixed discs are no part of
 * the heap, and hence connect nothing. */
bool heap_of(struct heap *heap, const struct discs *discs, double gap, double floor, double radius,
             struct status *status);

#endif
