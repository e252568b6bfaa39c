/* Cost of the contact search (the paper's Fig. 6): a pair list from the grid of the occupation, from linked cells of 200 x 200, and
 * from linked cells of one diameter; mean cost per step, and cost of one construction of the list; overlap areas by `cells` and
 * `lens`; and the whole contact stage in a run. Discs are on a jittered grid, some in contact, and creep by up to 0.02 cells a
 * step, about the speed of settling, so that a list lasts 20 to 30 steps. The pairs of each search are compared with a search
 * over all pairs. */
#include "base/clock.h"
#include "bench.h"
#include "contact/cells_area.h"
#include "contact/census.h"
#include "contact/pairs.h"
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

enum { STEPS = 100, BUILDS = 5 }; /* steps: the paper's */

enum search { GRID, COARSE, TUNED, SEARCH_COUNT };

struct crowd {
  struct scene scene;
  struct discs discs;
  double near; /* gap below which pairs are wanted */
  struct occupation occupation;
  struct pair_list pairs[SEARCH_COUNT];
  double *vx, *vy, *scratch;
};

struct figures {
  double occupation_ms;          /* median */
  double step_ms[SEARCH_COUNT];  /* mean over the steps, buildings of the list included */
  double build_ms[SEARCH_COUNT]; /* median of one building */
  size_t pairs, shared_cells;
  double cells_ms, lens_ms, area_error; /* areas of all pairs; r.m.s. of the difference by cells over the mean area */
};

static bool allocate(struct crowd *c, struct status *status)
{
  static const double edges[SEARCH_COUNT] = {0, 200, 0};
  if (!occupation_create(&c->occupation, &c->scene, &c->discs, status)) return false;
  for (enum search k = 0; k < SEARCH_COUNT; k++) {
    c->scene.contact.search = k == GRID ? SEARCH_GRID : SEARCH_LINKED_CELL;
    c->scene.contact.edge = edges[k];
    if (!pairs_create(&c->pairs[k], &c->scene, &c->discs, true, c->near, status)) return false;
  }
  c->vx = calloc(c->discs.count, sizeof *c->vx);
  c->vy = calloc(c->discs.count, sizeof *c->vy);
  c->scratch = calloc(cells_area_scratch(&c->discs), sizeof *c->scratch);
  return (c->vx && c->vy && c->scratch) || status_fail(status, DELBM_FAILED, "bench contact: no memory");
}

/* n x n discs, one in each square of the box. */
static bool crowd_create(struct crowd *c, int n, double radius, int size, struct status *status)
{
  const double spacing = (double)size / n;
  gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
  *c = (struct crowd){.scene = scene_crowd(size, size, radius, spacing, spacing / 2 - radius + 0.2)};
  c->near = stages_of(&c->scene).substeps ? 1 : 0;
  const bool ok = discs_create(&c->discs, &c->scene, status) && allocate(c, status);
  for (size_t i = 0; ok && i < c->discs.count; i++) {
    c->vx[i] = gsl_ran_flat(random, -0.02, 0.02);
    c->vy[i] = gsl_ran_flat(random, -0.02, 0.02);
  }
  gsl_rng_free(random);
  return ok;
}

static void crowd_destroy(struct crowd *c)
{
  occupation_destroy(&c->occupation);
  for (enum search k = 0; k < SEARCH_COUNT; k++) pairs_destroy(&c->pairs[k]);
  discs_destroy(&c->discs);
  scene_clear(&c->scene);
  free(c->vx);
  free(c->vy);
  free(c->scratch);
}

/* Milliseconds of the occupation, and of bringing each list up to date. */
static bool search_all(struct crowd *c, double *occupation_ms, double ms[SEARCH_COUNT], struct status *status)
{
  struct team team = {0};
  double since = clock_now();
#pragma omp parallel
  stage_occupation(&c->occupation, &c->discs, &team);
  *occupation_ms = 1e3 * (clock_now() - since);
  for (enum search k = 0; k < SEARCH_COUNT && !team.failed; k++) {
    since = clock_now();
#pragma omp parallel
    pairs_update(&c->pairs[k], &c->occupation, &c->discs, &team, &(bool){false});
    ms[k] = 1e3 * (clock_now() - since);
  }
  if (team.failed) *status = team.first;
  return !team.failed;
}

/* Gap between two discs of a closed box. */
static double gap(const struct discs *d, size_t a, size_t b)
{
  const double dx = d->x[b] - d->x[a], dy = d->y[b] - d->y[a];
  return sqrt(dx * dx + dy * dy) - d->radius[a] - d->radius[b];
}

