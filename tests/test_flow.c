/* Flows with exact solutions: channels, moving walls, ducts, and the drag of a square array of cylinders. */
#include "drive.h"
#include "scenes.h"
#include "sim/simulation.h"
#include "sim/zero_flux.h"

#include <criterion/criterion.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static struct scene channel(int height, double viscosity, bool along_x)
{
  struct scene scene = scene_box(along_x ? 3 : height, along_x ? height : 3, viscosity, SIDES_PERIODIC);
  scene.domain.side[along_x ? SIDE_BOTTOM : SIDE_LEFT].type = SIDE_WALL;
  scene.domain.side[along_x ? SIDE_TOP : SIDE_RIGHT].type = SIDE_WALL;
  return scene;
}

/* Half-way bounce-back shifts a force-driven parabola by (16 Lambda - 3)/12 in (H_eff/2)^2, Lambda = (1/s_nu -
 * 1/2)(1/s_q - 1/2): not at all with the magic parameter 3/16 (Ginzburg & d'Humieres 2003). */
Test(channel, poiseuille_flow_has_the_slip_of_its_magic_parameter_and_no_other_error)
{
  static const double magics[] = {3.0 / 16, 0.05, 0.25};
  const int height = 13;
  for (int along_x = 0; along_x < 2; along_x++)
    for (int m = 0; m < 3; m++) {
      const double viscosity = 0.1, force = 1e-6;
      struct scene scene = channel(height, viscosity, along_x);
      scene.fluid.rates.s_q = rate_from_magic(magics[m], viscosity);
      scene.fluid.force[along_x ? 0 : 1] = force;
      struct simulation *simulation = start(&scene);
      advance(simulation, 20000);
      double u[39];
      simulation_fields(simulation, NULL, along_x ? u : NULL, along_x ? NULL : u);
      for (int k = 0; k < height; k++) {
        const double at = k + 0.5 - height / 2.0, half2 = height * height / 4.0 + (16 * magics[m] - 3) / 12;
        const double expected = force / (2 * viscosity) * (half2 - at * at),
                     obtained = u[along_x ? 3 * k + 1 : k + height];
        cr_expect(fabs(obtained / expected - 1) < 1e-9, "magic %g, cell %d: %.12g, expected %.12g", magics[m], k,
                  obtained, expected);
      }
      simulation_destroy(simulation);
      scene_clear(&scene);
    }
}

