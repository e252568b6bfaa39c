/* Exchange: the momentum that fluid and discs hand each other, solved for the discs' new velocities (equations: exchange.c).
 *
 * In a step, stage_exchange finds for each disc the change of its velocity without contacts and the response K of its
 * velocity to an impulse; contacts act through K (contact/contacts.h); exchange_finish then sets the new velocity, the forces that
 * made it, and the velocity of the surface that the sweep imposes on the fluid. */
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
  double impact_fraction; /* s: part of the fluid's inertia that acts against an impact */
  double dvx, dvy, domega;
};

struct exchange {
  enum coupling_solve solve;
  double viscosity;
  double gravity[2];
  struct gathered *gathered;
  struct response *response;
  struct surface_velocity *surface; /* that the sweep imposes */
  /* what a step leaves to the next, [3 disc + component]; NULL where the scene does not need it */
  double *last_exchange; /* explicit-averaged: exchange of the step before */
  double *mean_contact;  /* implicit: mean contact impulse C of a step */
  double *deferred;      /* implicit, with light discs: momentum p withheld by their virtual mass */
  bool has_last_exchange;
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

/* K times an impulse. */
void response_to(const struct response *k, const double impulse[3], double dv[3]);

/* Sets the velocity, spin and forces of a disc at the end of the step, from its response and the impulse of its contacts in
 * discs->contact_fx, contact_fy and contact_torque, and the velocity of its surface in the coming sweep. */
void exchange_finish(struct exchange *exchange, struct discs *discs, size_t disc);

/* Adds the steady force from outside on a free disc: buoyant weight, and the mean contact force of the implicit solve. Contact
 * forces of free discs on each other cancel in the sum over all. */
void exchange_add_load(const struct exchange *exchange, const struct discs *discs, size_t disc, double load[2]);

/* Adds the momentum of a disc that the coupling conserves together with that of all fluid, inside discs too. */
void exchange_add_momentum(const struct exchange *exchange, const struct discs *discs, size_t disc, double momentum[2]);

#endif
