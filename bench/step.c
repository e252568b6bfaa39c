/* Times of a step with discs, stage by stage, and of the same box without discs: 2500 settling discs of R = 5 in
 * 1000 x 1000 (the paper's Fig. 12) and 100,000 discs in 6400 x 6400, double precision. Up to 1000 x 1000 the result
 * is verified with the baseline kernel. */
#include "base/clock.h"
#include "bench.h"
#include "scenes.h"
#include "sim/simulation.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>

enum { REPEATS = 5 };

/* Times of one series of steps. */
struct stretch {
  double step; /* ms */
  struct stage_times stages;
};

static bool run_stretch(struct simulation *simulation, int steps, struct stretch *stretch, struct status *status)
{
  struct simulation_report before, after;
  simulation_report(simulation, &before);
  const double start = clock_now();
  if (!simulation_advance(simulation, steps, status)) return false;
  stretch->step = 1e3 * (clock_now() - start) / steps;
  simulation_report(simulation, &after);
  for (int k = 0; k < STAGE_COUNT; k++)
    stretch->stages.seconds[k] = 1e3 * (after.times.seconds[k] - before.times.seconds[k]) / steps;
  return true;
}

static int compare_stretches(const void *a, const void *b)
{
  const struct stretch *l = a, *r = b;
  return (l->step > r->step) - (l->step < r->step);
}

/* Runs both scenes in turn; returns the series of median time of each. */
static bool measure(struct simulation *simulations[2], int steps, struct stretch medians[2], struct status *status)
{
  struct stretch samples[2][REPEATS];
  for (int r = -1; r < REPEATS; r++)
    for (int k = 0; k < 2; k++)
      if (!run_stretch(simulations[k], steps, &samples[k][r < 0 ? 0 : r], status)) return false;
  for (int k = 0; k < 2; k++) {
    qsort(samples[k], REPEATS, sizeof samples[k][0], compare_stretches);
    medians[k] = samples[k][REPEATS / 2];
  }
  return true;
}

/* After a timed run: mass is conserved, all discs are in the box, and their mean height has fallen. */
static bool verify_state(struct simulation *simulation, struct status *status)
{
  const struct discs *d = simulation_discs(simulation);
  const int *size = simulation_scene(simulation)->domain.size;
  struct simulation_report report;
  double fall = 0;
  simulation_report(simulation, &report);
  if (!(report.mass_drift < 1e-12))
    return status_fail(status, DELBM_FAILED, "bench step: mass drifts by %g", report.mass_drift);
  for (size_t i = 0; i < d->count; i++) {
    fall -= d->vy[i];
    if (!(d->x[i] > 0 && d->x[i] < size[0] && d->y[i] > 0 && d->y[i] < size[1]))
      return status_fail(status, DELBM_FAILED, "bench step: disc %zu at %g, %g is outside of the box", i, d->x[i],
                         d->y[i]);
  }
  return d->count == 0 || fall > 0 || status_fail(status, DELBM_FAILED, "bench step: discs do not settle");
}

/* The same steps with the baseline kernel on one thread lead to the same positions within round-off. */
static bool verify_places(const struct simulation *timed, struct status *status)
{
  struct scene scene = *simulation_scene(timed);
  struct simulation *plain = NULL;
  const int threads = omp_get_max_threads();
  double largest = 0;
  scene.fluid.kernel = (char *)"baseline-double";
  omp_set_num_threads(1);
  const bool ok =
      simulation_create(&plain, &scene, status) && simulation_advance(plain, simulation_step(timed), status);
  omp_set_num_threads(threads);
  for (size_t i = 0; ok && i < scene.particles.count; i++) {
    const struct discs *a = simulation_discs(timed), *b = simulation_discs(plain);
    largest = fmax(largest, fmax(fabs(a->x[i] - b->x[i]), fabs(a->y[i] - b->y[i])));
  }
  simulation_destroy(plain);
  return ok &&
         (largest < 1e-9 || status_fail(status, DELBM_FAILED,
                                        "bench step: discs are up to %g off where the plain kernel has them", largest));
}

static bool verify(struct simulation *simulations[2], bool places, struct status *status)
{
  return verify_state(simulations[0], status) && verify_state(simulations[1], status) &&
         (!places || verify_places(simulations[0], status));
}

static bool bench_crowd(int size, int threads, int steps, const struct bench_report *report, bool first,
                        struct status *status)
{
  struct scene crowd = scene_crowd(size, size, 5, 20, 1),
               bare = scene_box(size, size, crowd.fluid.viscosity, SIDES_CLOSED);
  bare.run.plan.depth = 1;
  struct simulation *simulations[2] = {NULL, NULL};
  struct stretch medians[2];
  omp_set_num_threads(threads);
  bool ok = simulation_create(&simulations[0], &crowd, status) && simulation_create(&simulations[1], &bare, status) &&
            measure(simulations, steps, medians, status) && verify(simulations, size <= 1000, status);
  if (ok) {
    const double *ms = medians[0].stages.seconds, discs = medians[0].step;
    printf("%6d %7zu %4d %8.3f %8.3f %6.2f %9.3f %8.3f %9.3f %9.3f %8.3f\n", size, crowd.particles.count, threads,
           discs, medians[1].step, discs / medians[1].step, ms[STAGE_OCCUPATION], ms[STAGE_CONTACT], ms[STAGE_EXCHANGE],
           ms[STAGE_BOUNDARY], ms[STAGE_SWEEP]);
    fflush(stdout);
    if (report->json)
      fprintf(report->json,
              "%s\"%d, %d threads\": {\"step_ms\": %.6g, \"bare_ms\": %.6g, \"occupation\": %.6g, \"contact\": %.6g, "
              "\"exchange\": %.6g, \"boundary\": %.6g, \"sweep\": %.6g}",
              first ? "" : ", ", size, threads, discs, medians[1].step, ms[STAGE_OCCUPATION], ms[STAGE_CONTACT],
              ms[STAGE_EXCHANGE], ms[STAGE_BOUNDARY], ms[STAGE_SWEEP]);
  }
  simulation_destroy(simulations[0]);
  simulation_destroy(simulations[1]);
  scene_clear(&crowd);
  scene_clear(&bare);
  return ok;
}

bool bench_step(const struct bench_report *report, struct status *status)
{
  const int all = omp_get_max_threads();
  bool ok = true;
  printf("ms a step with discs of R = 5 at solid fraction 0.196, and without\n");
  printf("%6s %7s %4s %8s %8s %6s %9s %8s %9s %9s %8s\n", "size", "discs", "thr", "step", "bare", "ratio", "occupat.",
         "contact", "exchange", "boundary", "sweep");
  for (int threads = 1; ok && threads <= all; threads = threads < all && 2 * threads > all ? all : 2 * threads)
    ok = bench_crowd(report->quick ? 400 : 1000, threads, report->quick ? 4 : 60, report, threads == 1, status);
  if (ok) ok = bench_crowd(report->quick ? 600 : 6400, all, report->quick ? 2 : 4, report, false, status);
  omp_set_num_threads(all);
  return ok;
}
