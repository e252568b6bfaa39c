/* The fluid sweep alone: million cell updates a second of each kernel, beside a plain in-place read-modify-write of nine planes
 * (18 values per update), the least that memory allows. Every kernel is held against the reference before it is timed. */
#include "base/clock.h"
#include "base/memory.h"
#include "bench.h"
#include "fluid/boundary.h"
#include "fluid/reference.h"
#include "sim/flow.h"

#include "scenes.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>

enum { REPEATS = 7 };

/* Nine planes read, changed and written back: what an in-place update must move, and hardly more arithmetic. */
static void read_modify_write(struct populations *p)
{
#pragma omp for schedule(static)
  for (int y = 0; y < p->ny; y++) {
    void *a[Q];
    populations_cells(p, 0, y, a);
    double *restrict a0 = a[0], *restrict a1 = a[1], *restrict a2 = a[2], *restrict a3 = a[3], *restrict a4 = a[4];
    double *restrict a5 = a[5], *restrict a6 = a[6], *restrict a7 = a[7], *restrict a8 = a[8];
#pragma omp simd
    for (int x = 0; x < p->nx; x++) {
      const double s = 1e-9 * (((a0[x] + a1[x]) + (a2[x] + a3[x])) + ((a4[x] + a5[x]) + (a6[x] + a7[x])) + a8[x]);
      a0[x] -= s, a1[x] -= s, a2[x] -= s, a3[x] -= s, a4[x] -= s, a5[x] -= s, a6[x] -= s, a7[x] -= s, a8[x] -= s;
    }
  }
}

static double time_steps(struct flow *flow, bool sweep, int steps)
{
  const double start = clock_now();
#pragma omp parallel
  for (int k = 0; k < steps; k++) {
    if (sweep)
      stage_sweep(flow, false, NULL, NULL);
    else
      read_modify_write(&flow->populations);
  }
  return clock_now() - start;
}

static int compare_doubles(const void *a, const void *b)
{
  const double l = *(const double *)a, r = *(const double *)b;
  return (l > r) - (l < r);
}

static double median(double *values, int count)
{
  qsort(values, (size_t)count, sizeof *values, compare_doubles);
  return values[count / 2];
}

static bool check(const char *kernel, enum precision precision, struct status *status);

/* A standing wave, so that no kernel works on zeros. */
static void set_wave(struct populations *p)
{
  for (int y = 0; y < p->ny; y++)
    for (int x = 0; x < p->nx; x++)
      for (int i = 0; i < Q; i++)
        populations_set(p, populations_source(p, i, x, y), 1e-3 * d2q9_weight[i] * sin(6.283 * x / p->nx) * d2q9_ey[i]);
}

static bool check(const char *kernel, enum precision precision, struct status *status)
{
  struct scene scene = scene_box(40, 24, 0.05, SIDES_PERIODIC);
  scene.fluid.precision = precision;
  scene.fluid.kernel = (char *)kernel;
  const struct plan plan = plan_of(&scene);
  struct flow flow;
  struct reference reference;
  if (!flow_create(&flow, &scene, &plan, status)) return false;
  if (!reference_create(&reference, 40, 24, status)) return false;
  set_wave(&flow.populations);
  double largest = 0, g[Q];
  for (int k = 0; k < 40 * 24; k++) {
    populations_cell(&flow.populations, k % 40, k / 40, g);
    for (int i = 0; i < Q; i++) reference.f[k * Q + i] = g[i] + d2q9_weight[i];
  }
  const struct reference_cover none = {0};
  for (int step = 0; step < 6; step++) {
    stage_sweep(&flow, false, NULL, NULL);
    reference_step(&reference, scene.domain.side, &flow.constants, &none);
  }
  for (int k = 0; k < 40 * 24; k++) {
    populations_cell(&flow.populations, k % 40, k / 40, g);
    for (int i = 0; i < Q; i++) largest = fmax(largest, fabs(g[i] + d2q9_weight[i] - reference.f[k * Q + i]));
  }
  flow_destroy(&flow);
  reference_destroy(&reference);
  const double tolerance = precision == PRECISION_DOUBLE ? 1e-15 : 1e-7;
  if (largest <= tolerance) return true;
  return status_fail(status, DELBM_FAILED, "kernel %s differs from the reference by %g", kernel, largest);
}

/* Median rates, in million updates a second, of a kernel and of the plain update, taken in turn. */
static bool measure(int size, const struct sweep_kernel *kernel, double *sweep, double *plain,
                    const struct bench_report *report, struct status *status)
{
  struct scene scene = scene_box(size, size, 0.05, SIDES_CLOSED);
  scene.fluid.precision = kernel->precision;
  scene.fluid.kernel = (char *)kernel->name;
  const struct plan plan = plan_of(&scene);
  struct flow flow;
  if (!flow_create(&flow, &scene, &plan, status)) return false;
  set_wave(&flow.populations);
  const double cells = (double)size * size;
  const int steps = 2 * (int)fmax(1, (report->quick ? 2e6 : 1e8) / cells / 2);
  double of_sweep[REPEATS], of_plain[REPEATS];
  time_steps(&flow, true, 2);
  for (int k = 0; k < REPEATS; k++) {
    of_sweep[k] = cells * steps / time_steps(&flow, true, steps) / 1e6;
    of_plain[k] = kernel->precision == PRECISION_DOUBLE ? cells * steps / time_steps(&flow, false, steps) / 1e6 : NAN;
  }
  *sweep = median(of_sweep, REPEATS);
  *plain = median(of_plain, REPEATS);
  flow_destroy(&flow);
  return true;
}

bool bench_sweep(const struct bench_report *report, struct status *status)
{
  static const int sizes[] = {128, 1024, 4096};
  const int all = omp_get_max_threads();
  bool first = true;
  printf("million cell updates a second; plain: in-place read-modify-write of nine planes of doubles\n");
  printf("%-18s %6s %8s %9s %9s %12s %8s\n", "kernel", "size", "threads", "sweep", "plain", "time/plain", "GB/s");
  for (size_t s = 0; s < (report->quick ? 1 : sizeof sizes / sizeof sizes[0]); s++)
    for (int threads = 1; threads <= all; threads = threads < all && 2 * threads > all ? all : 2 * threads) {
      omp_set_num_threads(threads);
      bool runs;
      const struct sweep_kernel *kernel;
      for (size_t k = 0; (kernel = sweep_kernel_at(k, &runs)); k++) {
        double sweep, plain;
        if (!runs) continue;
        if (!check(kernel->name, kernel->precision, status)) return false;
        if (!measure(sizes[s], kernel, &sweep, &plain, report, status)) return false;
        const double bytes = 2 * Q * (kernel->precision == PRECISION_DOUBLE ? 8 : 4);
        printf("%-18s %6d %8d %9.1f %9.1f %12.2f %8.1f\n", kernel->name, sizes[s], threads, sweep, plain, plain / sweep,
               sweep * bytes / 1e3);
        fflush(stdout);
        if (report->json)
          fprintf(report->json, "%s\"%s %d x %d\": {\"mlups\": %.6g, \"plain\": %.6g}", first ? "" : ", ", kernel->name,
                  sizes[s], threads, sweep, isnan(plain) ? 0 : plain);
        first = false;
      }
    }
  omp_set_num_threads(all);
  return true;
}
