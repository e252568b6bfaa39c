/* The sweep over all cells, each row followed by its links to the sides. Rows are shared out in order and without
 * branches per cell: rows that no disc touches take the kernel without discs. */
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
  double load[2];               /* with zero_flux: force from outside on a cell, uniform force apart */
  double (*row_momentum)[2];    /* of each row, after the last step of an interval of zero_flux; else NULL */
  struct solid_row *solid_rows; /* of each thread */
  int threads;
};

bool flow_create(struct flow *flow, const struct scene *scene, const struct stages *stages, struct status *status);
void flow_destroy(struct flow *flow);

/* Where discs are in a sweep, and where they will be after it; all NULL in a scene without discs. */
struct sweep_discs {
  const struct occupation *now;
  const struct exchange *exchange; /* with the velocities of the discs' surfaces */
  struct occupation *next;         /* takes the sums of the next exchange; may be the same as `now` */
};

/* The initial state: (j + F/2)/rho and the viscous stress as `initial` has them, or with NULL fluid at rest; in cells under
 * discs (1 - B) of that and B of the discs' motion, w_p B of each owner's (22). Fluid that starts out of step with its disc
 * is reflected to and fro about its velocity, in the owen form for ever. */
void flow_start(struct flow *flow, flow_initial *initial, const void *context, const struct sweep_discs *discs);

/* Equilibrium at the density and velocity of each cell, arrays of nx * ny, row by row from the bottom; under discs as
 * above. */
void flow_set(struct flow *flow, const double *density, const double *ux, const double *uy,
              const struct sweep_discs *discs);

/* Before the start, and before a step with SWEEP_FORCE_AND_SUM: the force from outside on fluid and discs, which both may be
 * NULL; and before the start the uniform force that balances it. */
void flow_load(struct flow *flow, const struct exchange *exchange, const struct discs *discs);
void flow_balance(struct flow *flow);

/* Saves or restores the fluid and the uniform force after so many steps. */
bool flow_store(struct flow *flow, int64_t step, struct store *store, struct status *status);

/* Prepares for a parallel region of `threads`. */
bool flow_prepare(struct flow *flow, int threads, struct status *status);

/* The force on the fluid in the coming step. */
static inline struct fluid_force flow_force(const struct flow *flow)
{
  const struct sweep_constants *c = &flow->constants;
  return (struct fluid_force){{c->force[0], c->force[1]}, {c->uniform[0], c->uniform[1]}};
}

/* Terms of the kernel in the step that follows so many steps, none of which ends an interval of zero_flux. */
static inline enum sweep_terms flow_terms(const struct flow *flow, int ahead)
{
  const struct zero_flux *z = &flow->zero_flux;
  if (!flow->force) return SWEEP_NO_FORCE;
  return z->interval > 0 && z->phase + ahead + 1 == z->interval ? SWEEP_FORCE_AND_SUM : SWEEP_FORCE;
}

/* Parity and uniform force of the step after these, which all rows have taken; by one thread. */
void flow_advance(struct flow *flow, int steps);

/* Rows first .. end - 1; those beyond a periodic side are counted on. */
struct rows {
  int first, end;
};

/* The sweep of the given rows. With discs each row's moments are taken for the next exchange once the row and its
 * neighbours are done. Ends with flow_advance. Called by all threads of a parallel region or
 * outside of one. */
void stage_sweep(struct flow *flow, const struct rows *rows, const struct sweep_discs *discs);

/* The sums of the first exchange, which no sweep precedes. Called likewise. */
void stage_first_sums(struct flow *flow, struct occupation *occupation);

#endif
