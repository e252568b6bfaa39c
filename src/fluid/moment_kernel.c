/* Kernels that read moments and write no populations, compiled per precision and instruction set like the sweep.
 *
 * gather_row  For each run of cells of a row: sums over its cells of s = w_p B (the owner's weight) times moments of
 *             the populations and powers of the lever arm r along the row:
 *               jx: s jx   jy: s jy   turn: s r jy   mass: s rho   mx: s rho r   mxx: s rho r^2   and s, s r
 *             Moments are formed in the precision of the populations, sums in double.
 * paint_row   The solid row: for each cell B = sum of w_p B and B v = sum of w_p B v_p over owners p, where
 *             v_p = (vx - omega ry, vy + omega rx). Runs are in order from left to right: zeros up to a run, then the
 *             run; a run that overlaps an earlier run is added.
 * scan_row    The largest |j/rho|^2 of a row, NAN if a value is not finite or a density not positive. max() may drop a
 *             NAN operand; the sum formed beside it cannot.
 *
 * Runs are processed LANES = 8 cells at a time. Past the end of a run, cells are read with weight zero and buffers
 * are written, hence the padding that sweep.h demands. Each sum is formed in eight partial sums in the order of the
 * cells, independent of threads and blocking. A call reads populations before the sweep of its row and writes only
 * its own sums or row buffer: no race between rows. */
#include "base/lanes.h"
#include "fluid/sweep.h"

#include <stdbool.h>

#define PASTE3(a, b, c) a##_##b##_##c
#define NAME3(a, b, c)  PASTE3(a, b, c)
#define KERNEL(part)    NAME3(part, VARIANT, REAL)

extern gather_row KERNEL(gather_row);
extern paint_row KERNEL(paint_row);
extern scan_row KERNEL(scan_row);

typedef REAL real_lanes __attribute__((vector_size(LANES * sizeof(REAL)), aligned(sizeof(REAL)), may_alias));

/* The members of struct moment_sums as one vector. */
typedef double lanes_in_moments __attribute__((vector_size(64), may_alias));
_Static_assert(sizeof(struct moment_sums) == sizeof(lanes_in_moments), "eight sums");

static inline real_lanes load(const REAL *from)
{
  return *(const real_lanes *)from;
}

static inline lanes widen(real_lanes value)
{
  return __builtin_convertvector(value, lanes);
}

static inline lanes_in_moments gather_run(void *const a[Q], int x, int n, const double *owner_weight, double rx)
{
  const REAL *a0 = a[0], *a1 = a[1], *a2 = a[2], *a3 = a[3], *a4 = a[4], *a5 = a[5], *a6 = a[6], *a7 = a[7], *a8 = a[8];
  lanes jx_sum = {0}, jy_sum = {0}, turn = {0}, mass_sum = {0}, mx = {0}, mxx = {0}, weight_sum = {0}, sx = {0};
  for (int k = 0; k < n; k += LANES) {
    const int at = x + k;
    const real_lanes f1 = load(a1 + at), f2 = load(a2 + at), f3 = load(a3 + at), f4 = load(a4 + at);
    const real_lanes f5 = load(a5 + at), f6 = load(a6 + at), f7 = load(a7 + at), f8 = load(a8 + at);
    const real_lanes d5 = f5 - f7, d6 = f6 - f8;
    const lanes jx = widen(f1 - f3 + (d5 - d6)), jy = widen(f2 - f4 + (d5 + d6));
    const lanes rho = 1 + widen(load(a0 + at) + (f1 + f3 + f2 + f4) + (f5 + f7 + f6 + f8));
    const lanes s = lanes_load(owner_weight + k) * lanes_first(n - k), r = (rx + k) + lanes_count;
    const lanes mass = s * rho, sr = s * r;
    jx_sum += s * jx;
    jy_sum += s * jy;
    turn += sr * jy;
    mass_sum += mass;
    mx += mass * r;
    mxx += mass * r * r;
    weight_sum += s;
    sx += sr;
  }
  return lanes_sums((const lanes[8]){jx_sum, jy_sum, turn, mass_sum, mx, mxx, weight_sum, sx});
}

