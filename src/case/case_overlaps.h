/* Which discs of a scene overlap at the start, and by how much: with each other, and with the sides that hold them. */
#ifndef DELBM_CASE_CASE_OVERLAPS_H
#define DELBM_CASE_CASE_OVERLAPS_H

#include "base/status.h"
#include "model/scene.h"

/* Of disc a with disc b, or with a side: then b is overlap_sides + the side. Only where a contact acts: one of the two is
 * a free disc. */
struct case_overlap {
  size_t a, b;
  double depth; /* cells, along the line of centres or the normal of the side */
};

static const size_t overlap_sides = SIZE_MAX - SIDE_COUNT;

struct case_overlaps {
  struct case_overlap *list;
  size_t count, capacity;
};

/* Overlaps of the first `discs` discs, in the order of their left edges. To be freed with case_overlaps_clear, also on
 * failure, which is want of memory. */
bool case_overlaps_find(const struct scene *scene, size_t discs, struct case_overlaps *found, struct status *status);
void case_overlaps_clear(struct case_overlaps *found);

/* The largest depth at which the fluid follows a disc that is pushed out, in cells: with a side, and with a disc, which
 * moves away likewise. Fluid under a disc moves with it, so that one which leaves a side by h thins the fluid beside the
 * side by exp(-h), but for what flows in through the cells there: from 5 cells on this ended in fluid without density
 * or above Mach 0.6 (radii 2 to 10, densities 0.1 to 50, viscosities 0.005 to 0.5). */
static const double max_depth_in_side = 4, max_depth_in_disc = 8;

static inline bool case_overlap_is_with_side(const struct case_overlap *overlap)
{
  return overlap->b >= overlap_sides;
}

#endif
