/* The fluid sweep alone: million cell updates a second of each kernel, in place, from one array to another (the classic
 * scheme), and blocked in time, beside a plain in-place read-modify-write of the same nine planes: the least that
 * memory allows for 18 values an update. Each is held against the reference before it is timed. Rates are medians of
 * alternating repeats, in a box that is periodic both ways. */
#include "base/clock.h"
#include "bench.h"
#include "fluid/boundary.h"
#include "fluid/reference.h"
#include "scenes.h"
#include "sim/blocked.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { REPEATS = 5, SMALL_X = 72, SMALL_Y = 66 };

/* Ways to take a step. */
enum way { IN_PLACE, TWO_ARRAYS, PLAIN, BLOCKED };

struct subject {
  enum way way;
  struct blocking blocking;
  struct flow flow;
  struct populations other; /* the second array */
};

/* Nine planes read, changed and written back: what an in-place update must move, and hardly more arithmetic. */
#define READ_MODIFY_WRITE(name, real)                                                                                  \
  static void name(void *const a[Q], int n)                                                                            \
  {                                                                                                                    \
    real *restrict a0 = a[0], *restrict a1 = a[1], *restrict a2 = a[2], *restrict a3 = a[3], *restrict a4 = a[4];      \
    real *restrict a5 = a[5], *restrict a6 = a[6], *restrict a7 = a[7], *restrict a8 = a[8];                           \
    _Pragma("omp simd") for (int x = 0; x < n; x++)                                                                    \
    {                                                                                                                  \
      const real s = (real)1e-9 * (a0[x] + a1[x] + a2[x] + a3[x] + a4[x] + a5[x] + a6[x] + a7[x] + a8[x]);             \
      a0[x] -= s, a1[x] -= s, a2[x] -= s, a3[x] -= s, a4[x] -= s, a5[x] -= s, a6[x] -= s, a7[x] -= s, a8[x] -= s;      \
    }                                                                                                                  \
  }
READ_MODIFY_WRITE(read_modify_write_double, double)
READ_MODIFY_WRITE(read_modify_write_single, float)

static void plain_pass(const struct populations *p)
{
#pragma omp for schedule(static)
  for (int y = 0; y < p->ny; y++) {
    void *a[Q];
    populations_cells(p, 0, y, a);
    if (p->precision == PRECISION_DOUBLE)
      read_modify_write_double(a, p->nx);
    else
      read_modify_write_single(a, p->nx);
  }
}

/* Row y pulls from `from` what streams into it, and leaves it collided in `to`; the columns beside the box are images.
 * */
static void two_arrays_step(struct subject *subject)
{
  struct populations *from = &subject->flow.populations, *to = &subject->other;
#pragma omp for schedule(static)
  for (int y = 0; y < from->ny; y++)
    for (int i = 1; i < Q; i++) {
      const int image = d2q9_ex[i] > 0 ? from->nx - 1 : 0, ghost = d2q9_ex[i] > 0 ? -1 : from->nx;
      if (d2q9_ex[i])
        populations_set(from, populations_slot(from, i, ghost, y),
                        populations_get(from, populations_slot(from, i, image, y)));
    }
#pragma omp for schedule(static)
  for (int y = 0; y < from->ny; y++) {
    const size_t size = from->precision == PRECISION_DOUBLE ? sizeof(double) : sizeof(float);
    void *source[Q], *target[Q];
    for (int i = 0; i < Q; i++) {
      source[i] = (char *)from->block + populations_slot(from, i, -d2q9_ex[i], y - d2q9_ey[i]) * size;
      target[i] = (char *)to->block + populations_slot(to, i, 0, y) * size;
    }
    subject->flow.kernel->two_arrays(source, target, from->nx, &subject->flow.constants);
  }
#pragma omp single
  {
    const struct populations swap = *from;
    *from = *to;
    *to = swap;
  }
}

/* Called by all threads; `steps` is a multiple of the depth. */
static void take_steps(struct subject *subject, int steps)
{
  const int depth = subject->way == BLOCKED ? subject->blocking.depth : 1;
  const struct rows all = {0, subject->flow.populations.ny};
  for (int k = 0; k < steps; k += depth) {
    if (subject->way == IN_PLACE) stage_sweep(&subject->flow, &all, &(struct sweep_discs){0});
    if (subject->way == TWO_ARRAYS) two_arrays_step(subject);
    if (subject->way == PLAIN) plain_pass(&subject->flow.populations);
    if (subject->way == BLOCKED) stage_sweep_blocked(&subject->flow, &subject->blocking, depth);
  }
}