/* True if each list contains all pairs below the gap; *count: their number. */
static bool verify_all(const struct crowd *c, size_t *count, struct status *status)
{
  *count = 0;
  for (size_t a = 0; a < c->discs.count; a++)
    for (size_t b = a + 1; b < c->discs.count; b++) *count += gap(&c->discs, a, b) < c->near;
  for (enum search k = 0; k < SEARCH_COUNT; k++) {
    size_t found = 0;
    for (size_t p = 0; p < c->pairs[k].count; p++)
      found += gap(&c->discs, c->pairs[k].pairs[p].a, c->pairs[k].pairs[p].b) < c->near;
    if (found != *count)
      return status_fail(status, DELBM_FAILED, "bench contact: search %d found %zu of %zu pairs", k, found, *count);
  }
  return true;
}

/* Areas of all pairs that touch, by cells and in closed form, timed. */
static bool compare_areas(struct crowd *c, struct figures *f, struct status *status)
{
  const struct pair_list *list = &c->pairs[GRID];
  double *by_cells = calloc(list->count + 1, sizeof *by_cells), sum = 0, squares = 0;
  size_t touching = 0;
  if (!by_cells) return status_fail(status, DELBM_FAILED, "bench contact: no memory");
  double since = clock_now();
  for (size_t p = 0; p < list->count; p++) {
    const struct pair *pair = &list->pairs[p];
    if (gap(&c->discs, pair->a, pair->b) < cells_area_gap)
      by_cells[p] = cells_area(&c->scene, &c->discs, pair->a, pair->b, c->scratch);
  }
  f->cells_ms = 1e3 * (clock_now() - since);
  since = clock_now();
  for (size_t p = 0; p < list->count; p++) {
    const struct pair *pair = &list->pairs[p];
    const double ra = c->discs.radius[pair->a], rb = c->discs.radius[pair->b];
    const double area = lens_of_discs(ra, rb, gap(&c->discs, pair->a, pair->b) + ra + rb).area;
    if (area <= 0) continue;
    touching++;
    sum += area;
    squares += (by_cells[p] - area) * (by_cells[p] - area);
  }
  f->lens_ms = 1e3 * (clock_now() - since);
  f->area_error = touching ? sqrt(squares / (double)touching) / (sum / (double)touching) : 0;
  free(by_cells);
  return true;
}

static void creep(struct crowd *c)
{
  for (size_t i = 0; i < c->discs.count; i++) {
    c->discs.x[i] += c->vx[i];
    c->discs.y[i] += c->vy[i];
  }
}

/* One building of each list, as the median of some. */
static bool measure_builds(struct crowd *c, struct figures *f, struct status *status)
{
  double ms[BUILDS][SEARCH_COUNT], one[BUILDS], occupation;
  for (int n = 0; n < BUILDS; n++) {
    for (enum search k = 0; k < SEARCH_COUNT; k++) c->pairs[k].stale = true;
    if (!search_all(c, &occupation, ms[n], status)) return false;
  }
  for (enum search k = 0; k < SEARCH_COUNT; k++) {
    for (int n = 0; n < BUILDS; n++) one[n] = ms[n][k];
    f->build_ms[k] = gsl_stats_median(one, 1, BUILDS);
  }
  return true;
}

static bool measure(struct crowd *c, int steps, struct figures *f, struct status *status)
{
  double ms[SEARCH_COUNT], occupation[STEPS];
  *f = (struct figures){0};
  for (int step = -2; step < steps; step++) {
    creep(c);
    if (!search_all(c, &occupation[step < 0 ? 0 : step], ms, status)) return false;
    for (enum search k = 0; k < SEARCH_COUNT && step >= 0; k++) f->step_ms[k] += ms[k] / steps;
  }
  f->occupation_ms = gsl_stats_median(occupation, 1, (size_t)steps);
  for (int k = 0; k < c->occupation.band_count; k++) f->shared_cells += c->occupation.bands[k].shared_cells;
  return compare_areas(c, f, status) && verify_all(c, &f->pairs, status) && measure_builds(c, f, status);
}

static bool bench_searches(int n, double radius, int size, const struct bench_report *report, struct status *status)
{
  struct crowd crowd;
  struct figures f;
  const bool packed = size <= 2 * radius * n;
  const bool ok =
      crowd_create(&crowd, n, radius, size, status) && measure(&crowd, report->quick ? 5 : STEPS, &f, status);
  if (ok) {
    printf("%6g %7zu %6d %8s %7zu %8zu %9.4f %8.4f %8.4f %9.4f %9.4f %8.4f %8.4f %8.4f %8.4f %8.3f\n", radius,
           crowd.discs.count, size, packed ? "packed" : "dilute", f.pairs, f.shared_cells, f.occupation_ms,
           f.step_ms[GRID], f.build_ms[GRID], f.step_ms[COARSE], f.build_ms[COARSE], f.step_ms[TUNED],
           f.build_ms[TUNED], f.cells_ms, f.lens_ms, f.area_error);
    fflush(stdout);
    if (report->json)
      fprintf(
          report->json,
          "%s\n    {\"n\": %zu, \"radius\": %g, \"size\": %d, \"packed\": %d, \"pairs\": %zu, \"shared_cells\": %zu, "
          "\"occupation_ms\": %.6g, \"grid_ms\": %.6g, \"grid_build_ms\": %.6g, \"linked200_ms\": %.6g, "
          "\"linked200_build_ms\": %.6g, \"linked_tuned_ms\": %.6g, \"linked_tuned_build_ms\": %.6g, "
          "\"cells_ms\": %.6g, \"lens_ms\": %.6g, \"cells_error\": %.6g}",
          crowd.discs.count == 100 && radius < 3 ? "" : ",", crowd.discs.count, radius, size, packed, f.pairs,
          f.shared_cells, f.occupation_ms, f.step_ms[GRID], f.build_ms[GRID], f.step_ms[COARSE], f.build_ms[COARSE],
          f.step_ms[TUNED], f.build_ms[TUNED], f.cells_ms, f.lens_ms, f.area_error);
  }
  crowd_destroy(&crowd);
  return ok;
}

