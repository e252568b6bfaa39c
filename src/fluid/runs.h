/* The interface of discs and fluid along a row of cells: runs of cells, sums over runs, surface velocities. */
#ifndef DELBM_FLUID_RUNS_H
#define DELBM_FLUID_RUNS_H

#include <stddef.h>
#include <stdint.h>

/* Cells x .. x + n - 1 of one body in one row of the box, wrapped at periodic sides and cut at others. Each cell of a run
 * has an owner weight w_p B: B is the weight of the cell (weight.h), w_p the part of owner p in its occupation fraction. */
struct run {
  int32_t x, n;
  uint32_t owner; /* index of the body */
  uint32_t first; /* index of the first cell's owner weight in the band's array (solid/tables.h) */
  double rx, ry;  /* from the owner's centre to the centre of the first cell */
};

/* Sums over a run of cells (exchange.h), with owner weight s = w_p B, r the lever arm along the row and moments of
 * the populations before the collision. They exclude the step's force F = rho g + uniform, which is known only
 * later; its part is derived from the sums of s, s r, s rho and s rho r. One cache line. */
struct moment_sums {
  _Alignas(64) double jx; /* sum s jx, */
  double jy;              /* s jy, */
  double turn;            /* s r jy, */
  double mass;            /* s rho, */
  double mx;              /* s rho r, */
  double mxx;             /* s rho r^2, */
  double sum_weight;      /* s, */
  double sx;              /* s r */
};

/* Velocity of a disc in the sweep. */
struct surface_velocity {
  double vx, vy, omega;
};

#endif
