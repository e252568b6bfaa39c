/* The sides of the box: populations that enter from outside (rules and equations: boundary.c; a row of the table in
 * side_rules.c for each kind). Rows may be updated in any order that streaming allows, by any thread. */
#ifndef DELBM_FLUID_BOUNDARY_H
#define DELBM_FLUID_BOUNDARY_H

#include "fluid/links.h"

/* h: small enough to transmit the lowest tone of the box, of angular frequency c_s pi/(2 L), L the longer edge. */
static inline double boundary_outlet_rate(int nx, int ny)
{
  const int longest = nx > ny ? nx : ny;
  return longest > 5 ? 0.5 / longest : 0.1;
}

/* For fluid at rest. `side` must outlive the boundary. */
bool boundary_create(struct boundary *boundary, const struct side side[SIDE_COUNT], int nx, int ny,
                     struct status *status);
void boundary_destroy(struct boundary *boundary);

/* Updates the links with sources x0 .. x1 - 1 of row y, which have completed the step of populations->parity. */
void boundary_after(struct boundary *boundary, struct populations *populations, int y, int x0, int x1);

/* Prefetches the ghost cells that boundary_after writes for row y: in a step of parity 0 the sweep does not access
 * them. */
void boundary_prefetch(const struct populations *populations, int y);

/* Restores the received populations of all links after populations_store and boundary_store have read a checkpoint. */
void boundary_refill(struct boundary *boundary, struct populations *populations);

/* Resets the states of sides, from populations of parity 0 before their collision. */
void boundary_reset(struct boundary *boundary, const struct populations *populations);

/* Saves or restores the states of sides. */
bool boundary_store(struct boundary *boundary, struct store *store, struct status *status);

#endif
