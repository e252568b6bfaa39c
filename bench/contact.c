/* What finding contacts costs (the paper's Fig. 6): by the grid on top of the occupation update that it reuses, by linked
 * cells of 200 x 200, and by linked cells of one diameter; how the overlap areas by `cells` and `lens` compare; and the
 * whole contact stage in a run. Discs stand on a jittered grid, some of them touching, and creep: every step paints all
 * bands anew. Each search's pairs are held against those of all pairs. */
#include "base/clock.h"
#include "bench.h"
#include "contact/linked_cell.h"
#include "scenes.h"
#include "sim/simulation.h"
#include "sim/stages.h"
#include "solid/lens.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>

enum { STEPS = 100 }; /* the paper's */

/* What is timed: occupation alone, and with each kind of search. */
enum way { PAINT, GRID, GRID_AREAS, COARSE, TUNED, WAY_COUNT };

struct crowd {
  struct scene scene;
  struct discs discs;
  int reach;
  struct occupation occupations[3]; /* of PAINT, GRID and GRID_AREAS */
  struct linked_cell linked[2];     /* of COARSE and TUNED */
  struct pair_list pairs[WAY_COUNT];
  double *vx, *vy;
};

struct figures {
  double ms[WAY_COUNT]; /* medians; of the grid what it adds to PAINT: the difference, not below 0, and the join */
  size_t pairs, shared_cells;
  double lens_ms, area_error; /* closed form of all pairs; r.m.s. of the difference by cells over the mean area */
};

static bool allocate(struct crowd *c, struct status *status)
{
  static const enum pair_search searches[] = {PAIRS_NONE, PAIRS_ONCE, PAIRS_WITH_AREA};
  static const double edges[] = {200, 0};
  for (int k = 0; k < 3; k++) {
    if (!occupation_create(&c->occupations[k], &c->scene, &c->discs, c->reach, status)) return false;
    c->occupations[k].search = searches[k];
  }
  for (int k = 0; k < 2; k++)
    if (!linked_cell_create(&c->linked[k], &c->scene, &c->discs, edges[k], c->reach, status)) return false;
  for (int way = GRID; way < WAY_COUNT; way++)
    if (!overlap_create(&c->pairs[way], c->discs.count, status)) return false;
  return true;
}

/* n x n discs, each on its own square of the box. */
static bool crowd_create(struct crowd *c, int n, double radius, int size, struct status *status)
{
  const double spacing = (double)size / n;
  gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
  *c = (struct crowd){.scene = scene_crowd(size, size, radius, spacing, spacing / 2 - radius + 0.2)};
  c->reach = stages_of(&c->scene).reach;
  const bool ok = discs_create(&c->discs, &c->scene, status) && allocate(c, status) &&
                  (c->vx = calloc(c->discs.count, sizeof *c->vx)) && (c->vy = calloc(c->discs.count, sizeof *c->vy));
  for (size_t i = 0; ok && i < c->discs.count; i++) {
    c->vx[i] = gsl_ran_flat(random, -0.002, 0.002);
    c->vy[i] = gsl_ran_flat(random, -0.002, 0.002);
  }
  gsl_rng_free(random);
  return ok;
}

static void crowd_destroy(struct crowd *c)
{
  for (int k = 0; k < 3; k++) occupation_destroy(&c->occupations[k]);
  for (int k = 0; k < 2; k++) linked_cell_destroy(&c->linked[k]);
  for (int way = GRID; way < WAY_COUNT; way++) overlap_destroy(&c->pairs[way]);
  discs_destroy(&c->discs);
  scene_clear(&c->scene);
  free(c->vx);
  free(c->vy);
}

/* Milliseconds of the search, and of those that joined what bands have found. */
static bool search(struct crowd *c, enum way way, double *ms, double *join_ms, struct status *status)
{
  struct team team = {0};
  const double start = clock_now();
#pragma omp parallel
  if (way < COARSE)
    stage_occupation(&c->occupations[way], &c->discs, &team);
  else
    linked_cell_find(&c->linked[way - COARSE], &c->discs, &c->pairs[way], &team);
  if (team.failed) *status = team.first;
  const double found = clock_now();
  *ms = 1e3 * (found - start);
  *join_ms = 0;
  if (team.failed || way == PAINT || way >= COARSE) return !team.failed;
  const struct occupation *o = &c->occupations[way];
  const bool ok = overlap_join(&c->pairs[way], o->batches, (size_t)o->band_count, o->discs, status);
  *join_ms = 1e3 * (clock_now() - found);
  return ok;
}

