/* The fluid of a scene and its sweep (method: flow.c). */
#ifndef DELBM_SIM_FLOW_H
#define DELBM_SIM_FLOW_H

#include "coupling/exchange.h"
#include "fluid/boundary.h"
#include "fluid/solid_row.h"
#include "sim/diagnostics.h"
#include "sim/initial.h"
#include "sim/stages.h"
#include "sim/zero_flux.h"

struct flow {
  const struct scene *scene;
  const struct sweep_kernel *kernel;
  bool force;
  bool adaptive; /* rates */
  struct populations populations;
  struct boundary boundary;
  struct sweep_constants constants;
  struct zero_flux zero_flux;
  double load[2];               /* with zero_flux: external force on a cell, uniform force apart */
  double (*row_momentum)[2];    /* [row], with zero_flux: after the last step of an interval; else NULL */
  struct solid_row *solid_rows; /* [thread] */
  int threads;
};

bool flow_create(struct flow *flow, const struct scene *scene, const struct stages *stages, struct status *status);
void flow_destroy(struct flow *flow);

/* The discs of a sweep; all NULL in a scene without discs. */
struct sweep_discs {
  const struct occupation *now;    /* in this step */
  const struct exchange *exchange; /* surface velocities */
  struct occupation *next;         /* in the next step: receives the sums of the next exchange; may be equal to `now` */
};

/* Sets the initial state: velocity (j + F/2)/rho and viscous stress from `initial`, fluid at rest with NULL; in
 * cells of weight B, (1 - B) of this velocity plus the sum of w_p B v_p over the owners (22). Fluid with another
 * velocity than its disc would oscillate about the velocity of the disc, without decay in the owen form. */
void flow_start(struct flow *flow, flow_initial *initial, const void *context, const struct sweep_discs *discs);

/* Sets the equilibrium at the density and velocity of each cell, arrays of nx * ny, row by row from the bottom; in
 * cells of discs as flow_start. */
void flow_set(struct flow *flow, const double *density, const double *ux, const double *uy,
              const struct sweep_discs *discs);

/* Sets `load`: before the start, and before a step with SWEEP_FORCE_AND_SUM. Both pointers are NULL without discs. */
void flow_load(struct flow *flow, const struct exchange *exchange, const struct discs *discs);

/* Sets the uniform force that balances `load`, before the start. */
void flow_balance(struct flow *flow);

/* Saves or restores the fluid and the uniform force after `step` steps. */
bool flow_store(struct flow *flow, int64_t step, struct store *store, struct status *status);

/* Allocates memory for a parallel region of `threads`. */
bool flow_prepare(struct flow *flow, int threads, struct status *status);

/* The force on the fluid in the coming step. */
static inline struct fluid_force flow_force(const struct flow *flow)
{
  const struct sweep_constants *c = &flow->constants;
  return (struct fluid_force){{c->force[0], c->force[1]}, {c->uniform[0], c->uniform[1]}};
}

/* Kernel terms in the step `offset` steps after the next, within the same interval of zero_flux. */
static inline enum sweep_terms flow_terms(const struct flow *flow, int offset)
{
  const struct zero_flux *z = &flow->zero_flux;
  if (!flow->force) return SWEEP_NO_FORCE;
  return z->interval > 0 && z->phase + offset + 1 == z->interval ? SWEEP_FORCE_AND_SUM : SWEEP_FORCE;
}

/* Advances parity and uniform force by `steps`, complete in all rows; by one thread. */
void flow_advance(struct flow *flow, int steps);

/* Rows first .. end - 1; beyond a periodic side the numbers continue. */
struct rows {
  int first, end;
};

/* Sweeps the rows, computes the sums of the next exchange, and calls flow_advance. Called by all threads of a
 * parallel region or outside of one. */
void stage_sweep(struct flow *flow, const struct rows *rows, const struct sweep_discs *discs);

/* Computes the sums of the first exchange, before any sweep. Called by all threads or outside of a parallel region. */
void stage_first_sums(struct flow *flow, struct occupation *occupation);

#endif
