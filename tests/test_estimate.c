/* Estimates of scenes against runs; and the reported cause of a divergence. */
#include "maps.h"
#include "scenes.h"

#include "sim/estimate.h"
#include "sim/simulation.h"

#include <criterion/criterion.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

TestSuite(estimate);
TestSuite(divergence);
TestSuite(maps);

static struct simulation *start(struct scene *scene)
{
  struct simulation *simulation;
  struct status status;
  cr_assert(simulation_create(&simulation, scene, &status), "%s", status.message);
  return simulation;
}

/* The largest speed along x, and its mean over the box, after so many steps. */
static void speeds_of(struct scene *scene, int64_t steps, double *largest, double *mean)
{
  struct simulation *simulation = start(scene);
  struct status status;
  const size_t cells = (size_t)scene_cells(scene);
  double *ux = malloc(cells * sizeof *ux);
  cr_assert(ux && simulation_advance(simulation, steps, &status), "%s", status.message);
  simulation_fields(simulation, NULL, ux, NULL);
  *largest = *mean = 0;
  for (size_t k = 0; k < cells; k++) {
    *largest = fmax(*largest, fabs(ux[k]));
    *mean += ux[k] / (double)cells;
  }
  free(ux);
  simulation_destroy(simulation);
}

static struct scene channel(int height, double viscosity, double force)
{
  struct scene scene = scene_box(8, height, viscosity, SIDES_CLOSED);
  scene.domain.side[SIDE_LEFT].type = scene.domain.side[SIDE_RIGHT].type = SIDE_PERIODIC;
  scene.fluid.force[0] = force;
  return scene;
}

Test(estimate, of_flow_between_walls_is_what_a_run_reaches_late_and_an_upper_bound_before)
{
  struct scene scene = channel(24, 0.2, 1e-5);
  double largest, mean;
  for (int64_t steps = 50; steps <= 6400; steps *= 2) {
    speeds_of(&scene, steps, &largest, &mean);
    const double foreseen = estimate_forced(&scene, 0, steps);
    cr_expect_leq(largest, 1.01 * foreseen, "%lld steps: %g, foreseen %g", (long long)steps, largest, foreseen);
    if (steps == 50 || steps == 6400) cr_expect_float_eq(largest, foreseen, 0.02 * foreseen);
  }
  cr_expect_float_eq(estimate_forced(&scene, 0, 100000), 1e-5 * 24 * 24 / (8 * 0.2), 1e-15);
  scene_clear(&scene);
}

Test(estimate, of_flow_without_walls_is_force_times_time)
{
  struct scene scene = scene_box(16, 16, 0.1, SIDES_PERIODIC);
  double largest, mean;
  scene.fluid.force[0] = -2e-5;
  speeds_of(&scene, 1000, &largest, &mean);
  cr_expect_float_eq(estimate_forced(&scene, 0, 1000), 0.02, 1e-15);
  cr_expect_float_eq(largest, 0.02, 1e-6);
  cr_expect_eq(estimate_forced(&scene, 1, 1000), 0);
  scene_clear(&scene);
}

/* The series for the array's drag is one in the solid fraction: at 0.4 the exact drag (Sangani & Acrivos 1982, table
 * 1: 217.89 in place of 115.7) allows half of the estimated speed. */
Test(estimate, of_flow_past_a_square_array_is_its_mean_speed_and_an_upper_bound_where_it_is_dense)
{
  static const struct {
    double fraction, of_foreseen;
  } arrays[] = {{0.05, 1}, {0.2, 1}, {0.4, 115.7 / 217.89}};
  for (int k = 0; k < 3; k++) {
    struct scene scene = scene_square_array(6, arrays[k].fraction, 0.1, 1e-6);
    double largest, mean;
    speeds_of(&scene, 8000, &largest, &mean);
    const double foreseen = estimate_forced(&scene, 0, 1000000), right = arrays[k].of_foreseen * foreseen;
    cr_expect_float_eq(mean, right, 0.05 * right, "fraction %g: %g, foreseen %g", arrays[k].fraction, mean, foreseen);
    scene_clear(&scene);
  }
}

