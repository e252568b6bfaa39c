/* Exchange: the momentum that fluid and discs hand each other, solved for the discs' new velocities.
 *
 * A cell hands the fluid B (-2 j + 2 rho v), j with the force of the step: linear in the disc's velocity. Over the
 * cells of a disc, with b = 2 w_p B and lever arm r, the streamed, not yet collided populations give
 *   P = sum b j, L = sum b (r x j), M0 = sum b rho, M1 = sum b rho r, M2 = sum b rho |r|^2,
 * and the change of velocity dV = (dVx, dVy, domega) over the step follows from
 *   A dV = R,  A = diag(m - m_f, m - m_f, I - I_f) + M,  R = weight + (P, L) - M V,
 *        | M0    0    -M1y |
 *   M =  | 0     M0    M1x |
 *        | -M1y  M1x   M2  |
 * and the sweep runs with the new velocities and needs no reduction.
 *
 * Contacts (sim/contacts.c), however many sub-steps they take, add K J, with J their impulse over the step. A force meets
 * m - m_f + M0, about m + m_f: the fluid inside is reflected about the new velocity, takes up twice what it needs to
 * follow, and hands that back a step later. To a contact that is over by then it would lend the energy by which discs part
 * faster than they met. So of what an impact adds the sweep sees a share s = 1/2, which makes the fluid of a wholly covered
 * cell follow exactly; of C, what contacts carry steadily, as the weight of discs at rest, it sees all:
 *   K^-1 = diag(m - m_f, m - m_f, I - I_f) + s M,  dV = A^-1 (R + C) + K (J - C),  the sweep sees V + dV - (1 - s) K (J - C),
 * with C the mean of J over some time: C' = C + (J - C)/100. Only where K^-1 is not positive definite, as of a light disc
 * pressed far into a wall, s = 1.
 *
 * Light discs. m_f counts all fluid inside the disc, but only M0/2 of it follows within the step; the rest, in partly
 * covered cells, follows in the time of sound. Below a density of about 1 - M0/(2 m_f), 0.1 to 0.3, a disc and what
 * follows it at once have less than no inertia, and sound between two discs, or a disc and a wall, feeds on that. So
 * such a disc is given a held mass c that makes up for it, at once, and gives back the momentum p that this has taken,
 * over a few passages of sound T:
 *   A = ... + c,  R = ... + p/T,  p' = (1 - 1/T) p + c dV.
 * A steady acceleration is what it was, since then p = T c dV; conserved is (m - m_f) V + p, also where c changes as
 * the disc moves over the cells. Rotation likewise. But what is given back late feeds oscillations: at a frequency w a disc
 * gains c w^2 T/(1 + w^2 T^2) V^2, where its boundary layer takes 4 pi R sqrt(nu w/2) V^2, and where the first is more,
 * as of small discs at small viscosity, a crowd sings until the run diverges. With T at least (c R/m_f)^2/nu, the time in
 * which momentum diffuses over the part c/m_f of R, it is a fifth of the second at most.
 *
 * Of a light disc that a side cuts off, or that shares cells with another, the covered part has its centre elsewhere: M1
 * couples translation and rotation, and what counts is the least eigenvalue of diag(m - m_f, m - m_f, I - I_f) + M/2, not
 * the diagonal. m_f moreover counts fluid beyond the side, and that of shared cells twice. With 0.15 on the diagonal alone
 * such a disc rocks at a period of 5.5 steps, growing by 3 % a step (density 0.1, R = 3, viscosity 1, against a wall).
 * So both inertias are held at 0.15 and a multiple of |M1|/2; in free fluid M1 vanishes.
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

/* K, symmetric, and the change of velocity without contacts, A^-1 (R + C) - K C. */
struct response {
  double xx, xy, xw, yy, yw, ww;
  double share; /* s */
  double dvx, dvy, domega;
};

struct exchange {
  enum coupling_solve solve;
  double viscosity;
  double gravity[2];
  struct gathered *gathered;
  struct response *response;
  struct surface_velocity *surface;
  double *last;    /* explicit-averaged: [3 disc + component] exchange of the step before */
  double *carried; /* implicit: [3 disc + component] C */
  double *memory;  /* implicit, with light discs: [3 disc + component] p of each disc; else NULL */
  bool has_last;
  bool leave_unsolved, leave_unmoved; /* after the solve, after the motion (team.h) */
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

/* K times an impulse. */
void response_to(const struct response *k, const double impulse[3], double dv[3]);

/* Implicit: what the sweep does not see of the velocity that the impulse J of its contacts has given a disc, which then
 * counts for C. */
void exchange_hide(struct exchange *exchange, size_t disc, const struct wrench *impulse, double hidden[3]);

/* The exchange (force, torque) on the disc if it moves with the given velocity: (P, L) - M V. */
void exchange_force(const struct gathered *g, double vx, double vy, double omega, double force[3]);

#endif
