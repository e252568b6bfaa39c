/* Sums over a run of cells of one disc (exchange.h): with share s = w_p B, r the lever arm along the row and the
 * moments of the populations about to be collided. The force of the step, F = rho g + uniform, is not in them, since
 * they are taken before it is known; with sum s and sum s r they are all that it needs. One cache line. */
#ifndef DELBM_LATTICE_MOMENT_SUMS_H
#define DELBM_LATTICE_MOMENT_SUMS_H

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

#endif
