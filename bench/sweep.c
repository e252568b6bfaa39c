/* The fluid sweep alone: million cell updates a second of each kernel, in place, from one array to another (the
 * classic scheme), and blocked in time, beside an in-place read-modify-write of the same nine planes: the memory
 * bound of 18 values an update. Rates are medians of alternating repeats, in a box that is periodic both ways.
 *
 * Every kernel is compared with reference.h at the rates of every collision in a small box. So is each timed
 * subject: from an initial state of waves it takes a few steps, and two windows of cells are compared. */
#include "accuracy.h"
#include "base/clock.h"
#include "bench.h"
#include "fluid/boundary.h"
#include "reference.h"
#include "sim/blocked.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { REPEATS = 5, SMALL_X = 40, SMALL_Y = 34, DEPTHS = 6 };
static const int depths[DEPTHS] = {1, 2, 4, 8, 16, 32};

/* Ways to take a step. */
enum way { IN_PLACE, TWO_ARRAYS, PLAIN, BLOCKED };

struct subject {
  enum way way;
  struct blocking blocking;
  struct flow flow;
  struct populations other; /* the second array */
};

/* Nine planes read, changed and written: the memory traffic of an in-place update with little arithmetic. */
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

/* Row y pulls its populations from `from` and writes them collided to `to`; columns beside the box are periodic
 * images. */
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
    subject->flow.kernel->two_arrays[subject->flow.adaptive](source, target, from->nx, &subject->flow.constants);
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

/* Waves so fast that adaptive and constant rates differ by far more than the round-off of single precision. */
static void set_waves(struct populations *p)
{
#pragma omp parallel for schedule(static)
  for (int y = 0; y < p->ny; y++)
    for (int x = 0; x < p->nx; x++)
      for (int i = 0; i < Q; i++) {
        const double wave = 0.05 * sin(2 * M_PI * x / p->nx + i) * cos(2 * M_PI * y / p->ny - i);
        populations_set(p, populations_slot(p, i, x, y), wave * d2q9_weight[i]);
      }
}

