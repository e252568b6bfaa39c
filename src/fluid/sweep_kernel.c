/* The collide-stream kernel: one body, compiled once per precision (REAL) and instruction set (VARIANT).
 *
 * The paper's nine moments reduce, in a lattice of four opposite pairs, to sums and differences of the pairs:
 *
 *   s1 = f1+f3   s2 = f2+f4   s5 = f5+f7   s6 = f6+f8        even: rho, e, eps, pxx, pxy
 *   d1 = f1-f3   d2 = f2-f4   d5 = f5-f7   d6 = f6-f8        odd:  jx, qx, jy, qy
 *
 *   S = s1+s2, D = s5+s6, pxx = s1-s2, pxy = s5-s6, tx = d5-d6 = (2 jx + qx)/3, ty = d5+d6 = (2 jy + qy)/3.
 *
 * e and eps relax at one rate, and so does any combination: S to 4 rho/9 + u.j/3 and D to rho/9 + u.j/3. tx relaxes
 * to jx/3 at the rate of qx. The increments of the populations are sums of a quarter of the changes of S, D, pxx,
 * pxy, tx, ty and half of the changes of jx, jy. f0 changes by minus the changes of S and D, which conserves mass to
 * round-off.
 *
 * Force: second order in time (Guo, Zheng & Shi 2002) with F = rho g + uniform; even equilibria see j + F/2, and odd
 * moments, where the two half forces cancel, gain F and F/3.
 *
 * Immersed boundary: bounce-back changes the sign of odd moments only, and 6 w rho e.v adds 2 rho v to j and 2 rho v/3
 * to t.
 *   owen    (12)-(13): rates times (1 - B), reflection of the moments before collision;
 *   unified (17)-(18): full rates, reflection of the moments after collision;
 *   midpoint: owen for the mean of a moment before and after collision: slow flow is the same at every viscosity.
 * In each form j changes by exactly 2 h, h = rho B v - B (j + F): the momentum that is reflected includes the force,
 * so that fluid inside a disc keeps the disc's velocity exactly, (j + F/2)/rho = v. t changes by 2 h/3 and by the
 * product of (j/3 - t) and s_q (1 - B) + 2 B (owen) or s_q (1 - 2 B) + 2 B (unified).
 *
 * Why midpoint: streaming couples the means m' = m + dm/2 of odd moments to the changes dm of even moments, and
 * means of even moments to changes of odd moments. A steady slow flow is therefore the same for every viscosity if,
 * with Lambda = 1/s - 1/2, means of even and changes of odd moments are proportional to Lambda_nu. Without solid
 * this is the case at fixed Lambda_nu Lambda_q (d'Humieres & Ginzburg 2009). Owen's form, with k = B/(1 - B), is
 *   dp = -p'/(Lambda_nu (1 + k) + k/2),   dj = -2 k j',   dq = -(1 + k) (q' + j')/Lambda_q - 2 k q',
 * which has this property if k is proportional to Lambda_nu (weight.h) and 1 + k is replaced by 1, its limit for
 * vanishing viscosity. Solved for the change:
 *   even moments:  rate (1 - B) s/(1 - B (1 - s_nu/2)),
 *   t:             of j/3 - t the part (s_q (1 - 2 B) + 2 B)/(1 - B s_q/2).
 *
 * Adaptive rates: s_q = (slow + fast a)/(1 + a), a = rho |u|^2/viscosity^2, the cell's Reynolds number squared. A
 * small s_q makes slow flow accurate to third order, and fast flow unstable. A smooth blend, not min(): min()
 * becomes a branch in the scalar remainder loop, and its results would differ from the vector loop's in the last
 * bit. */
#include "fluid/sweep.h"

#define PASTE3(a, b, c) a##_##b##_##c
#define NAME3(a, b, c)  PASTE3(a, b, c)
#define KERNEL(part)    NAME3(part, VARIANT, REAL)

enum { FLUID_ALONE = -1 }; /* in place of a form */