Test(channel, couette_flow_is_linear_between_moving_walls)
{
  const int height = 10;
  struct scene scene = channel(height, 0.1, true);
  scene.domain.side[SIDE_BOTTOM].velocity[0] = -0.01;
  scene.domain.side[SIDE_TOP].velocity[0] = 0.03;
  struct simulation *simulation = start(&scene);
  advance(simulation, 10001);
  double u[30];
  simulation_fields(simulation, NULL, u, NULL);
  for (int k = 0; k < height; k++)
    cr_expect_float_eq(u[3 * k + 1], -0.01 + 0.04 * (k + 0.5) / height, 1e-6, "cell %d: %g", k, u[3 * k + 1]);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

enum { WAVE = 32 };

/* A shear wave of speed 0.01, with its gradient. */
static struct flow_state shear_wave(const void *context, int x, int y)
{
  const int along_x = *(const int *)context, axis = along_x ? 0 : 1;
  const double k = 2 * M_PI / WAVE, phase = k * ((along_x ? y : x) + 0.5);
  struct flow_state state = {.density = 1};
  state.velocity[axis] = 0.01 * sin(phase);
  state.gradient[axis][!axis] = 0.01 * k * cos(phase);
  return state;
}

/* Without its initial stress the wave would not decay in the first step. */
Test(wave, of_shear_that_starts_with_its_stress_decays_from_the_first_step)
{
  const double viscosity = 0.1, k = 2 * M_PI / WAVE;
  for (int along_x = 0; along_x < 2; along_x++) {
    struct scene scene = scene_box(along_x ? 3 : WAVE, along_x ? WAVE : 3, viscosity, SIDES_PERIODIC);
    struct simulation *simulation = start(&scene);
    simulation_start(simulation, shear_wave, &along_x);
    for (int step = 1; step <= 4; step++) {
      double u[3 * WAVE], amplitude = 0;
      advance(simulation, 1);
      simulation_fields(simulation, NULL, along_x ? u : NULL, along_x ? NULL : u);
      for (int n = 0; n < WAVE; n++) amplitude += 2.0 / WAVE * sin(k * (n + 0.5)) * u[along_x ? 3 * n + 1 : n + WAVE];
      const double lost = -log(amplitude / 0.01) / step, expected = viscosity * k * k;
      cr_expect(fabs(lost / expected - 1) < 0.03, "along x %d, step %d: loses %g, not %g a step", along_x, step, lost,
                expected);
    }
    simulation_destroy(simulation);
    scene_clear(&scene);
  }
}

static struct flow_state rising(const void *context, int x, int y)
{
  (void)context, (void)x, (void)y;
  return (struct flow_state){.density = 1, .velocity = {0, 1e-4}};
}

/* Momentum of a closed box, per cell, along y. */
static double mean_momentum(struct simulation *simulation, size_t cells)
{
  double *rho = malloc(cells * sizeof *rho), *uy = malloc(cells * sizeof *uy), momentum = 0;
  simulation_fields(simulation, rho, NULL, uy);
  for (size_t k = 0; k < cells; k++) momentum += rho[k] * uy[k] / (double)cells;
  free(rho);
  free(uy);
  return momentum;
}

/* Uniform initial velocity along an axis closed by walls. */
Test(closed_box, loses_its_mean_momentum_within_some_intervals_of_the_force)
{
  enum { NX = 30, NY = 40 };
  struct scene scene = scene_box(NX, NY, 0.05, SIDES_CLOSED);
  scene.fluid.zero_flux = true;
  struct simulation *simulation = start(&scene);
  double largest = 0;
  simulation_start(simulation, rising, NULL);
  advance(simulation, 25 * zero_flux_create(&scene).interval);
  for (int k = 0; k < 20; k++, advance(simulation, 7))
    largest = fmax(largest, fabs(mean_momentum(simulation, NX * NY)));
  cr_expect_lt(largest, 1e-5, "mean momentum %g of 1e-4", largest);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* A body force is pure pressure there, and balanced from the first step on. */
Test(closed_box, without_flux_is_left_at_rest_by_a_body_force)
{
  enum { NX = 30, NY = 40 };
  struct scene scene = scene_box(NX, NY, 0.05, SIDES_CLOSED);
  scene.fluid.zero_flux = true;
  scene.fluid.force[1] = -1e-4;
  struct simulation *simulation = start(&scene);
  for (int k = 0; k < 10; k++) {
    advance(simulation, 13);
    const double momentum = fabs(mean_momentum(simulation, NX * NY));
    cr_expect_lt(momentum, 1e-15, "step %d: %g", 13 * (k + 1), momentum);
  }
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* What is left after 300 intervals of momentum that responds r-fold to the force and gains `rest` a step by other forces. */
static double momentum_left(double r, double rest)
{
  struct scene scene = scene_box(100, 100, 0.05, SIDES_CLOSED);
  scene.fluid.zero_flux = true;
  struct zero_flux z = zero_flux_create(&scene);
  double uniform[2], mean[2] = {0, 1};
  const double load[2] = {0, 0};
  zero_flux_start(&z, load, uniform);
  for (int k = 0; k < 300; k++) {
    mean[1] += z.interval * (r * uniform[1] + rest);
    zero_flux_update(&z, mean, load, uniform);
  }
  scene_clear(&scene);
  return fabs(mean[1]);
}

/* Light discs make it respond up to three times as strongly as fluid alone: the gain is half of the limit. */
Test(closed_box, loses_its_momentum_whatever_it_responds_to_the_force_up_to_six_times_fluid_alone)
{
  static const double responses[] = {0.3, 1, 3, 6};
  for (int k = 0; k < 4; k++) {
    cr_expect_lt(momentum_left(responses[k], 0), 1e-5, "response %g", responses[k]);
    cr_expect_lt(momentum_left(responses[k], 1e-3), 1e-5, "response %g, with a steady force", responses[k]);
  }
}

/* No longer than half of the time of sound across the box, so that walls do not answer before the effect is seen. */
Test(closed_box, the_interval_of_the_force_follows_from_the_scene_alone)
{
  static const int heights[] = {1, 2, 5, 18, 19, 1000}, intervals[] = {1, 1, 4, 15, 16, 16};
  for (int k = 0; k < 6; k++) {
    struct scene scene = scene_box(50, heights[k], 0.05, SIDES_CLOSED);
    scene.fluid.zero_flux = true;
    cr_expect_eq(zero_flux_create(&scene).interval, intervals[k], "%d cells", heights[k]);
    scene.domain.side[SIDE_TOP].type = scene.domain.side[SIDE_BOTTOM].type = SIDE_PERIODIC;
    cr_expect_eq(zero_flux_create(&scene).interval, 16, "%d cells, periodic", heights[k]);
    scene_clear(&scene);
  }
}

/* A load that begins or ends is opposed an interval late: by then it may have accelerated the fluid by 0.01 cells/step. */
Test(closed_box, the_interval_of_the_force_is_short_where_loads_are_heavy)
{
  for (int light = 0; light < 2; light++) {
    struct scene scene = scene_box(100, 100, 0.05, SIDES_CLOSED);
    scene.fluid.zero_flux = true;
    scene.particles.gravity[1] = -0.02;
    scene_add_disc(&scene, 20, light ? 0.2 : 1.8, 50, 50);
    cr_expect_eq(zero_flux_create(&scene).interval, 4);
    scene_clear(&scene);
  }
}

/* Runs until the mean velocity changes by less than 1e-6 over 200 steps; K = F/(mu U). */
static double square_array_drag(const struct scene *scene, double *reported)
{
  const size_t cells = (size_t)scene->domain.size[0] * (size_t)scene->domain.size[1];
  struct simulation *simulation = start(scene);
  double *u = malloc(cells * sizeof *u), before = 0, drag = 1;
  while (fabs(drag - before) > 1e-6 * drag) {
    advance(simulation, 200);
    simulation_fields(simulation, NULL, u, NULL);
    double flux = 0;
    for (size_t k = 0; k < cells; k++) flux += u[k];
    before = drag;
    drag = scene->fluid.force[0] * (double)(cells * cells) / (scene->fluid.viscosity * flux);
  }
  *reported = simulation_discs(simulation)->fx[0] / (scene->fluid.force[0] * (double)cells);
  free(u);
  simulation_destroy(simulation);
  return drag;
}

/* Sangani & Acrivos 1982, Table 1: 51.53 at solid fraction 0.2. */
Test(drag, of_a_square_array_is_right_within_2_5_percent_at_three_viscosities)
{
  static const double viscosities[] = {0.005, 0.05, 1.0 / 6};
  for (int k = 0; k < 3; k++) {
    struct scene scene = scene_square_array(5, 0.2, viscosities[k], 1e-6 * viscosities[k]);
    scene_use_magic(&scene);
    double reported;
    const double drag = square_array_drag(&scene, &reported);
    cr_expect(fabs(drag / 51.53 - 1) < 0.025, "viscosity %g: K = %g", viscosities[k], drag);
    cr_expect_float_eq(reported, 1, 1e-4, "the disc bears the whole body force: %g", reported);
    scene_clear(&scene);
  }
}
