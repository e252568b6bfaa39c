/* Boundaries, as passes over the ghost ring around the steps of parity 1; with parity 0 there is nothing to do.
 *
 * A link is a cell at the edge and a population that comes from outside. In parity 1 the cell reads that population
 * from, and writes the one that leaves to, the same ghost slot G. Before its row is swept G must hold what arrives;
 * afterwards what left must be put where the next step, of parity 0, looks for what arrives.
 *
 *   wall, inlet  half-way bounce-back: what left comes back with the wall's momentum (6 w rho e.u at the reference
 *                density).
 *   periodic     what left on the other side. In y the addresses wrap by themselves (populations.h).
 *   outlet       zero gradient along the normal: what arrives is what the edge cell itself sends inwards, but for a
 *                part of the cell's excess density. That holds the mean pressure, which a bare zero gradient lets
 *                drift, and is weak enough to let sound out.
 *
 * Each row has passes of its own that touch only slots of that row's cells: rows may run in any order and on any
 * thread. The one exception is an outlet, whose ghosts are read by the cells of the rows next to theirs, too: there all
 * rows must be filled before any is swept (boundary_fill_first), and a row's neighbours before it is read. At a corner a
 * wall wins over an inlet, that over an outlet, that over a periodic side; y wins over x among equals. */
#ifndef DELBM_FLUID_BOUNDARY_H
#define DELBM_FLUID_BOUNDARY_H

#include "fluid/populations.h"

/* The part of an edge cell's excess density that an outlet takes away each step, in a box of nx x ny cells. Sound that
 * meets the outlet sees its zero gradient, which lets most of it out, only where its angular frequency is well above a
 * third of this; below, the outlet holds the pressure and returns all of it. So the hold falls with the box, whose lowest
 * tone has the angular frequency c_s pi/(2 L). */
static inline double boundary_outlet_hold(int nx, int ny)
{
  const int longest = nx > ny ? nx : ny;
  return longest > 5 ? 0.5 / longest : 0.1;
}

/* Fills the ghosts that row y reads in a step of parity 1, but for those of outlets: of these the ones beside the row's own
 * cells, which the rows next to it read too. May be repeated before that step. */
void boundary_before_row(struct populations *populations, const struct side side[SIDE_COUNT], int y);

/* The two parts of that: what outlets fill, from what the row's own cells have left in the step before, and the rest. */
void boundary_outlets_before_row(struct populations *populations, const struct side side[SIDE_COUNT], int y);
void boundary_others_before_row(struct populations *populations, const struct side side[SIDE_COUNT], int y);

/* The same for cells x0 .. x1 - 1 of row y alone, where no side is an outlet. */
void boundary_before(struct populations *populations, const struct side side[SIDE_COUNT], int y, int x0, int x1);
void boundary_after(struct populations *populations, const struct side side[SIDE_COUNT], int y, int x0, int x1);

/* True where boundary_before_row of every row must precede the sweep of any. */
bool boundary_fill_first(const struct side side[SIDE_COUNT]);

/* Brings what row y left in ghosts to where the next step reads it. */
void boundary_after_row(struct populations *populations, const struct side side[SIDE_COUNT], int y);

#endif
