/* The sweep blocked in time, and single precision. */
#include "scenes.h"
#include "sim/blocked.h"
#include "sim/simulation.h"

#include <criterion/criterion.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* An initial flow in all cells, without symmetry. */
static void stir(struct populations *p)
{
  for (int y = 0; y < p->ny; y++)
    for (int x = 0; x < p->nx; x++)
      for (int i = 0; i < Q; i++) {
        const double wave = sin(0.3 * x + 0.7 * i) * cos(0.2 * y - 0.4 * i) + 0.1 * sin(1.7 * x * y);
        populations_set(p, populations_source(p, i, x, y), 0.02 * d2q9_weight[i] * wave);
      }
}

/* `sides`, by bits: periodic in x (1) and y (2), an inlet and an outlet in x (4), outlets in y (8), without flux (16). */
static const int boxes[] = {0, 1, 2, 3, 4, 6, 8, 9, 12, 16, 17, 18};
enum { BOXES = sizeof boxes / sizeof boxes[0] };

static struct scene stirred_box(int nx, int ny, int sides)
{
  struct scene scene = scene_box(nx, ny, 0.02, SIDES_CLOSED);
  if (sides & 1) scene.domain.side[SIDE_LEFT].type = scene.domain.side[SIDE_RIGHT].type = SIDE_PERIODIC;
  if (sides & 2) scene.domain.side[SIDE_BOTTOM].type = scene.domain.side[SIDE_TOP].type = SIDE_PERIODIC;
  if (!(sides & 2)) scene.domain.side[SIDE_TOP].velocity[0] = 0.05;
  if (!(sides & 1)) scene.domain.side[SIDE_LEFT].velocity[1] = -0.03;
  if (sides & 4) scene.domain.side[SIDE_LEFT] = (struct side){SIDE_INLET, {0.04, -0.01}};
  if (sides & 4) scene.domain.side[SIDE_RIGHT].type = SIDE_OUTLET;
  scene.fluid.zero_flux = sides & 16;
  if (sides & 8) scene.domain.side[SIDE_BOTTOM].type = scene.domain.side[SIDE_TOP].type = SIDE_OUTLET;
  return scene;
}

enum { NX = 75, NY = 70, STEPS = 23 };

/* All populations after STEPS steps in blocks of `depth`, the last one shorter. */
static void populations_after(const struct scene *scene, const struct blocking *blocking, int threads, double *all)
{
  struct status status;
  struct flow flow;
  const struct stages stages = stages_of(scene);
  cr_assert(flow_create(&flow, scene, &stages, &status));
  stir(&flow.populations);
  for (int step = 0; step < STEPS;) {
    const int left = (int)zero_flux_steps_left(&flow.zero_flux, STEPS - step);
    const int block = blocking->depth < left ? blocking->depth : left;
#pragma omp parallel num_threads(threads)
    {
      if (blocking->depth == 0)
        stage_sweep(&flow, &(struct rows){0, scene->domain.size[1]}, &(struct sweep_discs){0});
      else
        stage_sweep_blocked(&flow, blocking, block);
    }
    step += blocking->depth == 0 ? 1 : block;
  }
  const int nx = scene->domain.size[0], ny = scene->domain.size[1];
  for (int k = 0; k < nx * ny; k++) populations_cell(&flow.populations, k % nx, k / nx, all + k * Q);
  flow_destroy(&flow);
}

Test(blocked, any_depth_width_and_number_of_threads_gives_the_bits_of_single_steps)
{
  static const int depths[] = {1, 2, 3, 8, 11}, widths[] = {0, 16, 30}, threads[] = {1, 2, 3};
  static double expected[NX * NY * Q], obtained[NX * NY * Q];
  for (int box = 0; box < BOXES; box++)
    for (int way = 0; way < 4; way++) {
      const int sides = boxes[box];
      struct scene scene = stirred_box(NX, NY, sides);
      if (way % 2) scene.fluid.force[0] = 1e-4;
      if (way / 2) scene_use_paper_rates(&scene);
      const struct blocking none = {.depth = 0};
      populations_after(&scene, &none, 1, expected);
      for (size_t d = 0; d < sizeof depths / sizeof depths[0]; d++)
        for (size_t w = 0; w < sizeof widths / sizeof widths[0]; w++)
          for (size_t t = 0; t < sizeof threads / sizeof threads[0]; t++) {
            const struct blocking blocking = {.depth = depths[d], .width = widths[w]};
            if (blocking.depth > blocked_max_depth(NY, threads[t])) continue;
            populations_after(&scene, &blocking, threads[t], obtained);
            cr_expect_eq(memcmp(expected, obtained, sizeof expected), 0,
                         "sides %d, way %d, depth %d, width %d, threads %d", sides, way, depths[d], widths[w],
                         threads[t]);
          }
    }
}