Test(estimate, is_zero_along_an_axis_that_is_not_periodic)
{
  struct scene scene = scene_box(16, 16, 0.1, SIDES_CLOSED);
  scene.fluid.force[0] = scene.fluid.force[1] = 1e-3;
  cr_expect_eq(estimate_forced(&scene, 0, 1000), 0);
  cr_expect_eq(estimate_forced(&scene, 1, 1000), 0);
  scene_clear(&scene);
}

/* The estimated speed after the advised change of the key. */
static double speed_as_advised(struct scene *scene, const struct estimate *fastest, double *number)
{
  *number = copysign(fastest->advised, *number);
  return estimate_fastest(scene, scene->run.steps).speed;
}

Test(estimate, names_the_number_and_its_value_for_the_advised_speed)
{
  struct scene scene = channel(24, 0.02, 1e-3);
  scene.run.steps = 100000;
  struct estimate fastest = estimate_fastest(&scene, scene.run.steps);
  cr_expect_str_eq(fastest.key, "fluid.force");
  cr_expect_float_eq(speed_as_advised(&scene, &fastest, &scene.fluid.force[0]), scene_advised_speed, 1e-9);
  scene.fluid.force[0] = 0;
  scene_add_disc(&scene, 4, 3, 4, 12);
  scene.particles.gravity[1] = -0.05;
  fastest = estimate_fastest(&scene, scene.run.steps);
  cr_expect_str_eq(fastest.key, "particles.gravity");
  cr_expect_float_eq(speed_as_advised(&scene, &fastest, &scene.particles.gravity[1]), scene_advised_speed, 1e-9);
  scene.particles.gravity[1] = 0;
  scene.particles.discs[0].spin = -0.06;
  fastest = estimate_fastest(&scene, scene.run.steps);
  cr_expect_str_eq(fastest.key, "particles.discs.0.spin");
  cr_expect_float_eq(speed_as_advised(&scene, &fastest, &scene.particles.discs[0].spin), scene_advised_speed, 1e-9);
  scene.domain.side[SIDE_TOP].velocity[0] = 0.25;
  fastest = estimate_fastest(&scene, scene.run.steps);
  cr_expect_str_eq(fastest.key, "domain.top.velocity");
  cr_expect_float_eq(speed_as_advised(&scene, &fastest, &scene.domain.side[SIDE_TOP].velocity[0]), scene_advised_speed,
                     1e-9);
  scene_clear(&scene);
}

/* A channel with an inlet on the left, an outlet on the right, and a fixed disc. */
static struct scene stream(double speed, double viscosity, double at)
{
  struct scene scene = scene_box(120, 60, viscosity, SIDES_CLOSED);
  scene.domain.side[SIDE_LEFT] = (struct side){SIDE_INLET, {speed, 0}};
  scene.domain.side[SIDE_RIGHT].type = SIDE_OUTLET;
  scene_add_disc(&scene, 8, 1, at, 30)->motion = DISC_FIXED;
  return scene;
}

/* Runs the scene, which must diverge within `steps` steps. */
static void diverge(struct scene *scene, int64_t steps, struct status *status, struct simulation_report *report)
{
  struct simulation *simulation = start(scene);
  scene->run.steps = steps;
  cr_assert_not(simulation_advance(simulation, steps, status));
  simulation_report(simulation, report);
  simulation_destroy(simulation);
  scene_clear(scene);
}

static void expect_words(const char *message, const char *words, bool there)
{
  cr_expect_eq(strstr(message, words) != NULL, there, "'%s' %s: %s", words, there ? "expected" : "unexpected", message);
}

