/* The sides of the box: inlets, outlets, corners. */
#include "drive.h"
#include "scenes.h"

#include <criterion/criterion.h>
#include <math.h>
#include <stdlib.h>

static double excess_mass(struct simulation *simulation)
{
  const int *size = simulation_scene(simulation)->domain.size;
  const size_t cells = (size_t)size[0] * (size_t)size[1];
  double *rho = malloc(cells * sizeof *rho), sum = 0;
  simulation_fields(simulation, rho, NULL, NULL);
  for (size_t k = 0; k < cells; k++) sum += rho[k] - 1;
  free(rho);
  return sum;
}

/* No fluid leaves these boxes: the mass gained is the inflow. */
Test(inlet, lets_in_its_velocity_times_its_length_to_round_off)
{
  enum { NX = 30, NY = 21, STEPS = 11 };
  static const double slant[] = {0, 0.013, -0.008};
  for (int k = 0; k < 3; k++)
    for (int corner = 0; corner < 2; corner++) {
      struct scene scene = scene_box(NX, NY, 0.05, SIDES_CLOSED);
      scene.domain.side[SIDE_LEFT] = (struct side){SIDE_INLET, {0.02, slant[k]}};
      if (corner) scene.domain.side[SIDE_TOP] = (struct side){SIDE_INLET, {slant[k], -0.03}};
      scene.domain.side[SIDE_BOTTOM].velocity[0] = 0.04;
      struct simulation *simulation = start(&scene);
      advance(simulation, STEPS);
      const double expected = STEPS * (0.02 * NY + (corner ? 0.03 * NX : 0)), entered = excess_mass(simulation);
      cr_expect(fabs(entered / expected - 1) < 1e-13, "slant %g, inlets %d: %.17g of %.17g", slant[k], 1 + corner,
                entered, expected);
      simulation_destroy(simulation);
      scene_clear(&scene);
    }
}

