/* Exchange: the momentum that fluid and discs hand each other, solved for the discs' new velocities.
 *
 * A cell hands the fluid B (-2 j + 2 rho v), j with the force of the step: linear in the disc's velocity. Over the
 * cells of a disc, with b = 2 w_p B and lever arm r, the streamed, not yet collided populations give
 *   P = sum b j, L = sum b (r x j), M0 = sum b rho, M1 = sum b rho r, M2 = sum b rho |r|^2,
 * and the change of velocity dV = (dVx, dVy, domega) over the step follows from
 *   A dV = R + J,  A = diag(m - m_f, m - m_f, I - I_f) + M,  R = weight + (P, L) - M V,
 *        | M0    0    -M1y |
 *   M =  | 0     M0    M1x |     J: impulse of all contacts of the step.
 *        | -M1y  M1x   M2  |
 * The gather stops short of J: it leaves A^-1 and A^-1 R, and contacts (sim/contacts.c), however many sub-steps they
 * take, add A^-1 J. The sweep then runs with the new velocities and needs no reduction.
 *
 * Light discs. m_f counts all fluid inside the disc, but only M0/2 of it follows within the step; the rest, in partly
 * covered cells, follows in the time of sound. Below a density of about 1 - M0/(2 m_f), 0.1 to 0.3, a disc and what
 * follows it at once have less than no inertia, and sound between two discs, or a disc and a wall, feeds on that. So
 * such a disc is given a held mass c that makes up for it, at once, and gives back the momentum p that this has taken,
 * over a few passages of sound T:
 *   A = ... + c,  R = ... + p/T,  p' = (1 - 1/T) p + c dV.
 * A steady acceleration is what it was, since then p = T c dV; conserved is (m - m_f) V + p, also where c changes as
 * the disc moves over the cells. Rotation likewise.
 *
 * explicit-averaged, for comparison: A = diag(m, m, I), R = weight + mean of the exchange at V over this step and the
 * last; the sweep sees V.
 *
 * The sums are taken inside the sweep of the step before, row by row and one row behind it, while the row is in cache
 * (sim/flow.c): they cost no pass through memory. They are kept per row of each disc and added from the lowest row up,
 * so that neither the threads nor their shares of rows change a bit. */
#ifndef DELBM_COUPLING_EXCHANGE_H
#define DELBM_COUPLING_EXCHANGE_H

#include "base/team.h"
#include "fluid/sweep.h"
#include "solid/occupation.h"

/* The sums above over all cells of a disc. */
struct gathered {
  double px, py, l, m0, m1x, m1y, m2;
};

/* A^-1, symmetric, and the change of velocity without contacts. */
struct response {
  double xx, xy, xw, yy, yw, ww;
  double dvx, dvy, domega;
};

struct exchange {
  enum coupling_solve solve;
  double gravity[2];
  struct gathered *gathered;
  struct response *response;
  struct surface_velocity *surface;
  double *last;   /* explicit-averaged: [3 disc + component] exchange of the step before */
  double *memory; /* implicit, with light discs: [3 disc + component] p of each disc; else NULL */
  bool has_last;
};

bool exchange_create(struct exchange *exchange, const struct scene *scene, const struct discs *discs,
                     struct status *status);
void exchange_destroy(struct exchange *exchange);

/* Saves or restores what a step leaves to the next, for so many discs; not the sums, which follow from the fluid. */
bool exchange_store(struct exchange *exchange, size_t discs, struct store *store, struct status *status);

/* Adds up and solves for all discs; called by all threads of a parallel region or outside of one. `constants` are those
 * of the coming sweep. Fails when A cannot be inverted: a disc too light and too small for its cells. */
bool stage_exchange(struct exchange *exchange, const struct sweep_constants *constants,
                    const struct occupation *occupation, const struct discs *discs, int64_t step, struct team *team);

/* What a light disc is held by in a step: c, that of rotation, and the time T. All zero for any other disc. */
struct held {
  double mass, inertia, time;
};
struct held exchange_held(const struct exchange *exchange, const struct discs *discs, size_t disc);

/* The exchange (force, torque) on the disc if it moves with the given velocity: (P, L) - M V. */
void exchange_force(const struct gathered *g, double vx, double vy, double omega, double force[3]);

#endif
