/* The sides of the box, as rules for the links through which populations come in from outside.
 *
 * A link is a cell at the edge and one of the populations that reach it from outside. Once a cell has taken a step, each
 * rule writes, from what that cell sent out, the population that some cell of the edge receives in the next step:
 *
 *   received_i(target) = a sent_m(source) + c[k],   k the number of the source along the side
 *
 *   wall, inlet  half-way bounce-back: target = source, m the opposite of i, c = 6 w_i e_i.u, the momentum of a wall or
 *                inflow of velocity u at the reference density.
 *   periodic     the source is the cell at the other end of the row, m = i, c = 0. Rows wrap in y by their address alone
 *                (populations.h).
 *   slip         the mirror image: target one cell along the side from the source, in the direction of e_i, m is i with its
 *                normal component reversed, c = 0. No fluid passes, and no shear stress acts along the side.
 *   outlet       zero gradient: a ghost cell beside the source sends what the source sends, m = i, c = -w_i cut. The
 *                density of the ghost thereby lies below that of the source by
 *                  cut = h e + d,   (6/h) dd/dt = 3 d(e - j)/dt + cut - d,
 *                e the excess over the reference density, taken at the face between both cells, and j the momentum along
 *                the outward normal. Sound that passes changes 3 (e - j) by -cut a step; whatever else changes it, which
 *                is pressure gradient and friction of the flow, d estimates. Sound is then reflected by the factor
 *                -((2 - sqrt(3)) s + k)/(s + k), k = h/(3 + sqrt(3)), s = i times the angular frequency, whatever d does;
 *                and the excess of steady flow, which with cut = h e would be its pressure gradient over h, vanishes
 *                within some times 6/h steps.
 *
 * a = 1 in all of these. Where m has the component of i along the side, the target is one cell farther along it than the source.
 * side_rules.c has a row for each kind.
 *
 * Corners. The diagonal link that comes out of the corner of two sides, neither of them periodic, takes each component of the
 * velocity from the side normal to it, which imposes its own: that of an inlet, 0 of a wall or slip side. An outlet imposes none, and the
 * component is that of the other side, which runs into it. m has the imposed components reversed, and c is the momentum at that
 * velocity. So inlets let in exactly velocity times length, walls that run into a corner push no fluid through the other
 * wall, and a uniform stream stays uniform. At the corner of two outlets no component is imposed, and the ghost cell has the mean
 * cut of its neighbours. A slip side imposes nothing along itself: at its corner with an outlet it reflects what the
 * ghost cell of the outlet sends.
 *
 * Every slot that a rule writes belongs to its link, or to the ghost cell, alone (populations.h): rows may run in any
 * order that streaming allows, on any thread. */
#ifndef DELBM_FLUID_BOUNDARY_H
#define DELBM_FLUID_BOUNDARY_H

#include "fluid/links.h"

/* h. The lowest tone of a box has the angular frequency c_s pi/(2 L), L its length, and is to get out. */
static inline double boundary_outlet_hold(int nx, int ny)
{
  const int longest = nx > ny ? nx : ny;
  return longest > 5 ? 0.5 / longest : 0.1;
}

/* For fluid at rest. The sides must outlive the boundary. */
bool boundary_create(struct boundary *boundary, const struct side side[SIDE_COUNT], int nx, int ny,
                     struct status *status);
void boundary_destroy(struct boundary *boundary);

/* What the links receive once cells x0 .. x1 - 1 of row y have taken the step of populations->parity. */
void boundary_after(struct boundary *boundary, struct populations *populations, int y, int x0, int x1);

/* Brings the ghosts that boundary_after will write for row y into cache while the row is swept: in a step of parity 0 no
 * sweep touches them. */
void boundary_prefetch(const struct populations *populations, int y);

/* What all links receive in the coming step, from populations that were read from a checkpoint. */
void boundary_refill(struct boundary *boundary, struct populations *populations);

/* Starts sides with a state anew, with populations (of parity 0) that have been written and not yet collided. */
void boundary_reset(struct boundary *boundary, const struct populations *populations);

/* Saves or restores the states of sides. */
bool boundary_store(struct boundary *boundary, struct store *store, struct status *status);

#endif
