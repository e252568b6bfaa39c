/* Cost of the occupation fractions of a disc: per cell, each area by itself; by line tables (one arcsine per grid
 * line, a corner for four cells) over every touched cell; and as in the program, where the inner cells of wide discs
 * are set to 1 without evaluation (the purpose of the paper's modified Verlet list). Then the whole stage, with
 * runs, owners' weights: with all discs moving, and with none, in which case bands are unchanged. */
#include "solid/occupation.h"
#include "base/clock.h"
#include "bench.h"
#include "disc_area.h"
#include "scenes.h"
#include "solid/solid_kernel.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { REPEATS = 5, DISC_PLACES = 16 };

enum way { CELL_BY_CELL, LINE_TABLES, RIM, WAY_COUNT };

/* eps of all cells of one disc, row by row. */
struct painting {
  double radius, x[DISC_PLACES], y[DISC_PLACES];
  double *eps;
  size_t cells;
};

static size_t rows_by_cells(double radius, double x, double y, int row, int rows, const struct row_extents *e,
                            double *eps)
{
  const int column = (int)floor(x - radius);
  size_t n = 0;
  for (int r = 0; r < rows; r++)
    for (int c = e->first[r]; c < e->end[r]; c++) eps[n++] = disc_cell_area(radius, column + c - x, row + r - y);
  return n;
}

static size_t rows_by_lines(const struct shape *disc, const struct pose *pose, int row, int rows, struct row_extents *e,
                            bool rim, double *eps)
{
  size_t n = 0;
  for (int r = 0; r < rows; r++) {
    n += (size_t)(e->end[r] - e->first[r]);
    if (!rim) e->full[r] = e->full_end[r] = e->end[r];
  }
  disc->kind->fractions(disc, pose, row, 0, rows, e, eps);
  return n;
}

static void paint_disc(struct painting *p, const struct shape *disc, enum way way, int place)
{
  const struct pose pose = {.x = p->x[place], .y = p->y[place]};
  const double x = p->x[place], y = p->y[place];
  const int first = (int)floor(y - p->radius), end = (int)ceil(y + p->radius);
  p->cells = 0;
  for (int row = first; row < end; row += BAND_ROWS) {
    const int rows = end - row < BAND_ROWS ? end - row : BAND_ROWS;
    struct row_extents e;
    disc->kind->extents(disc, &pose, row, rows, &e);
    p->cells += way == CELL_BY_CELL ? rows_by_cells(p->radius, x, y, row, rows, &e, p->eps + p->cells)
                                    : rows_by_lines(disc, &pose, row, rows, &e, way == RIM, p->eps + p->cells);
  }
}

/* Nanoseconds per disc. */
static double time_disc(struct painting *p, const struct shape *disc, enum way way, double seconds)
{
  size_t painted = 0;
  const double start = clock_now();
  do {
    for (int place = 0; place < DISC_PLACES; place++) paint_disc(p, disc, way, place);
    painted += DISC_PLACES;
  } while (clock_now() - start < seconds);
  return 1e9 * (clock_now() - start) / (double)painted;
}

/* All ways have the same fractions, and their sum is the disc's area. */
static bool verify(struct painting *p, const struct shape *disc, struct status *status)
{
  for (int place = 0; place < DISC_PLACES; place++)
    for (enum way way = 0; way < WAY_COUNT; way++) {
      double sum = 0;
      paint_disc(p, disc, way, place);
      for (size_t k = 0; k < p->cells; k++) sum += p->eps[k];
      const double error = fabs(sum / (M_PI * p->radius * p->radius) - 1);
      if (!(error < 1e-13 * fmax(100, p->radius)))
        return status_fail(status, DELBM_FAILED, "bench occupation: R = %g, way %d: area off by %g", p->radius,
                           (int)way, error);
    }
  return true;
}

static bool measure_disc(double radius, const struct bench_report *report, double ns[WAY_COUNT], struct status *status)
{
  const size_t width = (size_t)ceil(2 * radius) + 3;
  const struct shape disc = {.kind = &solid_kernel_find(NULL)->disc, .radius = radius};
  struct painting p = {.radius = radius, .eps = malloc((width * width + SHAPE_PAD) * sizeof *p.eps)};
  gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
  for (int k = 0; k < DISC_PLACES; k++) {
    p.x[k] = 1e4 + gsl_ran_flat(random, 0, 1);
    p.y[k] = 1e4 + gsl_ran_flat(random, 0, 1);
  }
  const bool ok = p.eps ? verify(&p, &disc, status)
                        : status_fail(status, DELBM_IO, "bench occupation: no memory for a disc of R = %g", radius);
  double samples[WAY_COUNT][REPEATS];
  for (int r = 0; ok && r < REPEATS; r++)
    for (enum way way = 0; way < WAY_COUNT; way++)
      samples[way][r] = time_disc(&p, &disc, way, report->quick ? 1e-4 : 0.02);
  for (enum way way = 0; ok && way < WAY_COUNT; way++) ns[way] = gsl_stats_median(samples[way], 1, REPEATS);
  gsl_rng_free(random);
  free(p.eps);
  return ok;
}