Test(divergence, of_an_inlet_switched_on_at_high_speed_names_the_start_and_no_outlet)
{
  struct scene scene = stream(0.28, 0.005, 40);
  struct simulation_report report;
  struct status status;
  diverge(&scene, 700, &status, &report);
  expect_words(status.message, "the inlet on the left sets fluid at rest in motion at once at Mach 0.48", true);
  expect_words(status.message, "a lower domain.left.velocity (<= 0.1 cells/step), or a larger fluid.viscosity", true);
  expect_words(status.message, "outlet", false);
  expect_words(status.message, "more enters than leaves", false);
}

Test(divergence, of_fluid_that_a_force_drives_too_fast_names_the_force)
{
  struct scene scene = channel(24, 0.02, 1e-3);
  struct simulation_report report;
  struct status status;
  diverge(&scene, 5000, &status, &report);
  expect_words(status.message,
               "fluid.force leads to speeds of about 3.6 cells/step (Mach 6.2); better: fluid.force <= "
               "2.8e-05 cells/step^2",
               true);
  expect_words(status.message, "inlet", false);
}

Test(divergence, of_cells_too_coarse_for_the_flow_names_the_grid_reynolds_number)
{
  struct scene scene = scene_box(64, 64, 0.0004, SIDES_CLOSED);
  struct simulation_report report;
  struct status status;
  scene.fluid.collision = COLLISION_BGK;
  scene.fluid.rates.s_e = scene.fluid.rates.s_q = scene.fluid.rates.s_nu;
  scene.fluid.rates.s_q_fast = 0;
  scene.domain.side[SIDE_TOP].velocity[0] = 0.1;
  diverge(&scene, 20000, &status, &report);
  expect_words(status.message, "the grid Reynolds number (of one cell) is 250, above 10", true);
  expect_words(status.message, "better: fluid.viscosity >= 0.01", true);
  expect_words(status.message, "leads to speeds", false);
}

Test(divergence, of_light_discs_in_the_explicit_solve_names_the_solve)
{
  struct scene scene = scene_box(64, 64, 0.05, SIDES_CLOSED);
  struct simulation_report report;
  struct status status;
  scene.coupling.solve = SOLVE_EXPLICIT_AVERAGED;
  scene_add_disc(&scene, 8, 0.3, 32, 32);
  scene.particles.gravity[1] = -1e-3;
  diverge(&scene, 5000, &status, &report);
  expect_words(status.message, "explicit-averaged diverges for light discs (disc 0: density 0.3), implicit does not",
               true);
  expect_words(status.message, "speeds", false);
}

Test(divergence, of_discs_too_heavy_for_the_fluid_names_gravity)
{
  struct scene scene = scene_box(40, 80, 0.02, SIDES_CLOSED);
  struct simulation_report report;
  struct status status;
  for (int k = 0; k < 8; k++) scene_add_disc(&scene, 8, 4, k % 2 ? 10 : 30, 12 + 17 * (double)(k / 2));
  scene.particles.gravity[1] = -0.02;
  cr_expect_float_eq(estimate_load(&scene, 1), 8 * M_PI * 64 * 3 * 0.02 / 40 * 3, 1e-12);
  cr_expect_eq(estimate_load(&scene, 0), 0);
  diverge(&scene, 20000, &status, &report);
  expect_words(status.message, "the discs weigh 724 % of the fluid's pressure", true);
}

/* For divergence by speed and by a cell that is not finite. */
Test(divergence, leaves_the_largest_mach_number_that_the_fluid_had_in_the_report)
{
  struct scene scene = channel(24, 0.02, 1e-3);
  struct simulation_report report;
  struct status status;
  scene.run.check = 100;
  diverge(&scene, 5000, &status, &report);
  double told = 0;
  const char *at = strstr(status.message, "at Mach ");
  cr_assert(at && sscanf(at, "at Mach %lf", &told) == 1, "%s", status.message);
  cr_expect_gt(report.max_mach, 0.6);
  cr_expect_float_eq(report.max_mach, told, 0.005 * told);
}