/* Waves, so that no kernel works on zeros. */
static void set_waves(struct populations *p)
{
#pragma omp parallel for schedule(static)
  for (int y = 0; y < p->ny; y++)
    for (int x = 0; x < p->nx; x++)
      for (int i = 0; i < Q; i++) {
        const double wave = 1e-3 * sin(6.283 * x / p->nx + i) * cos(6.283 * y / p->ny - i);
        populations_set(p, populations_slot(p, i, x, y), wave * d2q9_weight[i]);
      }
}

static bool subject_create(struct subject *subject, const struct scene *scene, enum way way,
                           const struct blocking *blocking, struct status *status)
{
  const struct plan plan = plan_of(scene);
  *subject = (struct subject){.way = way, .blocking = *blocking};
  if (!flow_create(&subject->flow, scene, &plan, status)) return false;
  const struct populations *p = &subject->flow.populations;
  if (way == TWO_ARRAYS && !populations_create(&subject->other, p->nx, p->ny, true, p->precision, status)) return false;
  set_waves(&subject->flow.populations);
  return true;
}

static void subject_destroy(struct subject *subject)
{
  flow_destroy(&subject->flow);
  populations_destroy(&subject->other);
}

static struct scene periodic_box(int nx, int ny, const struct sweep_kernel *kernel)
{
  struct scene scene = scene_box(nx, ny, 0.05, SIDES_PERIODIC);
  scene.fluid.precision = kernel->precision;
  scene.fluid.kernel = (char *)kernel->name;
  return scene;
}

/* Six steps in a small box against the reference. With two arrays what is held is collided, not yet streamed, so that
 * its first step starts from the waves streamed: the reference is then one streaming behind. */
static bool verify(const struct sweep_kernel *kernel, enum way way, const struct blocking *blocking,
                   struct status *status)
{
  const struct scene scene = periodic_box(SMALL_X, SMALL_Y, kernel);
  struct subject subject;
  struct reference reference;
  if (!subject_create(&subject, &scene, way, blocking, status)) return false;
  if (!reference_create(&reference, SMALL_X, SMALL_Y, status)) return false;
  const struct populations *p = &subject.flow.populations;
  for (int k = 0; k < SMALL_X * SMALL_Y; k++)
    for (int i = 0; i < Q; i++) {
      const int x = k % SMALL_X - (way == TWO_ARRAYS ? d2q9_ex[i] : 0),
                y = k / SMALL_X - (way == TWO_ARRAYS ? d2q9_ey[i] : 0);
      const size_t slot = populations_slot(p, i, (x + SMALL_X) % SMALL_X, (y + SMALL_Y) % SMALL_Y);
      reference.f[k * Q + i] = populations_get(p, slot) + d2q9_weight[i];
    }
  const int steps = way == BLOCKED ? 2 * blocking->depth : 6;
#pragma omp parallel
  take_steps(&subject, steps);
  const struct reference_cover none = {0};
  for (int k = 0; k < steps; k++) reference_step(&reference, scene.domain.side, &subject.flow.constants, &none);
  const double *expected = way == TWO_ARRAYS ? reference.collided : reference.f;
  double largest = 0;
  for (int k = 0; k < SMALL_X * SMALL_Y * Q; k++) {
    const size_t slot = populations_slot(p, k % Q, k / Q % SMALL_X, k / Q / SMALL_X);
    largest = fmax(largest, fabs(populations_get(p, slot) + d2q9_weight[k % Q] - expected[k]));
  }
  subject_destroy(&subject);
  reference_destroy(&reference);
  if (largest <= (kernel->precision == PRECISION_DOUBLE ? 1e-14 : 1e-6)) return true;
  return status_fail(status, DELBM_FAILED, "kernel %s, way %d, differs from the reference by %g", kernel->name, way,
                     largest);
}

static int compare_doubles(const void *a, const void *b)
{
  const double l = *(const double *)a, r = *(const double *)b;
  return (l > r) - (l < r);
}