static inline __attribute__((always_inline)) void collide_stream(void *const a[Q], void *const to[Q], const int n,
                                                                 const struct sweep_constants *constants,
                                                                 const struct solid_row *solid, double sum[2],
                                                                 const int form, const bool adaptive,
                                                                 const enum sweep_terms terms)
{
  const bool discs = form >= 0, force = terms != SWEEP_NO_FORCE, summed = terms == SWEEP_FORCE_AND_SUM;
  const REAL *a0 = a[0], *a1 = a[1], *a2 = a[2], *a3 = a[3], *a4 = a[4];
  const REAL *a5 = a[5], *a6 = a[6], *a7 = a[7], *a8 = a[8];
  REAL *to0 = to[0], *to1 = to[1], *to2 = to[2], *to3 = to[3], *to4 = to[4];
  REAL *to5 = to[5], *to6 = to[6], *to7 = to[7], *to8 = to[8];
  const REAL *restrict solid_b = discs ? solid->b : NULL;
  const REAL *restrict solid_bvx = discs ? solid->bvx : NULL;
  const REAL *restrict solid_bvy = discs ? solid->bvy : NULL;
  const REAL quarter_s_nu = (REAL)(constants->rates.s_nu / 4), quarter_s_e = (REAL)(constants->rates.s_e / 4);
  const REAL slow_q = (REAL)(constants->rates.s_q / 4);
  const REAL fast_q = (REAL)(constants->rates.s_q_fast / 4);
  const double three_viscosity = 1 / constants->rates.s_nu - 0.5;
  const REAL per_speed2 = (REAL)(9 / (three_viscosity * three_viscosity));
  const REAL gx = (REAL)constants->force[0], gy = (REAL)constants->force[1];
  const REAL zx = (REAL)constants->uniform[0], zy = (REAL)constants->uniform[1];
  const REAL one = 1, two = 2, four = 4, half = (REAL)0.5, quarter = (REAL)0.25;
  const REAL third = (REAL)(1.0 / 3), sixth = (REAL)(1.0 / 6), ninth = (REAL)(1.0 / 9), twelfth = (REAL)(1.0 / 12);
  REAL sum_x = 0, sum_y = 0;

#pragma omp simd reduction(+ : sum_x, sum_y)
  for (int x = 0; x < n; x++) {
    const REAL f0 = a0[x], f1 = a1[x], f2 = a2[x], f3 = a3[x], f4 = a4[x];
    const REAL f5 = a5[x], f6 = a6[x], f7 = a7[x], f8 = a8[x];
    const REAL s1 = f1 + f3, d1 = f1 - f3, s2 = f2 + f4, d2 = f2 - f4;
    const REAL s5 = f5 + f7, d5 = f5 - f7, s6 = f6 + f8, d6 = f6 - f8;
    const REAL S = s1 + s2, D = s5 + s6, pxx = s1 - s2, pxy = s5 - s6;
    const REAL tx = d5 - d6, ty = d5 + d6, jx = d1 + tx, jy = d2 + ty;
    const REAL delta_rho = f0 + S + D, rho = one + delta_rho, inverse = one / rho;

    const REAL Fx = force ? rho * gx + zx : 0, Fy = force ? rho * gy + zy : 0;
    const REAL Jx = force ? jx + half * Fx : jx, Jy = force ? jy + half * Fy : jy;
    const REAL ux = Jx * inverse, uy = Jy * inverse;
    const REAL Jux = Jx * ux, Juy = Jy * uy;

    const REAL b = discs ? solid_b[x] : 0;
    const REAL speed2 = per_speed2 * (Jux + Juy);
    const REAL quarter_q = adaptive ? (slow_q + fast_q * speed2) / (one + speed2) : slow_q;
    REAL keep = 1, q_q = quarter_q;
    if (form == FORM_UNIFIED) q_q += b * (half - two * quarter_q);
    if (form == FORM_OWEN) {
      keep = one - b;
      q_q += b * (half - quarter_q);
    }
    if (form == FORM_MIDPOINT) {
      const REAL even = one - b + two * b * quarter_s_nu, odd = one - two * b * quarter_q;
      const REAL both = one / (even * odd);
      keep = (one - b) * odd * both;
      q_q = (quarter_q + b * (half - two * quarter_q)) * even * both;
    }
    const REAL q_nu = keep * quarter_s_nu, q_e = keep * quarter_s_e;

    const REAL equilibrium = ninth * delta_rho + third * (Jux + Juy);
    REAL quarter_S = q_e * (equilibrium + third * delta_rho - S);
    REAL quarter_D = q_e * (equilibrium - D);
    REAL quarter_pxx = q_nu * (Jux - Juy - pxx);
    REAL quarter_pxy = q_nu * (Jx * uy - pxy);
    REAL quarter_tx = q_q * (third * jx - tx), quarter_ty = q_q * (third * jy - ty);
    REAL half_jx = 0, half_jy = 0;

    if (discs) {
      half_jx = rho * solid_bvx[x] - b * (jx + Fx);
      half_jy = rho * solid_bvy[x] - b * (jy + Fy);
      quarter_tx += sixth * half_jx;
      quarter_ty += sixth * half_jy;
    }
    if (force) {
      const REAL Fux = Fx * ux, Fuy = Fy * uy, Fu = third * (half - q_e) * (Fux + Fuy);
      quarter_S += Fu;
      quarter_D += Fu;
      quarter_pxx += (half - q_nu) * (Fux - Fuy);
      quarter_pxy += (quarter - half * q_nu) * (Fx * uy + Fy * ux);
      half_jx += half * Fx;
      half_jy += half * Fy;
      quarter_tx += twelfth * Fx;
      quarter_ty += twelfth * Fy;
    }
    if (summed) {
      sum_x += jx + half_jx + half * Fx;
      sum_y += jy + half_jy + half * Fy;
    }

    const REAL axis_x = quarter_S + quarter_pxx, axis_y = quarter_S - quarter_pxx;
    const REAL diagonal_up = quarter_D + quarter_pxy, diagonal_down = quarter_D - quarter_pxy;
    const REAL odd_x = half_jx - two * quarter_tx, odd_y = half_jy - two * quarter_ty;
    const REAL odd_up = quarter_tx + quarter_ty, odd_down = quarter_ty - quarter_tx;

    to0[x] = f0 - four * (quarter_S + quarter_D);
    to1[x] = f1 + axis_x + odd_x;
    to3[x] = f3 + axis_x - odd_x;
    to2[x] = f2 + axis_y + odd_y;
    to4[x] = f4 + axis_y - odd_y;
    to5[x] = f5 + diagonal_up + odd_up;
    to7[x] = f7 + diagonal_up - odd_up;
    to6[x] = f6 + diagonal_down + odd_down;
    to8[x] = f8 + diagonal_down - odd_down;
  }
  if (summed) {
    sum[0] = (double)sum_x;
    sum[1] = (double)sum_y;
  }
}

