/* Figures of one instant: a row of series.csv. */
#ifndef DELBM_SIM_INSTANT_H
#define DELBM_SIM_INSTANT_H

#include "sim/diagnostics.h"

/* Lattice units; the density of the fluid at rest is 1. */
struct instant {
  double kinetic_fluid;    /* sum of rho |u|^2/2 over all cells, those inside discs too */
  double kinetic_discs;    /* sum of (m - m_f) V^2/2 + (I - I_f) omega^2/2 over all discs */
  double mean_velocity[2]; /* momentum of the fluid over its mass, as in run.json */
  double excess_mass;      /* sum of rho - 1 over all cells */
  double max_mach;         /* of the fluid, by j/rho as in run.json; NAN if a cell is not finite */
  double contacts;         /* number of contacts with an overlap (census.h) */
  double max_overlap;      /* largest overlap depth over the smaller radius of its contact */
};

struct instant_fluid {
  const struct populations *populations;
  const struct fluid_force *force;
  scan_row *scan; /* of the kernel */
};

/* `fluid`: NULL in a scene without fluid, whose figures of the fluid are 0. Outside of parallel regions; the same bits for
 * any number of threads. Fails only for want of memory. */
bool instant_take(const struct scene *scene, const struct instant_fluid *fluid, const struct discs *discs,
                  struct instant *instant, struct status *status);

#endif