/* Of the stage in a run: ms a step, sub-steps, contacts at the end. */
struct stage_figures {
  double ms;
  int substeps;
  size_t contacts;
};

/* The stage in a run of the scene: search, forces, and sub-steps. */
static bool measure_stage(struct scene *scene, double friction, int steps, struct stage_figures *f,
                          struct status *status)
{
  struct simulation *simulation = NULL;
  struct simulation_report before, after;
  struct contact_census census = {0};
  scene->contact.friction = friction;
  bool ok = simulation_create(&simulation, scene, status) && simulation_advance(simulation, 2, status);
  if (ok) {
    simulation_report(simulation, &before);
    ok = simulation_advance(simulation, steps, status) &&
         contact_census(scene, simulation_discs(simulation), &census, status);
    simulation_report(simulation, &after);
  }
  if (ok)
    *f =
        (struct stage_figures){1e3 * (after.times.seconds[STAGE_CONTACT] - before.times.seconds[STAGE_CONTACT]) / steps,
                               after.max_substeps, census.contacts};
  simulation_destroy(simulation);
  return ok;
}

/* Without and with friction. */
static bool bench_stage(int n, double radius, int size, double stiffness, const struct bench_report *report,
                        struct status *status)
{
  const double spacing = (double)size / n;
  const int steps = report->quick ? 2 : STEPS;
  struct scene scene = scene_crowd(size, size, radius, spacing, fmin(1, spacing / 2 - radius + 0.2));
  struct stage_figures smooth, rough;
  scene.contact.stiffness = stiffness;
  const bool ok = measure_stage(&scene, 0, steps, &smooth, status) && measure_stage(&scene, 0.5, steps, &rough, status);
  if (ok) {
    printf("%6g %7zu %6d %10g %9d %9zu %10.4f %10.4f\n", radius, scene.particles.count, size, stiffness,
           smooth.substeps, smooth.contacts, smooth.ms, rough.ms);
    fflush(stdout);
    if (report->json)
      fprintf(report->json,
              "%s\n    {\"discs\": %zu, \"r\": %g, \"box\": %d, \"stiffness\": %g, \"stage_ms\": %.6g, "
              "\"friction_ms\": %.6g, \"substeps\": %d, \"contacts\": %zu}",
              n == 50 && radius < 3 ? "" : ",", scene.particles.count, radius, size, stiffness, smooth.ms, rough.ms,
              smooth.substeps, smooth.contacts);
  }
  scene_clear(&scene);
  return ok;
}

static bool all_searches(const struct bench_report *report, struct status *status)
{
  static const int edge[] = {10, 15, 20, 30, 40, 50};
  static const double radii[] = {2, 5};
  bool ok = true;
  printf(
      "ms of finding pairs, %d threads: a step's part, and one building of the list; areas of all pairs that touch\n",
      omp_get_max_threads());
  printf("%6s %7s %6s %8s %7s %8s %9s %8s %8s %9s %9s %8s %8s %8s %8s %8s\n", "R", "discs", "box", "", "pairs",
         "shared", "occupat.", "grid", "build", "200x200", "build", "tuned", "build", "cells", "lens", "error");
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
  printf("\nms a step of the contact stage in a run, friction 0 and 0.5\n%6s %7s %6s %10s %9s %9s %10s %10s\n", "R",
         "discs", "box", "stiffness", "sub-steps", "contacts", "smooth", "friction");
  if (report->json) fprintf(report->json, "], \"stages\": [");
  const bool ok = bench_stage(50, 2, 1000, 0.25, report, status) && bench_stage(50, 5, 1000, 0.25, report, status) &&
                  bench_stage(100, 2, 400, 0.25, report, status) && bench_stage(100, 5, 1000, 0.25, report, status) &&
                  bench_stage(100, 5, 1000, 25, report, status);
  if (report->json) fprintf(report->json, "]");
  return ok;
}