Test(walls, that_run_into_a_corner_push_no_fluid_through_it)
{
  struct scene scene = scene_box(31, 24, 0.05, SIDES_CLOSED);
  scene.domain.side[SIDE_TOP].velocity[0] = 0.1;
  scene.domain.side[SIDE_RIGHT].velocity[1] = 0.07;
  struct simulation *simulation = start(&scene);
  advance(simulation, 301);
  cr_expect_lt(fabs(excess_mass(simulation)), 1e-11);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

static struct flow_state stream(const void *velocity, int x, int y)
{
  const double *v = velocity;
  (void)x, (void)y;
  return (struct flow_state){.density = 1, .velocity = {v[0], v[1]}};
}

Test(corners, keep_a_uniform_stream_uniform_to_round_off)
{
  enum { NX = 27, NY = 22 };
  static const struct {
    double velocity[2];
    struct side side[SIDE_COUNT]; /* left, right, bottom, top */
  } streams[] = {
      {{0.05, 0}, {{SIDE_INLET, {0.05, 0}}, {SIDE_OUTLET, {0}}, {SIDE_WALL, {0.05, 0}}, {SIDE_WALL, {0.05, 0}}}},
      {{-0.05, 0}, {{SIDE_OUTLET, {0}}, {SIDE_INLET, {-0.05, 0}}, {SIDE_WALL, {-0.05, 0}}, {SIDE_WALL, {-0.05, 0}}}},
      {{0, 0.05}, {{SIDE_WALL, {0, 0.05}}, {SIDE_WALL, {0, 0.05}}, {SIDE_INLET, {0, 0.05}}, {SIDE_OUTLET, {0}}}},
      {{0.05, 0}, {{SIDE_INLET, {0.05, 0}}, {SIDE_OUTLET, {0}}, {SIDE_OUTLET, {0}}, {SIDE_WALL, {0.05, 0}}}},
      {{0.04, 0.02}, {{SIDE_INLET, {0.04, 0.02}}, {SIDE_OUTLET, {0}}, {SIDE_INLET, {0.04, 0.02}}, {SIDE_OUTLET, {0}}}},
      {{0.05, 0}, {{SIDE_INLET, {0.05, 0}}, {SIDE_OUTLET, {0}}, {SIDE_SLIP, {0}}, {SIDE_SLIP, {0}}}},
      {{0, -0.05}, {{SIDE_SLIP, {0}}, {SIDE_WALL, {0, -0.05}}, {SIDE_OUTLET, {0}}, {SIDE_INLET, {0, -0.05}}}},
      {{-0.05, 0}, {{SIDE_OUTLET, {0}}, {SIDE_INLET, {-0.05, 0}}, {SIDE_OUTLET, {0}}, {SIDE_SLIP, {0}}}},
      {{0.05, 0}, {{SIDE_PERIODIC, {0}}, {SIDE_PERIODIC, {0}}, {SIDE_SLIP, {0}}, {SIDE_SLIP, {0}}}},
      {{0, 0.05}, {{SIDE_SLIP, {0}}, {SIDE_SLIP, {0}}, {SIDE_PERIODIC, {0}}, {SIDE_PERIODIC, {0}}}},
      {{0.04, 0.02}, {{SIDE_INLET, {0.04, 0.02}}, {SIDE_OUTLET, {0}}, {SIDE_OUTLET, {0}}, {SIDE_OUTLET, {0}}}},
  };
  double ux[NX * NY], uy[NX * NY], rho[NX * NY];
  for (size_t s = 0; s < sizeof streams / sizeof streams[0]; s++) {
    struct scene scene = scene_box(NX, NY, 0.05, SIDES_CLOSED);
    for (int k = 0; k < SIDE_COUNT; k++) scene.domain.side[k] = streams[s].side[k];
    struct simulation *simulation = start(&scene);
    simulation_start(simulation, stream, streams[s].velocity);
    for (int odd = 0; odd < 2; odd++) {
      advance(simulation, odd ? 1 : 200);
      double largest = 0;
      simulation_fields(simulation, rho, ux, uy);
      for (int k = 0; k < NX * NY; k++) {
        largest = fmax(largest, fabs(rho[k] - 1));
        largest = fmax(largest, fabs(ux[k] - streams[s].velocity[0]));
        largest = fmax(largest, fabs(uy[k] - streams[s].velocity[1]));
      }
      cr_expect_lt(largest, 1e-13, "stream %zu, %s number of steps: differs by %g", s, odd ? "odd" : "even", largest);
    }
    simulation_destroy(simulation);
    scene_clear(&scene);
  }
}

/* Driven by a body force, from rest: the flow between a wall and a slip side, and that between two walls twice as far apart. */
Test(slip, makes_a_channel_half_of_one_of_twice_the_height)
{
  enum { NX = 5, NY = 12 };
  struct scene half = scene_box(NX, NY, 0.07, SIDES_PERIODIC), whole = scene_box(NX, 2 * NY, 0.07, SIDES_PERIODIC);
  half.domain.side[SIDE_BOTTOM].type = whole.domain.side[SIDE_BOTTOM].type = whole.domain.side[SIDE_TOP].type =
      SIDE_WALL;
  half.domain.side[SIDE_TOP].type = SIDE_SLIP;
  half.fluid.force[0] = whole.fluid.force[0] = 1e-5;
  struct simulation *a = start(&half), *b = start(&whole);
  double of_half[NX * NY], of_whole[NX * 2 * NY];
  for (int part = 0; part < 3; part++) {
    advance(a, 333), advance(b, 333);
    simulation_fields(a, NULL, of_half, NULL);
    simulation_fields(b, NULL, of_whole, NULL);
    cr_expect_gt(of_half[NX * NY - 1], 1e-3 * (1 + part));
    for (int k = 0; k < NX * NY; k++)
      cr_expect(fabs(of_half[k] - of_whole[k]) < 1e-12, "cell %d: %g, not %g", k, of_half[k], of_whole[k]);
  }
  simulation_destroy(a), simulation_destroy(b);
  scene_clear(&half), scene_clear(&whole);
}

Test(slip, lets_no_fluid_through)
{
  struct scene scene = scene_box(31, 24, 0.05, SIDES_CLOSED);
  scene.domain.side[SIDE_LEFT].type = scene.domain.side[SIDE_BOTTOM].type = SIDE_SLIP;
  scene.domain.side[SIDE_TOP].velocity[0] = 0.1;
  struct simulation *simulation = start(&scene);
  advance(simulation, 301);
  cr_expect_lt(fabs(excess_mass(simulation)), 1e-11);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* In the first step from rest fluid plays no part yet; later the wall, at which fluid sticks, lets it out of the gap more slowly. */
Test(slip, pushes_discs_back_as_a_wall_does)
{
  double force[2], x[2];
  for (int slip = 0; slip < 2; slip++) {
    struct scene scene = scene_box(60, 60, 0.05, SIDES_CLOSED);
    scene_add_disc(&scene, 6, 5, 54.3, 30);
    if (slip) scene.domain.side[SIDE_RIGHT].type = SIDE_SLIP;
    struct simulation *simulation = start(&scene);
    advance(simulation, 1);
    force[slip] = simulation_discs(simulation)->contact_fx[0];
    advance(simulation, 300);
    x[slip] = simulation_discs(simulation)->x[0];
    simulation_destroy(simulation);
    scene_clear(&scene);
  }
  cr_expect(force[0] < 0 && fabs(force[1] / force[0] - 1) < 1e-12, "%g, %g", force[0], force[1]);
  cr_expect(x[0] < 54.2 && x[1] < 54.2, "%g, %g", x[0], x[1]);
}

Test(duct, what_enters_at_the_inlet_leaves_through_the_outlet)
{
  const int nx = 120, ny = 24;
  struct scene scene = scene_box(nx, ny, 0.1, SIDES_CLOSED);
  scene.domain.side[SIDE_LEFT] = (struct side){SIDE_INLET, {0.02, 0}};
  scene.domain.side[SIDE_RIGHT].type = SIDE_OUTLET;
  scene_use_magic(&scene);
  struct simulation *simulation = start(&scene);
  advance(simulation, 30000);
  double *rho = malloc(sizeof(double) * nx * ny), *u = malloc(sizeof(double) * nx * ny);
  simulation_fields(simulation, rho, u, NULL);
  for (int x = 5; x < nx; x += 6) {
    double flux = 0;
    for (int y = 0; y < ny; y++) flux += rho[y * nx + x] * u[y * nx + x];
    const double expected = 0.02 * ny;
    cr_expect(fabs(flux / expected - 1) < 1e-6, "mass flux at %d: %.9g of %.9g", x, flux, expected);
  }
  /* far from the inlet, a parabola of this flux */
  for (int y = 0; y < ny; y++) {
    const double at = (y + 0.5) / ny, expected = 6 * at * (1 - at);
    double flux = 0;
    for (int k = 0; k < ny; k++) flux += u[k * nx + nx - 10];
    const double obtained = u[y * nx + nx - 10] / (flux / ny);
    cr_expect(fabs(obtained - expected) < 0.02, "y %d: %g, expected %g", y, obtained, expected);
  }
  free(rho);
  free(u);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* The inlet starts a wave that runs to the outlet; both ends reflect it. After four round trips the velocity is
 * uniform only if the outlet absorbs most of the wave. */
Test(outlet, lets_out_the_sound_of_an_inlet_that_starts_at_once)
{
  const int nx = 400, ny = 3;
  struct scene scene = scene_box(nx, ny, 0.01, SIDES_PERIODIC);
  scene.domain.side[SIDE_LEFT] = (struct side){SIDE_INLET, {0.02, 0}};
  scene.domain.side[SIDE_RIGHT].type = SIDE_OUTLET;
  struct simulation *simulation = start(&scene);
  advance(simulation, (int64_t)(8 * nx * sqrt(3)));
  double *rho = malloc(sizeof(double) * nx * ny), *u = malloc(sizeof(double) * nx * ny);
  simulation_fields(simulation, rho, u, NULL);
  for (int x = 0; x < nx; x += 10) cr_expect(fabs(u[nx + x] / 0.02 - 1) < 0.02, "velocity at %d: %g", x, u[nx + x]);
  for (int x = 0; x < nx; x += 10) cr_expect(fabs(rho[nx + x] - 1) < 0.002, "density at %d: %g", x, rho[nx + x]);
  free(rho);
  free(u);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* Mean density at the face of the outlet and pressure drop, as a density, after `steps` steps in a channel of
 * resting walls. */
static void channel(int length, int height, double speed, double viscosity, int64_t steps, double *face, double *drop)
{
  struct scene scene = scene_box(length, height, viscosity, SIDES_CLOSED);
  scene.domain.side[SIDE_LEFT] = (struct side){SIDE_INLET, {speed, 0}};
  scene.domain.side[SIDE_RIGHT].type = SIDE_OUTLET;
  struct simulation *simulation = start(&scene);
  double *rho = malloc(sizeof(double) * (size_t)(length * height)),
         *u = malloc(sizeof(double) * (size_t)(length * height));
  advance(simulation, steps);
  simulation_fields(simulation, rho, u, NULL);
  double mean[3] = {0}, flux = 0;
  for (int y = 0; y < height; y++) {
    mean[0] += rho[y * length] / height;
    mean[1] += rho[y * length + length - 2] / height;
    mean[2] += rho[y * length + length - 1] / height;
    flux += rho[y * length + length - 1] * u[y * length + length - 1];
  }
  *face = mean[2] + (mean[2] - mean[1]) / 2;
  *drop = mean[0] - *face;
  cr_expect(fabs(flux / (speed * height) - 1) < 1e-3, "%d x %d: flux out %g of %g", length, height, flux,
            speed * height);
  free(rho);
  free(u);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

Test(outlet, has_the_reference_density_within_1_percent_of_the_pressure_drop_of_channels)
{
  static const int aspects[] = {5, 10, 20};
  static const double reynolds[] = {4, 20, 100};
  enum { HEIGHT = 10 };
  for (int a = 0; a < 3; a++)
    for (int r = 0; r < 3; r++) {
      const double speed = reynolds[r] < 10 ? 0.02 : 0.05, viscosity = speed * HEIGHT / reynolds[r];
      const int length = aspects[a] * HEIGHT;
      double face, drop;
      channel(length, HEIGHT, speed, viscosity, 200 * length, &face, &drop);
      cr_expect(fabs(face - 1) < 0.01 * drop, "L/H %d, Re %g: density %.6f, pressure drop %g", aspects[a], reynolds[r],
                face, drop);
    }
}

static struct flow_state pulse(const void *middle, int x, int y)
{
  const double at = (x - *(const double *)middle) / 12, rise = 1e-4 * exp(-at * at);
  (void)y;
  return (struct flow_state){.density = 1 + rise, .velocity = {rise / sqrt(3), 0}};
}

/* A weak pulse that runs to the outlet through fluid at rest. A pulse short against the box is reflected by the zero
 * gradient alone: by 2 - sqrt(3) = 0.268 if long against a cell, and less otherwise. */
Test(outlet, reflects_less_than_27_percent_of_a_short_pulse_of_sound)
{
  enum { NX = 500, NY = 4 };
  const double middle = 350;
  double rho[NX * NY], largest = 0;
  struct scene scene = scene_box(NX, NY, 0.01, SIDES_PERIODIC);
  scene.domain.side[SIDE_LEFT].type = SIDE_WALL;
  scene.domain.side[SIDE_RIGHT].type = SIDE_OUTLET;
  struct simulation *simulation = start(&scene);
  simulation_start(simulation, pulse, &middle);
  advance(simulation, (int64_t)(250 * sqrt(3))); /* to the outlet and 100 cells back */
  simulation_fields(simulation, rho, NULL, NULL);
  for (int x = 0; x < NX; x++) largest = fmax(largest, fabs(rho[NX + x] - 1) / 1e-4);
  cr_expect(largest < 0.268, "reflected: %g", largest);
  simulation_destroy(simulation);
  scene_clear(&scene);
}