/* In place: f_i* is written to the slot from which f_opposite(i) was read. */
#define ROW(name, form, adaptive, terms)                                                                               \
  static void name(void *const a[Q], int n, const struct sweep_constants *constants, const struct solid_row *solid,    \
                   double sum[2])                                                                                      \
  {                                                                                                                    \
    void *const to[Q] = {a[0], a[3], a[4], a[1], a[2], a[7], a[8], a[5], a[6]};                                        \
    collide_stream(a, to, n, constants, solid, sum, form, adaptive, terms);                                            \
  }
ROW(sweep_fluid, FLUID_ALONE, false, SWEEP_NO_FORCE)
ROW(sweep_fluid_force, FLUID_ALONE, false, SWEEP_FORCE)
ROW(sweep_fluid_force_sum, FLUID_ALONE, false, SWEEP_FORCE_AND_SUM)
ROW(sweep_fluid_adaptive, FLUID_ALONE, true, SWEEP_NO_FORCE)
ROW(sweep_fluid_adaptive_force, FLUID_ALONE, true, SWEEP_FORCE)
ROW(sweep_fluid_adaptive_force_sum, FLUID_ALONE, true, SWEEP_FORCE_AND_SUM)
ROW(sweep_discs_unified, FORM_UNIFIED, false, SWEEP_NO_FORCE)
ROW(sweep_discs_unified_force, FORM_UNIFIED, false, SWEEP_FORCE)
ROW(sweep_discs_unified_force_sum, FORM_UNIFIED, false, SWEEP_FORCE_AND_SUM)
ROW(sweep_discs_unified_adaptive, FORM_UNIFIED, true, SWEEP_NO_FORCE)
ROW(sweep_discs_unified_adaptive_force, FORM_UNIFIED, true, SWEEP_FORCE)
ROW(sweep_discs_unified_adaptive_force_sum, FORM_UNIFIED, true, SWEEP_FORCE_AND_SUM)
ROW(sweep_discs_owen, FORM_OWEN, false, SWEEP_NO_FORCE)
ROW(sweep_discs_owen_force, FORM_OWEN, false, SWEEP_FORCE)
ROW(sweep_discs_owen_force_sum, FORM_OWEN, false, SWEEP_FORCE_AND_SUM)
ROW(sweep_discs_owen_adaptive, FORM_OWEN, true, SWEEP_NO_FORCE)
ROW(sweep_discs_owen_adaptive_force, FORM_OWEN, true, SWEEP_FORCE)
ROW(sweep_discs_owen_adaptive_force_sum, FORM_OWEN, true, SWEEP_FORCE_AND_SUM)
ROW(sweep_discs_midpoint, FORM_MIDPOINT, false, SWEEP_NO_FORCE)
ROW(sweep_discs_midpoint_force, FORM_MIDPOINT, false, SWEEP_FORCE)
ROW(sweep_discs_midpoint_force_sum, FORM_MIDPOINT, false, SWEEP_FORCE_AND_SUM)
ROW(sweep_discs_midpoint_adaptive, FORM_MIDPOINT, true, SWEEP_NO_FORCE)
ROW(sweep_discs_midpoint_adaptive_force, FORM_MIDPOINT, true, SWEEP_FORCE)
ROW(sweep_discs_midpoint_adaptive_force_sum, FORM_MIDPOINT, true, SWEEP_FORCE_AND_SUM)