Test(blocked, deeper_than_the_box_is_wide_gives_the_bits_of_single_steps)
{
  static const int sizes[] = {1, 2, 3, 5, 8, 17, 20}, depths[] = {4, 16, 23}, widths[] = {0, 1, 4, 7};
  static double expected[20 * NY * Q], obtained[20 * NY * Q];
  for (size_t n = 0; n < sizeof sizes / sizeof sizes[0]; n++)
    for (int box = 0; box < BOXES; box++) {
      const int sides = boxes[box];
      const struct scene scene = stirred_box(sizes[n], NY, sides);
      const size_t bytes = (size_t)sizes[n] * NY * Q * sizeof(double);
      populations_after(&scene, &(struct blocking){.depth = 0}, 1, expected);
      for (size_t d = 0; d < sizeof depths / sizeof depths[0]; d++)
        for (size_t w = 0; w < sizeof widths / sizeof widths[0]; w++) {
          populations_after(&scene, &(struct blocking){.depth = depths[d], .width = widths[w]}, 1, obtained);
          cr_expect_eq(memcmp(expected, obtained, bytes), 0, "%d cells wide, sides %d, depth %d, width %d", sizes[n],
                       sides, depths[d], widths[w]);
        }
    }
}

/* Velocity after some steps of a lid-driven cavity. */
static void cavity(int depth, enum precision precision, int64_t steps, double *ux)
{
  struct scene scene = scene_box(160, 160, 0.05, SIDES_CLOSED);
  scene.domain.side[SIDE_TOP].velocity[0] = 0.1;
  scene.run.plan.depth = depth;
  scene.fluid.precision = precision;
  struct simulation *simulation;
  struct status status;
  cr_assert(simulation_create(&simulation, &scene, &status), "%s", status.message);
  cr_assert(simulation_advance(simulation, steps, &status), "%s", status.message);
  simulation_fields(simulation, NULL, ux, NULL);
  simulation_destroy(simulation);
}

Test(blocked, a_run_gives_the_same_bits_with_any_plan)
{
  const size_t cells = 160 * 160;
  double *first = malloc(cells * sizeof *first), *other = malloc(cells * sizeof *other);
  cavity(1, PRECISION_DOUBLE, 777, first);
  static const int depths[] = {0, 5, 16, 1000};
  for (int k = 0; k < 4; k++) {
    cavity(depths[k], PRECISION_DOUBLE, 777, other);
    cr_expect_eq(memcmp(first, other, cells * sizeof *first), 0, "plan %d", depths[k]);
  }
  free(first);
  free(other);
}

enum low_box { LOW_CLOSED, LOW_PERIODIC, LOW_WITHOUT_FLUX, LOW_BOXES };

/* Velocity after 100 steps of a low, wide box: few rows for each thread. */
static void low_box(enum low_box kind, int depth, int threads, double *ux)
{
  const bool periodic = kind == LOW_PERIODIC;
  struct scene scene = scene_box(1000, 25, 0.05, SIDES_CLOSED);
  struct simulation *simulation;
  struct status status;
  if (periodic) scene.domain.side[SIDE_BOTTOM].type = scene.domain.side[SIDE_TOP].type = SIDE_PERIODIC;
  scene.domain.side[SIDE_TOP].velocity[0] = periodic ? 0 : 0.1;
  scene.domain.side[SIDE_LEFT].velocity[1] = 0.05;
  scene.fluid.zero_flux = kind == LOW_WITHOUT_FLUX;
  scene.run.plan.depth = depth;
  omp_set_num_threads(threads);
  cr_assert(simulation_create(&simulation, &scene, &status), "%s", status.message);
  cr_assert(simulation_advance(simulation, 100, &status), "%s", status.message);
  simulation_fields(simulation, NULL, ux, NULL);
  simulation_destroy(simulation);
}

Test(blocked, a_plan_deeper_than_the_rows_of_a_thread_allow_gives_the_same_bits)
{
  static double expected[1000 * 25], obtained[1000 * 25];
  for (enum low_box kind = LOW_CLOSED; kind < LOW_BOXES; kind++) {
    low_box(kind, 1, 1, expected);
    for (int threads = 1; threads <= 5; threads += 2) {
      low_box(kind, 40, threads, obtained);
      cr_expect_eq(memcmp(expected, obtained, sizeof expected), 0, "kind %d, %d threads", kind, threads);
      low_box(kind, 0, threads, obtained);
      cr_expect_eq(memcmp(expected, obtained, sizeof expected), 0, "by trial, kind %d, %d threads", kind, threads);
    }
  }
}

Test(single, precision_stays_within_1e_4_of_double_in_a_cavity)
{
  const size_t cells = 160 * 160;
  double *in_double = malloc(cells * sizeof *in_double), *in_single = malloc(cells * sizeof *in_single), largest = 0;
  cavity(0, PRECISION_DOUBLE, 10000, in_double);
  cavity(0, PRECISION_SINGLE, 10000, in_single);
  for (size_t k = 0; k < cells; k++) largest = fmax(largest, fabs(in_double[k] - in_single[k]) / 0.1);
  cr_expect_lt(largest, 1e-4, "differs by %g of the lid's speed", largest);
  free(in_double);
  free(in_single);
}

