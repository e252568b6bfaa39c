/* The interface of discs and fluid along a row of cells: runs of cells, sums over runs, surface velocities. */
#ifndef DELBM_FLUID_RUNS_H
#define DELBM_FLUID_RUNS_H

#include <stddef.h>
#include <stdint.h>

/* Cells x .. x + n - 1 of one disc in one row of the box, wrapped and cut at sides; n = 0 if the disc is near
 * without a cell. */
struct run {
  int32_t x, n;
  uint32_t disc;
  uint32_t share; /* index of the first cell in share[] of the band */
  double rx, ry;  /* from the disc's centre to the centre of the first cell */
};

/* Sums over a run of cells of one disc (exchange.h), with s = w_p B, r the lever arm along the row and moments of
 * the populations before the collision. They exclude the step's force F = rho g + uniform, which is known only
 * later; its part is derived from the sums of s, s r, s rho and s rho r. One cache line. */
struct moment_sums {
  _Alignas(64) double jx; /* sum s jx, */
  double jy;              /* s jy, */
  double turn;            /* s r jy, */
  double mass;            /* s rho, */
  double mx;              /* s rho r, */
  double mxx;             /* s rho r^2, */
  double share;           /* s, */
  double sx;              /* s r */
};

/* Velocity of a disc in the sweep. */
struct surface_velocity {
  double vx, vy, omega;
};

#endif