/* Gap between two discs of a closed box. */
static double gap(const struct discs *d, size_t a, size_t b)
{
  const double dx = d->x[b] - d->x[a], dy = d->y[b] - d->y[a];
  return sqrt(dx * dx + dy * dy) - d->radius[a] - d->radius[b];
}

/* Whether a list holds all the pairs within reach, which `count` counts. Candidates beyond it may stand among them. */
static bool verify(const struct crowd *c, enum way way, size_t count, struct status *status)
{
  size_t found = 0;
  for (size_t p = 0; p < c->pairs[way].count; p++)
    found += gap(&c->discs, c->pairs[way].pairs[p].a, c->pairs[way].pairs[p].b) < c->reach;
  return found == count ||
         status_fail(status, DELBM_FAILED, "bench contact: search %d found %zu of %zu pairs", way, found, count);
}

static bool verify_all(const struct crowd *c, size_t *count, struct status *status)
{
  *count = 0;
  for (size_t a = 0; a < c->discs.count; a++)
    for (size_t b = a + 1; b < c->discs.count; b++) *count += gap(&c->discs, a, b) < c->reach;
  for (int way = GRID; way < WAY_COUNT; way++)
    if (!verify(c, way, *count, status)) return false;
  return true;
}

/* The closed form of all pairs that the grid has found, timed, against their areas by cells. */
static void compare_areas(const struct crowd *c, struct figures *f)
{
  const struct pair_list *list = &c->pairs[GRID_AREAS];
  double sum = 0, squares = 0;
  size_t touching = 0;
  const double start = clock_now();
  for (size_t p = 0; p < list->count; p++) {
    const struct near_pair *pair = &list->pairs[p];
    const double ra = c->discs.radius[pair->a], rb = c->discs.radius[pair->b];
    const double area = lens_of_discs(ra, rb, gap(&c->discs, pair->a, pair->b) + ra + rb).area;
    if (area <= 0) continue;
    touching++;
    sum += area;
    squares += (pair->cells_area - area) * (pair->cells_area - area);
  }
  f->lens_ms = 1e3 * (clock_now() - start);
  f->area_error = touching ? sqrt(squares / (double)touching) / (sum / (double)touching) : 0;
}

static void creep(struct crowd *c)
{
  for (size_t i = 0; i < c->discs.count; i++) {
    c->discs.x[i] += c->vx[i];
    c->discs.y[i] += c->vy[i];
  }
}

static bool measure(struct crowd *c, int steps, struct figures *f, struct status *status)
{
  double ms[WAY_COUNT][STEPS], join[WAY_COUNT][STEPS];
  for (int step = -2; step < steps; step++) {
    creep(c);
    for (int way = 0; way < WAY_COUNT; way++)
      if (!search(c, way, &ms[way][step < 0 ? 0 : step], &join[way][step < 0 ? 0 : step], status)) return false;
  }
  for (int way = GRID; way <= GRID_AREAS; way++)
    for (int step = 0; step < steps; step++) ms[way][step] -= ms[PAINT][step];
  for (int way = 0; way < WAY_COUNT; way++)
    f->ms[way] = fmax(0, gsl_stats_median(ms[way], 1, (size_t)steps)) + gsl_stats_median(join[way], 1, (size_t)steps);
  f->shared_cells = 0;
  for (int k = 0; k < c->occupations[GRID].band_count; k++)
    f->shared_cells += c->occupations[GRID].bands[k].shared_cells;
  compare_areas(c, f);
  return verify_all(c, &f->pairs, status);
}