static bool same_row(const struct occupation *a, const struct occupation *b, int y)
{
  size_t count, other;
  const struct run *left = occupation_row(a, y, &count), *right = occupation_row(b, y, &other);
  if (count != other) return false;
  for (size_t k = 0; k < count; k++) {
    const double *l = occupation_band(a, y)->owner_weight + left[k].first,
                 *r = occupation_band(b, y)->owner_weight + right[k].first;
    if (left[k].x != right[k].x || left[k].n != right[k].n || left[k].owner != right[k].owner ||
        left[k].rx != right[k].rx || left[k].ry != right[k].ry || memcmp(l, r, (size_t)left[k].n * sizeof *l) != 0)
      return false;
  }
  return true;
}

/* After many steps the stage has the same bits as a new stage at the same positions. */
static bool verify_stage(const struct occupation *o, const struct scene *scene, const struct discs *d,
                         struct status *status)
{
  struct occupation fresh = {0};
  struct team team = {0};
  bool ok = occupation_create(&fresh, scene, d, status);
  if (ok) stage_occupation(&fresh, d, &team);
  if (team.failed) *status = team.first;
  ok = ok && !team.failed;
  for (int y = 0; ok && y < scene->domain.size[1]; y++)
    ok = same_row(o, &fresh, y) ||
         status_fail(status, DELBM_FAILED, "bench occupation: %zu discs: row %d is not as painted anew", d->count, y);
  occupation_destroy(&fresh);
  return ok;
}

/* Milliseconds of the stage over a crowd of solid fraction 0.196. */
static bool measure_stage(double radius, int size, bool moving, size_t *discs, double *ms, struct status *status)
{
  struct scene scene = scene_crowd(size, size, radius, 4 * radius, radius / 5);
  struct discs d;
  struct occupation o = {0};
  double samples[4 * REPEATS];
  bool ok = discs_create(&d, &scene, status) && occupation_create(&o, &scene, &d, status);
  for (int r = -2; ok && r < 4 * REPEATS; r++) {
    struct team team = {0};
    for (size_t i = 0; moving && i < d.count; i++) d.y[i] -= 0.01;
    const double start = clock_now();
#pragma omp parallel
    stage_occupation(&o, &d, &team);
    samples[r < 0 ? 0 : r] = 1e3 * (clock_now() - start);
    if (team.failed) *status = team.first;
    ok = !team.failed;
  }
  ok = ok && verify_stage(&o, &scene, &d, status);
  if (ok) *ms = gsl_stats_median(samples, 1, 4 * REPEATS);
  *discs = d.count;
  occupation_destroy(&o);
  discs_destroy(&d);
  scene_clear(&scene);
  return ok;
}

bool bench_occupation(const struct bench_report *report, struct status *status)
{
  static const double radii[] = {2, 5, 10, 12, 20, 50, 200, 1000};
  const size_t count = report->quick ? 4 : sizeof radii / sizeof radii[0];
  printf("ns a disc, one thread: areas of all its cells; and ms of the stage at solid fraction 0.196, %d threads\n",
         omp_get_max_threads());
  printf("%6s %12s %12s %12s %8s %8s %7s %9s %9s\n", "R", "by cells", "line tables", "rim only", "lines", "rim",
         "discs", "moving", "at rest");
  for (size_t k = 0; k < count; k++) {
    double ns[WAY_COUNT], moving, resting;
    size_t discs;
    const int size = radii[k] < 100 ? 1000 : (int)(4 * radii[k]);
    if (!measure_disc(radii[k], report, ns, status) || !measure_stage(radii[k], size, true, &discs, &moving, status) ||
        !measure_stage(radii[k], size, false, &discs, &resting, status))
      return false;
    printf("%6g %12.1f %12.1f %12.1f %8.1f %8.2f %7zu %9.4f %9.4f\n", radii[k], ns[CELL_BY_CELL], ns[LINE_TABLES],
           ns[RIM], ns[CELL_BY_CELL] / ns[LINE_TABLES], ns[LINE_TABLES] / ns[RIM], discs, moving, resting);
    fflush(stdout);
    if (report->json)
      fprintf(report->json,
              "%s\"R = %g\": {\"cell_by_cell_ns\": %.6g, \"line_tables_ns\": %.6g, \"rim_ns\": %.6g, \"discs\": %zu, "
              "\"moving_ms\": %.6g, \"resting_ms\": %.6g}",
              k ? ",\n    " : "", radii[k], ns[CELL_BY_CELL], ns[LINE_TABLES], ns[RIM], discs, moving, resting);
  }
  return true;
}