enum tall_box { TALL_CLOSED, TALL_PERIODIC, TALL_OUTLET, TALL_PERIODIC_OUTLET, TALL_WITHOUT_FLUX, TALL_BOXES };

/* Discs near each other, one of them fast, one fixed, in a tall box. */
static struct scene few_discs(enum tall_box kind)
{
  const bool periodic = kind == TALL_PERIODIC || kind == TALL_PERIODIC_OUTLET;
  const bool outlet = kind == TALL_OUTLET || kind == TALL_PERIODIC_OUTLET;
  struct scene scene = scene_box(40, 210, 0.02, periodic ? SIDES_PERIODIC : SIDES_CLOSED);
  scene.fluid.zero_flux = kind == TALL_WITHOUT_FLUX;
  scene.particles.gravity[1] = -0.01;
  const double low = periodic ? 2 : 90; /* across the periodic side */
  scene_add_disc(&scene, 4.3, 1.5, 12.1, low);
  scene_add_disc(&scene, 2, 3, 20.4, low + 9)->velocity[1] = 0.2;
  scene_add_disc(&scene, 6, 1, 30, low + 20)->motion = DISC_FIXED;
  if (!periodic) scene.domain.side[SIDE_TOP].velocity[0] = 0.05;
  if (outlet) scene.domain.side[SIDE_LEFT] = (struct side){SIDE_INLET, {0.03, 0}};
  if (outlet) scene.domain.side[SIDE_RIGHT].type = SIDE_OUTLET;
  return scene;
}

/* Velocity along x and the discs' places after 200 steps. */
static void run_few_discs(enum tall_box kind, int depth, int threads, double *ux, double places[6])
{
  struct scene scene = few_discs(kind);
  struct simulation *simulation;
  struct status status;
  scene.run.plan.depth = depth;
  omp_set_num_threads(threads);
  cr_assert(simulation_create(&simulation, &scene, &status), "%s", status.message);
  cr_assert(simulation_advance(simulation, 203, &status), "%s", status.message);
  simulation_fields(simulation, NULL, ux, NULL);
  const struct discs *discs = simulation_discs(simulation);
  for (int i = 0; i < 3; i++) places[2 * i] = discs->x[i], places[2 * i + 1] = discs->y[i];
  simulation_destroy(simulation);
  scene_clear(&scene);
}

Test(blocked, rows_that_no_disc_can_reach_go_ahead_and_give_the_same_bits)
{
  enum { CELLS = 40 * 210 };
  static const int depths[] = {0, 2, 7, 20, 1000}, threads[] = {1, 2, 3};
  static double expected[CELLS], obtained[CELLS];
  double places[2][6];
  for (enum tall_box kind = TALL_CLOSED; kind < TALL_BOXES; kind++) {
    run_few_discs(kind, 1, 1, expected, places[0]);
    for (size_t d = 0; d < sizeof depths / sizeof depths[0]; d++)
      for (size_t t = 0; t < sizeof threads / sizeof threads[0]; t++) {
        run_few_discs(kind, depths[d], threads[t], obtained, places[1]);
        cr_expect(!memcmp(expected, obtained, sizeof expected) && !memcmp(places[0], places[1], sizeof places[0]),
                  "kind %d, depth %d, threads %d", kind, depths[d], threads[t]);
      }
  }
}

/* The paper's single disc, before its wake becomes unsteady. */
static void run_single_disc(enum precision precision, double *y, double *vy)
{
  struct scene scene = scene_box(200, 400, 0.05, SIDES_CLOSED);
  scene.fluid.precision = precision;
  scene.fluid.zero_flux = true;
  scene.particles.gravity[1] = -0.024525;
  scene_add_disc(&scene, 10, 1.01, 100.3, 360);
  struct simulation *simulation;
  struct status status;
  cr_assert(simulation_create(&simulation, &scene, &status), "%s", status.message);
  cr_assert(simulation_advance(simulation, 3000, &status), "%s", status.message);
  *y = simulation_discs(simulation)->y[0];
  *vy = simulation_discs(simulation)->vy[0];
  simulation_destroy(simulation);
  scene_clear(&scene);
}

Test(single, precision_stays_within_1e_4_of_double_for_a_settling_disc)
{
  double y[2], vy[2];
  run_single_disc(PRECISION_DOUBLE, &y[0], &vy[0]);
  run_single_disc(PRECISION_SINGLE, &y[1], &vy[1]);
  cr_expect_lt(fabs(y[1] - y[0]) / (360 - y[0]), 1e-4, "fallen %g and %g", 360 - y[0], 360 - y[1]);
  cr_expect_lt(fabs(vy[1] / vy[0] - 1), 1e-4, "falls at %g and %g", vy[0], vy[1]);
}