static bool bench_searches(int n, double radius, int size, const struct bench_report *report, struct status *status)
{
  struct crowd crowd;
  struct figures f = {0};
  const bool packed = size <= 2 * radius * n;
  const bool ok =
      crowd_create(&crowd, n, radius, size, status) && measure(&crowd, report->quick ? 5 : STEPS, &f, status);
  if (ok) {
    printf("%6g %7zu %6d %8s %7zu %8zu %9.4f %8.4f %8.4f %9.4f %8.4f %8.4f %8.3f\n", radius, crowd.discs.count, size,
           packed ? "packed" : "dilute", f.pairs, f.shared_cells, f.ms[PAINT], f.ms[GRID], f.ms[GRID_AREAS],
           f.ms[COARSE], f.ms[TUNED], f.lens_ms, f.area_error);
    fflush(stdout);
    if (report->json)
      fprintf(
          report->json,
          "%s\n    {\"n\": %zu, \"radius\": %g, \"size\": %d, \"packed\": %d, \"pairs\": %zu, \"shared_cells\": %zu, "
          "\"occupation_ms\": %.6g, \"grid_ms\": %.6g, \"grid_areas_ms\": %.6g, \"linked200_ms\": %.6g, "
          "\"linked_tuned_ms\": %.6g, \"lens_ms\": %.6g, \"cells_error\": %.6g}",
          crowd.discs.count == 100 && radius < 3 ? "" : ",", crowd.discs.count, radius, size, packed, f.pairs,
          f.shared_cells, f.ms[PAINT], f.ms[GRID], f.ms[GRID_AREAS], f.ms[COARSE], f.ms[TUNED], f.lens_ms,
          f.area_error);
  }
  crowd_destroy(&crowd);
  return ok;
}

/* The stage in a run: search, forces, motion. */
static bool bench_stage(int n, double radius, int size, const struct bench_report *report, struct status *status)
{
  const double spacing = (double)size / n;
  const int steps = report->quick ? 2 : STEPS;
  struct scene scene = scene_crowd(size, size, radius, spacing, fmin(1, spacing / 2 - radius + 0.2));
  struct simulation *simulation = NULL;
  struct simulation_report before, after;
  bool ok = simulation_create(&simulation, &scene, status) && simulation_advance(simulation, 2, status);
  if (ok) {
    simulation_report(simulation, &before);
    ok = simulation_advance(simulation, steps, status);
    simulation_report(simulation, &after);
  }
  if (ok) {
    const double ms = 1e3 * (after.times.seconds[STAGE_CONTACT] - before.times.seconds[STAGE_CONTACT]) / steps;
    printf("%6g %7zu %6d %10.4f %9d\n", radius, scene.particles.count, size, ms, after.max_substeps);
    if (report->json)
      fprintf(report->json, "%s\n    {\"discs\": %zu, \"r\": %g, \"box\": %d, \"stage_ms\": %.6g, \"substeps\": %d}",
              n == 50 && radius < 3 ? "" : ",", scene.particles.count, radius, size, ms, after.max_substeps);
  }
  simulation_destroy(simulation);
  scene_clear(&scene);
  return ok;
}

static bool all_searches(const struct bench_report *report, struct status *status)
{
  static const int edge[] = {10, 15, 20, 30, 40, 50};
  static const double radii[] = {2, 5};
  bool ok = true;
  printf("ms a step of finding pairs, %d threads: the grid's on top of occupation; areas of all pairs\n",
         omp_get_max_threads());
  printf("%6s %7s %6s %8s %7s %8s %9s %8s %8s %9s %8s %8s %8s\n", "R", "discs", "box", "", "pairs", "shared",
         "occupat.", "grid", "+areas", "200x200", "tuned", "lens", "error");
  for (int r = 0; ok && r < 2; r++) {
    for (int k = 0; ok && k < 6; k++) ok = bench_searches(edge[k], radii[r], 1000, report, status);
    ok = ok && bench_searches(100, radii[r], (int)(400 * radii[r]), report, status) &&
         bench_searches(100, radii[r], (int)(200 * radii[r]), report, status);
  }
  return ok;
}

bool bench_contact(const struct bench_report *report, struct status *status)
{
  if (report->json) fprintf(report->json, "\"searches\": [");
  if (!all_searches(report, status)) return false;
  printf("\nms a step of the contact stage in a run\n%6s %7s %6s %10s %9s\n", "R", "discs", "box", "stage",
         "sub-steps");
  if (report->json) fprintf(report->json, "], \"stages\": [");
  const bool ok = bench_stage(50, 2, 1000, report, status) && bench_stage(50, 5, 1000, report, status) &&
                  bench_stage(100, 2, 400, report, status) && bench_stage(100, 5, 1000, report, status);
  if (report->json) fprintf(report->json, "]");
  return ok;
}
