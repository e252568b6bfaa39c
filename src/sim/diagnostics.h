/* Diagnostics of the fluid: mass, momentum, fastest cell, values that are not finite, density and velocity of cells.
 * Sums are formed per row and the rows added in order: the same bits for any number of threads. Call outside of
 * parallel regions. All functions read the populations before the coming collision. */
#ifndef DELBM_SIM_DIAGNOSTICS_H
#define DELBM_SIM_DIAGNOSTICS_H

#include "fluid/sweep.h"
#include "solid/discs.h"

/* 0.6 c_s, Mach 0.6: beyond it the low-Mach expansion of the equilibrium is invalid. */
static const double diagnostics_speed_limit = 0.34641016151377546;

/* Body force on the fluid: per unit mass, and per unit volume. */
struct fluid_force {
  double per_mass[2], uniform[2];
};

/* Sums over all cells of rho - 1, j, and the kinetic energy rho |u|^2/2 with u = (j + F/2)/rho, F = rho per_mass +
 * uniform. */
struct fluid_totals {
  double excess_mass, jx, jy, kinetic;
};

/* The worst cell found by a check for divergence. */
struct worst_cell {
  double speed2; /* NAN if a cell is not finite */
  int x, y;
};

struct fluid_totals diagnostics_totals(const struct populations *populations, const struct fluid_force *force);

/* Sum of j + F/2 over the mass, of so many cells. */
void fluid_mean_velocity(const struct fluid_totals *totals, double cells, const struct fluid_force *force,
                         double mean[2]);

struct worst_cell diagnostics_worst(const struct populations *populations, scan_row *scan);

/* The largest finite speed of all cells. */
double diagnostics_largest_speed(const struct populations *populations);

/* Density and velocity of the cells of row y into arrays of nx. */
void diagnostics_row(const struct populations *populations, const struct fluid_force *force, int y, double *density,
                     double *ux, double *uy);

/* Density and velocity (j + F/2)/rho, F = rho force + uniform, of every cell into arrays of nx * ny; any may be NULL.
 * */
void diagnostics_fields(const struct populations *populations, const struct fluid_force *force, double *density,
                        double *ux, double *uy);

#endif