void KERNEL(gather_row)(void *const a[Q], const struct run *runs, size_t count, const double *owner_weight,
                        struct moment_sums *sums)
{
  for (size_t r = 0; r < count; r++)
    if (runs[r].n > 0)
      *(lanes_in_moments *)&sums[r] = gather_run(a, runs[r].x, runs[r].n, owner_weight + runs[r].first, runs[r].rx);
}

/* Stores eight elements in a row buffer, or adds to them. */
static inline void put(REAL *to, lanes value, bool add)
{
  real_lanes v = __builtin_convertvector(value, real_lanes);
  if (add) v += load(to);
  *(real_lanes *)to = v;
}

static inline void put_run(const struct solid_row *row, const struct run *run, const double *owner_weight,
                           const struct surface_velocity *v, bool add)
{
  const double vx = v->vx - v->omega * run->ry, vy = v->vy + v->omega * run->rx;
  REAL *b = (REAL *)row->b + run->x, *bvx = (REAL *)row->bvx + run->x, *bvy = (REAL *)row->bvy + run->x;
  for (int k = 0; k < run->n; k += LANES) {
    const lanes s = lanes_load(owner_weight + k) * lanes_first(run->n - k);
    put(b + k, s, add);
    put(bvx + k, s * vx, add);
    put(bvy + k, s * (vy + v->omega * (k + lanes_count)), add);
  }
}

/* Writes zeros in whole vectors from x to `end` or beyond; returns the first element not written. */
static inline int put_zeros(const struct solid_row *row, int x, int end)
{
  const lanes zero = {0};
  for (; x < end; x += LANES) {
    put((REAL *)row->b + x, zero, false);
    put((REAL *)row->bvx + x, zero, false);
    put((REAL *)row->bvy + x, zero, false);
  }
  return x;
}

void KERNEL(paint_row)(const struct solid_row *row, int nx, const struct run *runs, size_t count,
                       const double *owner_weight, const struct surface_velocity *surface)
{
  int known = 0;   /* cells before this index are written */
  int painted = 0; /* cells from this index to `known` are zero */
  for (size_t r = 0; r < count; r++) {
    const struct run *run = &runs[r];
    const int end = run->x + run->n;
    if (run->n == 0) continue;
    const bool apart = run->x >= painted;
    known = put_zeros(row, known, apart ? run->x : end);
    put_run(row, run, owner_weight + run->first, &surface[run->owner], !apart);
    if (apart && known < end) known = run->x + ((run->n + LANES - 1) & -LANES);
    if (painted < end) painted = end;
  }
  put_zeros(row, known, nx);
}

double KERNEL(scan_row)(void *const a[Q], int n)
{
  const REAL *restrict a0 = a[0], *restrict a1 = a[1], *restrict a2 = a[2], *restrict a3 = a[3], *restrict a4 = a[4];
  const REAL *restrict a5 = a[5], *restrict a6 = a[6], *restrict a7 = a[7], *restrict a8 = a[8];
  double max_speed2 = 0, sum = 0, min_rho = 1;
#ifndef __clang__ /* clang 14 cannot vectorise a maximum that keeps NAN, and warns */
#pragma omp simd reduction(max : max_speed2) reduction(min : min_rho) reduction(+ : sum)
#endif
  for (int k = 0; k < n; k++) {
    const REAL d5 = a5[k] - a7[k], d6 = a6[k] - a8[k];
    const double jx = (double)(a1[k] - a3[k] + (d5 - d6)), jy = (double)(a2[k] - a4[k] + (d5 + d6));
    const double rho = 1 + (double)(a0[k] + (a1[k] + a3[k] + a2[k] + a4[k]) + (a5[k] + a7[k] + a6[k] + a8[k]));
    const double speed2 = (jx * jx + jy * jy) / (rho * rho);
    max_speed2 = max_speed2 > speed2 ? max_speed2 : speed2;
    min_rho = min_rho < rho ? min_rho : rho;
    sum += speed2;
  }
  return __builtin_isfinite(sum) && min_rho > 0 ? max_speed2 : __builtin_nan("");
}
