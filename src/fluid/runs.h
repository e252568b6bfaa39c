/* What discs and fluid hand each other along a row of cells: runs of cells, the sums taken over them, and the velocity that
 * they see. */
#ifndef DELBM_FLUID_RUNS_H
#define DELBM_FLUID_RUNS_H

#include <stddef.h>
#include <stdint.h>

/* Cells of one disc in one row of the box, wrapped and cut: x .. x + n - 1; none (n = 0) where the disc is only near. */
struct run {
  int32_t x, n;
  uint32_t disc;
  uint32_t share; /* of the first cell, in the band's share[] */
  double rx, ry;  /* from the disc's centre to the centre of the first cell */
};

/* Sums over a run of cells of one disc (exchange.h): with share s = w_p B, r the lever arm along the row and the
 * moments of the populations about to be collided. The force of the step, F = rho g + uniform, is not in them, since
 * they are taken before it is known; with sum s and sum s r they are all that it needs. One cache line. */
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

/* Velocity of a disc as the fluid sees it in the sweep. */
struct surface_velocity {
  double vx, vy, omega;
};

#endif