/* The classic kernels, from one array to another: reference of the benchmark `sweep`. */
static void sweep_two_arrays(void *const from[Q], void *const to[Q], int n, const struct sweep_constants *constants)
{
  collide_stream(from, to, n, constants, NULL, NULL, FLUID_ALONE, false, SWEEP_NO_FORCE);
}

static void sweep_two_arrays_adaptive(void *const from[Q], void *const to[Q], int n,
                                      const struct sweep_constants *constants)
{
  collide_stream(from, to, n, constants, NULL, NULL, FLUID_ALONE, true, SWEEP_NO_FORCE);
}

extern gather_row KERNEL(gather_row);
extern paint_row KERNEL(paint_row);
extern scan_row KERNEL(scan_row);
extern const struct sweep_kernel KERNEL(sweep_kernel);
const struct sweep_kernel KERNEL(sweep_kernel) = {
    .name = VARIANT_NAME,
    .precision = sizeof(REAL) == sizeof(double) ? PRECISION_DOUBLE : PRECISION_SINGLE,
    .fluid = {{sweep_fluid, sweep_fluid_force, sweep_fluid_force_sum},
              {sweep_fluid_adaptive, sweep_fluid_adaptive_force, sweep_fluid_adaptive_force_sum}},
    .discs = {[FORM_UNIFIED] = {{sweep_discs_unified, sweep_discs_unified_force, sweep_discs_unified_force_sum},
                                {sweep_discs_unified_adaptive, sweep_discs_unified_adaptive_force,
                                 sweep_discs_unified_adaptive_force_sum}},
              [FORM_OWEN] = {{sweep_discs_owen, sweep_discs_owen_force, sweep_discs_owen_force_sum},
                             {sweep_discs_owen_adaptive, sweep_discs_owen_adaptive_force,
                              sweep_discs_owen_adaptive_force_sum}},
              [FORM_MIDPOINT] = {{sweep_discs_midpoint, sweep_discs_midpoint_force, sweep_discs_midpoint_force_sum},
                                 {sweep_discs_midpoint_adaptive, sweep_discs_midpoint_adaptive_force,
                                  sweep_discs_midpoint_adaptive_force_sum}}},
    .two_arrays = {sweep_two_arrays, sweep_two_arrays_adaptive},
    .gather = KERNEL(gather_row),
    .paint = KERNEL(paint_row),
    .scan = KERNEL(scan_row)};