static const char *const viscosity_rows[] = {"0.0001", "0.0003", "0.001", "0.002", "0.005", "0.01", "0.03", "0.1"};
static const char *const operators[] = {"bgk", "trt 3/16", "mrt 1.4 1.2", "mrt s_nu 1.2", "adaptive"};
static const double viscosities[] = {1e-4, 3e-4, 1e-3, 2e-3, 5e-3, 1e-2, 3e-2, 1e-1};

/* Up to Mach 0.2, the third column. */
Test(maps, of_the_shear_layer_complete_up_to_mach_0_2_from_the_least_relaxation_time_on)
{
  char *report = maps_read();
  for (size_t v = 0; v < 8; v++) {
    int failed = 0;
    for (size_t k = 0; k < 5; k++) {
      char map[64];
      snprintf(map, sizeof map, "shear layer, %s", operators[k]);
      for (int mach = 0; mach < 3; mach++) failed += maps_verdict(report, map, viscosity_rows[v], mach) != 'c';
    }
    const bool warned = 0.5 + 3 * viscosities[v] < estimate_min_tau - 1e-9;
    cr_expect_eq(failed > 0, warned, "viscosity %g", viscosities[v]);
  }
  free(report);
}

Test(maps, of_the_shear_layer_diverge_with_the_magic_rate_beside_s_e_of_1_4_wherever_any_does)
{
  char *report = maps_read();
  for (size_t v = 0; v < 8; v++)
    for (int mach = 0; mach < 5; mach++)
      for (size_t k = 0; k < 5; k++) {
        char map[64];
        snprintf(map, sizeof map, "shear layer, %s", operators[k]);
        cr_expect(maps_verdict(report, "shear layer, mrt 1.4 magic 3/16", viscosity_rows[v], mach) == 'd' ||
                      maps_verdict(report, map, viscosity_rows[v], mach) != 'd',
                  "%s at %g, column %d", operators[k], viscosities[v], mach);
      }
  free(report);
}

Test(maps, of_density_diverge_where_the_explicit_solve_is_foreseen_to)
{
  static const double densities[] = {0.01, 0.03, 0.1, 0.3, 0.5, 0.8, 0.99, 1.01, 1.2, 2, 5, 10, 100, 1000};
  static const char *const forms[] = {"unified", "owen", "midpoint"};
  char *report = maps_read();
  for (int k = 0; k < 6; k++)
    for (int c = 0; c < 14; c++) {
      char row[32];
      struct scene scene = scene_box(48, 72, 0.1, SIDES_PERIODIC);
      scene.coupling.solve = k < 3 ? SOLVE_IMPLICIT : SOLVE_EXPLICIT_AVERAGED;
      scene_add_disc(&scene, 5, densities[c], 24, 36);
      snprintf(row, sizeof row, "%s %s", forms[k % 3], k < 3 ? "implicit" : "averaged");
      cr_expect_eq(maps_verdict(report, "density of a settling disc", row, c) == 'd',
                   estimate_lightest_explicit(&scene) == 0, "%s, density %g", row, densities[c]);
      scene_clear(&scene);
    }
  free(report);
}

/* At the stiffness that the paper's crowd has. */
Test(maps, of_a_packing_fail_where_its_weight_is_foreseen_to_be_too_much)
{
  static const double weights[] = {1, 3, 10, 30, 100};
  char *report = maps_read();
  for (int c = 0; c < 5; c++) {
    struct scene scene = scene_crowd(80, 80, 5, 11, 0.2);
    for (size_t i = 0; i < scene.particles.count; i++) scene.particles.discs[i].density = 1 + 0.01 * weights[c];
    cr_expect_eq(maps_verdict(report, "packing pressed by its weight", "0.25", c) != 'c',
                 estimate_load(&scene, 1) > estimate_max_load, "weight %g", weights[c]);
    scene_clear(&scene);
  }
  free(report);
}
