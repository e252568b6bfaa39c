/* The exchange of momentum between fluid and discs, solved for the new velocities of the discs (equations:
 * exchange.c).
 *
 * In a step, stage_exchange finds for each disc the change of velocity without contacts and the response K of its
 * velocity to an impulse; contacts act through K (contact/contacts.h); exchange_finish sets the new velocity, the
 * forces, and the velocity of the surface that the sweep imposes on the fluid. */
#ifndef DELBM_COUPLING_EXCHANGE_H
#define DELBM_COUPLING_EXCHANGE_H

#include "base/team.h"
#include "fluid/sweep.h"
#include "solid/occupation.h"

/* Sums over the cells of a disc: P, L, M0, M1 and M2 of exchange.c. */
struct gathered {
  double px, py, l, m0, m1x, m1y, m2;
};

/* Response K, symmetric, to an impulse (fx, fy, torque), and the change of velocity in the step without contacts. */
struct response {
  double xx, xy, xw, yy, yw, ww;
  double impact_fraction; /* s: fraction of M that acts against an impact */
  double dvx, dvy, domega;
};

struct exchange {
  bool dry; /* without fluid: `response` is constant, and of the other arrays only `lag` exists */
  enum coupling_solve solve;
  double viscosity;
  double gravity[2];
  struct gathered *gathered;
  struct response *response;
  struct surface_velocity *surface; /* imposed by the sweep */
  /* state between two steps, [3 disc + component]; NULL if the scene does not need it */
  double *last_exchange; /* explicit-averaged: exchange of the step before */
  double *mean_contact;  /* implicit: mean contact impulse C */
  double *deferred;      /* implicit, with light discs: deferred momentum p */
  double *lag;           /* [disc], without fluid: steps from the time of the velocity to that of the position */
  bool has_last_exchange;
  bool leave_unsolved, leave_unmoved; /* decisions after the solve and after the motion (team.h) */
};

bool exchange_create(struct exchange *exchange, const struct scene *scene, const struct discs *discs,
                     struct status *status);
void exchange_destroy(struct exchange *exchange);

/* Saves or restores the state between two steps, for `discs` discs; the sums are recomputed from the fluid. */
bool exchange_store(struct exchange *exchange, size_t discs, struct store *store, struct status *status);

/* With fluid: computes the sums and solves, for all discs; called by all threads of a parallel region or outside of
 * one. `constants`: of the coming sweep. Fails when A is not positive definite: a disc too light and too small for its
 * cells, or diverged fluid. */
bool stage_exchange(struct exchange *exchange, const struct sweep_constants *constants,
                    const struct occupation *occupation, const struct discs *discs, int64_t step, struct team *team);

/* K times an impulse. */
void response_to(const struct response *k, const double impulse[3], double dv[3]);

/* Sets velocity, spin and forces of a disc at the end of the step, and its surface velocity in the coming sweep,
 * from the response and the contact impulse (contact_fx, contact_fy, contact_torque). */
void exchange_finish(struct exchange *exchange, struct discs *discs, size_t disc);

/* Without fluid, at the end of a step in sub-steps of length h: see exchange.c. Changes position `to` and velocity. */
void exchange_change_lag(struct exchange *exchange, struct discs *discs, size_t disc, double h, double to[2]);

/* Adds the steady external force on a free disc: buoyant weight, and C of the implicit solve. In the sum over all
 * discs contact forces between free discs cancel. */
void exchange_add_load(const struct exchange *exchange, const struct discs *discs, size_t disc, double load[2]);

/* Adds (m - m_f) V + p, without fluid at the time of the position; the sum over discs plus the momentum of all fluid,
 * inside discs too, is conserved. */
void exchange_add_momentum(const struct exchange *exchange, const struct discs *discs, size_t disc, double momentum[2]);

#endif
