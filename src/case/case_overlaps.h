/* Overlaps of discs with each other, and with sides that are not periodic, in the initial state of a scene. */
#ifndef DELBM_CASE_CASE_OVERLAPS_H
#define DELBM_CASE_CASE_OVERLAPS_H

#include "base/status.h"
#include "model/scene.h"

/* Overlap of disc a with disc b, or with side b - overlap_sides. Pairs without a free disc have no contact and are left
 * out. */
struct case_overlap {
  size_t a, b;
  double depth; /* cells, along the line of centres or the normal of the side */
};

static const size_t overlap_sides = SIZE_MAX - SIDE_COUNT;

struct case_overlaps {
  struct case_overlap *list;
  size_t count, capacity;
};

/* Overlaps of the first `discs` discs, in the order of their left edges. To be released with case_overlaps_clear, also
 * on failure (lack of memory). */
bool case_overlaps_find(const struct scene *scene, size_t discs, struct case_overlaps *found, struct status *status);
void case_overlaps_clear(struct case_overlaps *found);

/* Largest initial overlap, cells. Fluid inside a disc moves with it: a disc that a contact pushes out of a side by h
 * cells lowers the density beside the side by a factor exp(-h), less the inflow. Overlaps of 5 cells and more ended
 * with zero density or above Mach 0.6 (radii 2 to 10, densities 0.1 to 50, viscosities 0.005 to 0.5). Of two discs
 * each moves half as far. */
static const double max_depth_in_side = 4, max_depth_in_disc = 8;

static inline bool case_overlap_is_with_side(const struct case_overlap *overlap)
{
  return overlap->b >= overlap_sides;
}

#endif