/* Median rates, in million updates a second, of several subjects taken in turn. */
static void measure(struct subject *subjects, int count, const struct bench_report *report, double *rates)
{
  double samples[16][REPEATS];
  const double cells = (double)subjects[0].flow.populations.nx * subjects[0].flow.populations.ny;
  for (int r = -1; r < REPEATS; r++)
    for (int k = 0; k < count; k++) {
      const int depth = subjects[k].way == BLOCKED ? subjects[k].blocking.depth : 2;
      const int steps = depth * (int)fmax(1, (report->quick ? 1e6 : 2e8) / cells / depth);
      const double start = clock_now();
#pragma omp parallel
      take_steps(&subjects[k], steps);
      if (r >= 0) samples[k][r] = cells * steps / (clock_now() - start) / 1e6;
    }
  for (int k = 0; k < count; k++) {
    qsort(samples[k], REPEATS, sizeof samples[k][0], compare_doubles);
    rates[k] = samples[k][REPEATS / 2];
  }
}

/* One row of the table: a kernel in a box of size^2, in all ways; the blocked depths where `depths` says so. */
static bool bench_kernel(const struct sweep_kernel *kernel, int size, bool depths, const struct bench_report *report,
                         struct status *status)
{
  static const int all_depths[] = {1, 2, 4, 8, 16, 32};
  enum { DEPTHS = sizeof all_depths / sizeof all_depths[0] };
  const struct scene scene = periodic_box(size, size, kernel);
  const struct blocking none = {1, 0};
  struct subject subjects[3 + DEPTHS];
  double rates[3 + DEPTHS];
  int count = 0;
  for (enum way way = IN_PLACE; way <= PLAIN; way++) {
    if (way != PLAIN && !verify(kernel, way, &none, status)) return false;
    if (!subject_create(&subjects[count++], &scene, way, &none, status)) return false;
  }
  for (int d = 0; depths && d < DEPTHS; d++) {
    const struct blocking blocking = {all_depths[d], 0};
    if (all_depths[d] <= blocked_deepest(SMALL_Y, omp_get_max_threads()) && !verify(kernel, BLOCKED, &blocking, status))
      return false;
    if (!subject_create(&subjects[count++], &scene, BLOCKED, &blocking, status)) return false;
  }
  measure(subjects, count, report, rates);
  for (int k = 0; k < count; k++) subject_destroy(&subjects[k]);
  const double bytes = 2 * Q * (kernel->precision == PRECISION_DOUBLE ? 8 : 4);
  printf("%-17s %5d %4d %8.0f %6.2f %6.1f %8.0f %6.2f", kernel->name, size, omp_get_max_threads(), rates[0],
         rates[0] / rates[2], rates[0] * bytes / 1e3, rates[1], rates[0] / rates[1]);
  for (int d = 0; depths && d < DEPTHS; d++) printf(" %6.0f", rates[3 + d]);
  printf("\n");
  fflush(stdout);
  if (!report->json) return true;
  fprintf(report->json, ", \"%s %d %d\": {\"in_place\": %.6g, \"two_arrays\": %.6g, \"plain\": %.6g", kernel->name,
          size, omp_get_max_threads(), rates[0], rates[1], rates[2]);
  for (int d = 0; depths && d < DEPTHS; d++)
    fprintf(report->json, ", \"blocked_%d\": %.6g", all_depths[d], rates[3 + d]);
  fprintf(report->json, "}");
  return true;
}

/* All kernels that run here in the smallest box; beyond it the best of each precision, with blocking. */
static bool bench_size(int size, const struct bench_report *report, struct status *status)
{
  bool runs, best[2] = {true, true};
  const struct sweep_kernel *kernel;
  for (size_t k = 0; (kernel = sweep_kernel_at(k, &runs)); k++) {
    if (!runs || (size > 128 && !best[kernel->precision])) continue;
    if (!bench_kernel(kernel, size, size > 128, report, status)) return false;
    best[kernel->precision] = false;
  }
  return true;
}

bool bench_sweep(const struct bench_report *report, struct status *status)
{
  static const int sizes[] = {128, 1024, 4096};
  const int all = omp_get_max_threads();
  bool ok = true;
  bench_describe_machine(report);
  printf("million cell updates a second; of plain: part of a plain read-modify-write of the same planes; blocked d: d "
         "steps a pass\n");
  printf("%-17s %5s %4s %8s %6s %6s %8s %6s %6s %6s %6s %6s %6s %6s\n", "kernel", "size", "thr", "in place", "plain",
         "GB/s", "2 arrays", "ratio", "d=1", "2", "4", "8", "16", "32");
  for (size_t s = 0; ok && s < (report->quick ? 1 : sizeof sizes / sizeof sizes[0]); s++)
    for (int threads = 1; ok && threads <= all; threads = threads < all && 2 * threads > all ? all : 2 * threads) {
      omp_set_num_threads(threads);
      ok = bench_size(sizes[s], report, status);
    }
  omp_set_num_threads(all);
  return ok;
}
