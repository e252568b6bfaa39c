/* Kernels that read moments and write nothing, compiled per precision and instruction set as the sweep is. Moments are formed in
 * the precision of the populations, sums in double.
 *
 * gather_run  sums over a run of cells for the exchange (PHYSICS 2.1). With b = 2 share, r the lever arm, j the momentum about
 *             to be collided and F = rho g + uniform the force of the step: sum b (j + F), b (r x (j + F)), b rho, b rho r
 *             and b rho |r|^2.
 * scan_row    the largest speed of a row. What is not finite may escape a maximum, but not the sum formed beside it. */
#include "fluid/sweep.h"

#define PASTE3(a, b, c) a##_##b##_##c
#define NAME3(a, b, c)  PASTE3(a, b, c)
#define KERNEL(part)    NAME3(part, VARIANT, REAL)

extern gather_run KERNEL(gather_run);
extern scan_row KERNEL(scan_row);

void KERNEL(gather_run)(void *const a[Q], int n, const struct sweep_constants *constants, const double *restrict share,
                        double rx0, double ry, struct moment_sums *sums)
{
  const double gx = constants->force[0], gy = constants->force[1], zx = constants->uniform[0],
               zy = constants->uniform[1];
  const REAL *restrict a0 = a[0], *restrict a1 = a[1], *restrict a2 = a[2], *restrict a3 = a[3], *restrict a4 = a[4];
  const REAL *restrict a5 = a[5], *restrict a6 = a[6], *restrict a7 = a[7], *restrict a8 = a[8];
  double px = 0, py = 0, torque = 0, m0 = 0, m1 = 0, m2 = 0;
#pragma omp simd reduction(+ : px, py, torque, m0, m1, m2)
  for (int k = 0; k < n; k++) {
    const REAL d5 = a5[k] - a7[k], d6 = a6[k] - a8[k];
    const double rho = 1 + (double)(a0[k] + (a1[k] + a3[k] + a2[k] + a4[k]) + (a5[k] + a7[k] + a6[k] + a8[k]));
    const double jx = (double)(a1[k] - a3[k] + (d5 - d6)) + (rho * gx + zx);
    const double jy = (double)(a2[k] - a4[k] + (d5 + d6)) + (rho * gy + zy);
    const double b = 2 * share[k], rx = rx0 + k, mass = b * rho;
    px += b * jx;
    py += b * jy;
    torque += b * (rx * jy - ry * jx);
    m0 += mass;
    m1 += mass * rx;
    m2 += mass * (rx * rx + ry * ry);
  }
  sums->px += px;
  sums->py += py;
  sums->l += torque;
  sums->m0 += m0;
  sums->m1x += m1;
  sums->m1y += ry * m0;
  sums->m2 += m2;
}

double KERNEL(scan_row)(void *const a[Q], int n)
{
  const REAL *restrict a0 = a[0], *restrict a1 = a[1], *restrict a2 = a[2], *restrict a3 = a[3], *restrict a4 = a[4];
  const REAL *restrict a5 = a[5], *restrict a6 = a[6], *restrict a7 = a[7], *restrict a8 = a[8];
  double largest = 0, sum = 0, least = 1;
#ifndef __clang__ /* clang 14 forms no maximum of doubles in vectors while NaN must survive, and warns */
#pragma omp simd reduction(max : largest) reduction(min : least) reduction(+ : sum)
#endif
  for (int k = 0; k < n; k++) {
    const REAL d5 = a5[k] - a7[k], d6 = a6[k] - a8[k];
    const double jx = (double)(a1[k] - a3[k] + (d5 - d6)), jy = (double)(a2[k] - a4[k] + (d5 + d6));
    const double rho = 1 + (double)(a0[k] + (a1[k] + a3[k] + a2[k] + a4[k]) + (a5[k] + a7[k] + a6[k] + a8[k]));
    const double speed2 = (jx * jx + jy * jy) / (rho * rho);
    largest = largest > speed2 ? largest : speed2;
    least = least < rho ? least : rho;
    sum += speed2;
  }
  return __builtin_isfinite(sum) && least > 0 ? largest : __builtin_nan("");
}
