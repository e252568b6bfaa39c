/* Overhead of a run of fluid alone over the bare sweep: the same box, closed and with a moving lid, stepped by the
 * stage and by a simulation, which adds checks for divergence and the clock. Both must end with the same bits. */
#include "base/clock.h"
#include "base/memory.h"
#include "bench.h"
#include "scenes.h"
#include "sim/blocked.h"
#include "sim/simulation.h"

#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { REPEATS = 9 };

static double time_bare(struct flow *flow, int steps, int depth)
{
  const struct rows all = {0, flow->populations.ny};
  const struct blocking blocking = {.depth = depth};
  const double start = clock_now();
#pragma omp parallel
  for (int k = 0; k < steps; k += depth) {
    if (depth == 1)
      stage_sweep(flow, &all, &(struct sweep_discs){0});
    else
      stage_sweep_blocked(flow, &blocking, depth);
  }
  return 1e3 * (clock_now() - start) / steps;
}

static bool time_run(struct simulation *simulation, int steps, double *ms, struct status *status)
{
  const double start = clock_now();
  const bool ok = simulation_advance(simulation, steps, status);
  *ms = 1e3 * (clock_now() - start) / steps;
  return ok;
}

/* Compares the bits after an equal number of steps by the stage and by the simulation. */
static bool verify(struct flow *flow, struct simulation *simulation, struct status *status)
{
  const size_t cells = (size_t)scene_cells(flow->scene);
  const struct fluid_force none = flow_force(flow);
  double *u = memory_allocate(4 * cells, sizeof *u, "the velocity", status);
  if (!u) return false;
  diagnostics_fields(&flow->populations, &none, NULL, u, u + cells);
  simulation_fields(simulation, NULL, u + 2 * cells, u + 3 * cells);
  const bool same = memcmp(u, u + 2 * cells, 2 * cells * sizeof *u) == 0;
  free(u);
  return same || status_fail(status, DELBM_FAILED, "bench run: %d columns: a run's flow is not that of the bare sweep",
                             flow->populations.nx);
}

static bool bench_depth(int size, int depth, const struct bench_report *report, bool first, struct status *status)
{
  struct scene scene = scene_box(size, size, 0.05, SIDES_CLOSED);
  scene.domain.side[SIDE_TOP].velocity[0] = 0.05;
  scene.run.plan.depth = depth;
  scene.run.check = 100;
  const struct stages stages = stages_of(&scene);
  const int steps = report->quick ? 2 * depth : 10 * (int)fmax(1, 2e7 / ((double)size * size * depth)) * depth;
  struct simulation *simulation = NULL;
  struct flow flow = {0};
  double bare[REPEATS], run[REPEATS];
  bool ok = flow_create(&flow, &scene, &stages, status) && simulation_create(&simulation, &scene, status);
  for (int r = -1; ok && r < REPEATS; r++) {
    bare[r < 0 ? 0 : r] = time_bare(&flow, steps, depth);
    ok = time_run(simulation, steps, &run[r < 0 ? 0 : r], status);
  }
  ok = ok && verify(&flow, simulation, status);
  if (ok) {
    const double bare_ms = gsl_stats_median(bare, 1, REPEATS), run_ms = gsl_stats_median(run, 1, REPEATS);
    printf("%6d %6d %4d %9.4f %9.4f %7.3f\n", size, depth, omp_get_max_threads(), bare_ms, run_ms, run_ms / bare_ms);
    fflush(stdout);
    if (report->json)
      fprintf(report->json, "%s\"%d, depth %d\": {\"bare_ms\": %.6g, \"run_ms\": %.6g}", first ? "" : ", ", size, depth,
              bare_ms, run_ms);
  }
  simulation_destroy(simulation);
  flow_destroy(&flow);
  return ok;
}

bool bench_run_alone(const struct bench_report *report, struct status *status)
{
  const int size = report->quick ? 128 : 1024, large = report->quick ? 256 : 4096;
  printf("ms a step of fluid alone: the bare sweep, a run\n");
  printf("%6s %6s %4s %9s %9s %7s\n", "size", "depth", "thr", "bare", "run", "ratio");
  return bench_depth(size, 1, report, true, status) && bench_depth(size, 16, report, false, status) &&
         bench_depth(large, 1, report, false, status);
}