static bool subject_create(struct subject *subject, const struct scene *scene, enum way way,
                           const struct blocking *blocking, struct status *status)
{
  const struct stages stages = stages_of(scene);
  *subject = (struct subject){.way = way, .blocking = *blocking};
  if (!flow_create(&subject->flow, scene, &stages, status)) return false;
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

/* A periodic box with a kernel and the rates of a collision. */
static struct scene periodic_box(int nx, int ny, const struct sweep_kernel *kernel, enum accuracy_operator operator)
{
  const struct accuracy_choice choice = {.operator= operator, .precision = kernel->precision };
  struct scene scene = accuracy_scene(&choice, nx, ny, 0.05, SIDES_PERIODIC);
  scene.fluid.kernel = (char *)kernel->name;
  return scene;
}

/* Cells x .. x + nx - 1, y .. y + ny - 1 of the periodic box, with indices beyond its sides. */
struct window {
  int x, y, nx, ny;
};

/* f_i of the subject at a cell of the window, after an even number of steps. */
static double value_at(const struct subject *subject, const struct window *window, int x, int y, int i)
{
  const struct populations *p = &subject->flow.populations;
  const size_t slot = populations_slot(p, i, (window->x + x + p->nx) % p->nx, (window->y + y + p->ny) % p->ny);
  return populations_get(p, slot) + d2q9_weight[i];
}

/* Copies the window's populations to the reference. The two-array subject stores collided populations, which are
 * streamed here. */
static void copy_window(const struct subject *subject, const struct window *window, struct reference *reference)
{
  for (int y = 0; y < window->ny; y++)
    for (int x = 0; x < window->nx; x++)
      for (int i = 0; i < Q; i++) {
        const bool back = subject->way == TWO_ARRAYS;
        reference->f[(y * window->nx + x) * Q + i] =
            value_at(subject, window, back ? x - d2q9_ex[i] : x, back ? y - d2q9_ey[i] : y, i);
      }
}

/* Largest difference over cells of the window at least `margin` from its edge. */
static double largest_difference(const struct subject *subject, const struct window *window, int margin,
                                 const struct reference *reference)
{
  const double *expected = subject->way == TWO_ARRAYS ? reference->collided : reference->f;
  double largest = 0;
  for (int y = margin; y < window->ny - margin; y++)
    for (int x = margin; x < window->nx - margin; x++)
      for (int i = 0; i < Q; i++) {
        const double off = fabs(value_at(subject, window, x, y, i) - expected[(y * window->nx + x) * Q + i]);
        if (isnan(off)) return INFINITY;
        largest = fmax(largest, off);
      }
  return largest;
}

/* Number of steps of a check: even, and whole blocks. */
static int steps_to_check(const struct subject *subject)
{
  const int depth = subject->way == BLOCKED ? subject->blocking.depth : 1;
  return depth < 6 ? 12 / depth * depth : depth;
}

/* The subject takes a few steps and must agree with the reference in each of `count` windows. The reference has the
 * window alone, so cells nearer to its edge than one cell a step are not compared, unless the window is the whole
 * box. */
static bool agrees(struct subject *subject, const struct window *windows, int count, double *largest,
                   struct status *status)
{
  const int steps = steps_to_check(subject);
  const struct populations *p = &subject->flow.populations;
  const struct reference_cover none = {0};
  struct reference references[2] = {{0}};
  bool ok = true;
  for (int w = 0; ok && w < count; w++) {
    ok = reference_create(&references[w], windows[w].nx, windows[w].ny, status);
    if (ok) copy_window(subject, &windows[w], &references[w]);
  }
#pragma omp parallel if (ok)
  if (ok) take_steps(subject, steps);
  *largest = 0;
  for (int w = 0; ok && w < count; w++) {
    const bool whole = windows[w].nx == p->nx && windows[w].ny == p->ny;
    for (int k = 0; k < steps; k++)
      reference_step(&references[w], subject->flow.scene->domain.side, &subject->flow.constants, &none);
    *largest = fmax(*largest, largest_difference(subject, &windows[w], whole ? 0 : steps, &references[w]));
  }
  for (int w = 0; w < count; w++) reference_destroy(&references[w]);
  return ok;
}
static bool verify(struct subject *subject, const struct window *windows, int count, struct status *status)
{
  static const char *const ways[] = {"in place", "two arrays", "plain", "blocked"};
  const struct sweep_kernel *kernel = subject->flow.kernel;
  double off;
  set_waves(&subject->flow.populations);
  if (!agrees(subject, windows, count, &off, status)) return false;
  if (off <= (kernel->precision == PRECISION_DOUBLE ? 2e-15 : 2e-8)) return true;
  return status_fail(
      status, DELBM_FAILED, "bench sweep: %s, %s, %s rates, %d columns: differs from the reference by %g", kernel->name,
      ways[subject->way], subject->flow.adaptive ? "adaptive" : "constant", subject->flow.populations.nx, off);
}

/* Checks every way with the rates of every collision over a whole small box. */
static bool verify_collisions(const struct sweep_kernel *kernel, struct status *status)
{
  static const enum way ways[] = {IN_PLACE, TWO_ARRAYS, BLOCKED};
  static const enum accuracy_operator operators[] = {OPERATOR_BGK, OPERATOR_TRT, OPERATOR_MRT, OPERATOR_ADAPTIVE};
  const int deepest = blocked_max_depth(SMALL_Y, omp_get_max_threads());
  const struct blocking blocking = {deepest < 4 ? 1 : 4, 0};
  const struct window whole = {0, 0, SMALL_X, SMALL_Y};
  bool ok = true;
  for (int o = 0; ok && o < 4; o++)
    for (int w = 0; ok && w < 3; w++) {
      const struct scene scene = periodic_box(SMALL_X, SMALL_Y, kernel, operators[o]);
      struct subject subject;
      ok = subject_create(&subject, &scene, ways[w], &blocking, status) && verify(&subject, &whole, 1, status);
      subject_destroy(&subject);
    }
  return ok;
}

/* Checks a timed subject at a corner of the box and in its middle, at the border of threads. */
static bool verify_timed(struct subject *subject, struct status *status)
{
  const struct populations *p = &subject->flow.populations;
  const int margin = steps_to_check(subject), edge = 8 + 2 * margin;
  const struct window windows[2] = {{-edge / 2, -edge / 2, edge, edge},
                                    {p->nx / 2 - edge / 2, p->ny / 2 - edge / 2, edge, edge}};
  return verify(subject, windows, 2, status);
}

static int compare_doubles(const void *a, const void *b)
{
  const double l = *(const double *)a, r = *(const double *)b;
  return (l > r) - (l < r);
}

/* Subjects of a kernel in a box of size^2: as in the program, from one array to another, the read-modify-write, in
 * place with constant rates, and blocked in time. */
enum { DEFAULT, CLASSIC, BARE, CONSTANT, DEEP, SUBJECTS = DEEP + DEPTHS };

struct comparison {
  const struct sweep_kernel *kernel;
  int size;
  struct scene adaptive, constant;
  struct subject subjects[SUBJECTS];
  int count; /* of subjects: only depths possible for the threads */
  double rates[SUBJECTS];
};

static bool comparison_create(struct comparison *c, const struct sweep_kernel *kernel, int size, bool blocked,
                              struct status *status)
{
  static const enum way ways[] = {[DEFAULT] = IN_PLACE, [CLASSIC] = TWO_ARRAYS, [BARE] = PLAIN, [CONSTANT] = IN_PLACE};
  const int deepest = blocked_max_depth(size, omp_get_max_threads());
  *c = (struct comparison){.kernel = kernel,
                           .size = size,
                           .adaptive = periodic_box(size, size, kernel, OPERATOR_ADAPTIVE),
                           .constant = periodic_box(size, size, kernel, OPERATOR_MRT)};
  int wanted = DEEP;
  while (blocked && wanted < SUBJECTS && depths[wanted - DEEP] <= deepest) wanted++;
  for (; c->count < wanted; c->count++) {
    const int k = c->count;
    const struct blocking blocking = {k < DEEP ? 1 : depths[k - DEEP], 0};
    if (!subject_create(&c->subjects[k], k == CONSTANT ? &c->constant : &c->adaptive, k < DEEP ? ways[k] : BLOCKED,
                        &blocking, status))
      return false;
  }
  return true;
}

static void comparison_destroy(struct comparison *c)
{
  for (int k = 0; k < SUBJECTS; k++) subject_destroy(&c->subjects[k]);
}

/* Median rates of the subjects, timed in turn, in million updates a second. */
static void measure(struct comparison *c, bool quick)
{
  double samples[SUBJECTS][REPEATS];
  const double cells = (double)c->size * c->size;
  for (int r = -1; r < REPEATS; r++)
    for (int k = 0; k < c->count; k++) {
      const int block = (int)fmax(2, c->subjects[k].blocking.depth);
      const int steps = block * (int)fmax(1, (quick ? 1e6 : 2e8) / cells / block);
      const double start = clock_now();
#pragma omp parallel
      take_steps(&c->subjects[k], steps);
      if (r >= 0) samples[k][r] = cells * steps / (clock_now() - start) / 1e6;
    }
  for (int k = 0; k < c->count; k++) {
    qsort(samples[k], REPEATS, sizeof samples[k][0], compare_doubles);
    c->rates[k] = samples[k][REPEATS / 2];
  }
}

static void report_comparison(const struct comparison *c, FILE *json)
{
  const double *rates = c->rates;
  const double bytes = 2 * Q * (c->kernel->precision == PRECISION_DOUBLE ? 8 : 4);
  printf("%-17s %5d %4d %8.0f %6.2f %6.1f %8.0f %6.2f %8.0f", c->kernel->name, c->size, omp_get_max_threads(),
         rates[DEFAULT], rates[DEFAULT] / rates[BARE], rates[DEFAULT] * bytes / 1e3, rates[CLASSIC],
         rates[DEFAULT] / rates[CLASSIC], rates[CONSTANT]);
  for (int k = DEEP; k < c->count; k++) printf(" %6.0f", rates[k]);
  printf("\n");
  fflush(stdout);
  if (!json) return;
  fprintf(json, ", \"%s %d %d\": {\"in_place\": %.6g, \"two_arrays\": %.6g, \"plain\": %.6g, \"constant_rates\": %.6g",
          c->kernel->name, c->size, omp_get_max_threads(), rates[DEFAULT], rates[CLASSIC], rates[BARE],
          rates[CONSTANT]);
  for (int k = DEEP; k < c->count; k++) fprintf(json, ", \"blocked_%d\": %.6g", depths[k - DEEP], rates[k]);
  fprintf(json, "}");
}

/* One row of the table. */
static bool bench_kernel(const struct sweep_kernel *kernel, int size, bool blocked, const struct bench_report *report,
                         struct status *status)
{
  struct comparison comparison = {0};
  bool ok = verify_collisions(kernel, status) && comparison_create(&comparison, kernel, size, blocked, status);
  if (ok) measure(&comparison, report->quick);
  for (int k = 0; ok && k < comparison.count; k++) ok = k == BARE || verify_timed(&comparison.subjects[k], status);
  if (ok) report_comparison(&comparison, report->json);
  comparison_destroy(&comparison);
  return ok;
}

/* The smallest box: all kernels that this machine supports. Larger boxes: the best of each precision, with blocking. */
static bool bench_size(int size, bool smallest, const struct bench_report *report, struct status *status)
{
  bool runs, best[2] = {true, true};
  const struct sweep_kernel *kernel;
  for (size_t k = 0; (kernel = sweep_kernel_at(k, &runs)); k++) {
    if (!runs || (!smallest && !best[kernel->precision])) continue;
    if (!bench_kernel(kernel, size, !smallest, report, status)) return false;
    best[kernel->precision] = false;
  }
  return true;
}

bool bench_sweep(const struct bench_report *report, struct status *status)
{
  static const int full[] = {128, 1024, 4096}, quick[] = {96, 192, 256};
  const int all = omp_get_max_threads();
  bool ok = true;
  bench_describe_machine(report);
  printf("million cell updates a second; of plain: part of a plain read-modify-write of the same planes; constant: in "
         "place with the rates of mrt;\nblocked d: d steps a pass\n");
  printf("%-17s %5s %4s %8s %6s %6s %8s %6s %8s %6s %6s %6s %6s %6s %6s\n", "kernel", "size", "thr", "in place",
         "plain", "GB/s", "2 arrays", "ratio", "constant", "d=1", "2", "4", "8", "16", "32");
  for (int s = 0; ok && s < 3; s++)
    for (int threads = 1; ok && threads <= all; threads = threads < all && 2 * threads > all ? all : 2 * threads) {
      omp_set_num_threads(threads);
      ok = bench_size(report->quick ? quick[s] : full[s], s == 0, report, status);
    }
  omp_set_num_threads(all);
  return ok;
}
