/* Looks at the state: mass, momentum, the fastest cell, what is not finite. Sums are taken per row, the rows added in
 * order: the same bits for any number of threads. */
#ifndef DELBM_SIM_DIAGNOSTICS_H
#define DELBM_SIM_DIAGNOSTICS_H

#include "fluid/sweep.h"
#include "solid/discs.h"

/* Speed of Mach 0.6, 0.6 c_s: beyond it the expansion behind the method has lost its meaning. */
static const double diagnostics_fastest = 0.34641016151377546;

/* Sums of rho - 1 and j over all cells. */
struct fluid_totals {
  double excess_mass, jx, jy;
};

/* The worst cell found by a look for divergence. */
struct worst_cell {
  double speed2; /* NAN if a cell is not finite */
  int x, y;
};

/* All read the populations that the coming step will collide. Outside of parallel regions. */
struct fluid_totals diagnostics_totals(const struct populations *populations);
struct worst_cell diagnostics_worst(const struct populations *populations, scan_row *scan);

/* The largest speed of the cells whose speed is finite. */
double diagnostics_largest_speed(const struct populations *populations);

/* Body force per unit mass and per unit volume that act on the fluid. */
struct fluid_force {
  double mass[2], uniform[2];
};

/* Density and velocity of the cells of row y into arrays of nx. */
void diagnostics_row(const struct populations *populations, const struct fluid_force *force, int y, double *density,
                     double *ux, double *uy);

/* Density and velocity (j + F/2)/rho, F = rho force + uniform, of every cell into arrays of nx * ny; any may be NULL.
 * */
void diagnostics_fields(const struct populations *populations, const struct fluid_force *force, double *density,
                        double *ux, double *uy);

#endif
