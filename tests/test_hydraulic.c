/* Discs with a hydraulic radius R_h < R: the fluid knows R_h, contacts and weight know R. */
#include "drive.h"
#include "scenes.h"
#include "sim/simulation.h"
#include "solid/occupation.h"
#include "stokes_array.h"

#include <criterion/criterion.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { DISCS = 36 };

/* Discs of radii between `small` and 7 with random velocities, close to each other. */
static struct scene crowd(double small, enum sides sides)
{
  const int columns = 6, size = 96;
  const double spacing = size / (double)columns;
  struct scene scene = scene_box(size, size, 0.02, sides);
  gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
  scene.coupling.hydraulic_radius = 0.8;
  scene.particles.gravity[0] = 2e-5;
  scene.particles.gravity[1] = -1e-4;
  scene.fluid.force[1] = 3e-5;
  for (int k = 0; k < DISCS; k++) {
    const double radius = small + (7 - small) * gsl_rng_uniform(random);
    struct disc_spec *disc =
        scene_add_disc(&scene, radius, 1.6, (k % columns + 0.5) * spacing, (k / columns + 0.5) * spacing);
    for (int axis = 0; axis < 2; axis++) disc->velocity[axis] = 0.04 * (2 * gsl_rng_uniform(random) - 1);
    disc->spin = 0.04 / radius * (2 * gsl_rng_uniform(random) - 1);
  }
  gsl_rng_free(random);
  return scene;
}

static size_t shared_cells(const struct occupation *o)
{
  size_t cells = 0;
  for (int k = 0; k < o->band_count; k++) cells += o->bands[k].shared_cells;
  return cells;
}

Test(hydraulic_radius, momentum_of_fluid_and_discs_is_constant_but_for_their_weight_while_discs_collide)
{
  static const enum coupling_form forms[] = {FORM_UNIFIED, FORM_OWEN, FORM_MIDPOINT};
  for (int k = 0; k < 3; k++) {
    struct scene scene = crowd(5, SIDES_PERIODIC);
    scene.coupling.form = forms[k];
    struct simulation *simulation = start(&scene);
    const struct discs *d = simulation_discs(simulation);
    struct simulation_report report;
    double scale = 0; /* of the exchanged momentum, per cell */
    size_t touches = 0, apart = 0;
    for (size_t i = 0; i < d->count; i++) scale += d->mass[i] * 0.03 / (double)scene_cells(&scene);
    for (int step = 0; step < 600; step++) {
      advance(simulation, 1);
      size_t touching = 0;
      for (size_t i = 0; i < d->count; i++) touching += d->contact_fx[i] != 0;
      touches += touching;
      apart += touching > 0 && shared_cells(simulation_occupation(simulation)) == 0;
    }
    simulation_report(simulation, &report);
    cr_expect_lt(report.momentum_drift / scale, 1e-11, "form %d: %g", k, report.momentum_drift / scale);
    cr_expect_gt(touches, 1000, "form %d: discs touch: %zu", k, touches);
    cr_expect_gt(apart, 50, "form %d: contacts without a cell of two discs: %zu", k, apart);
    simulation_destroy(simulation);
    scene_clear(&scene);
  }
}

Test(hydraulic_radius, a_free_disc_accelerates_by_reported_forces_and_by_the_weight_of_its_radius)
{
  struct scene scene = crowd(5, SIDES_CLOSED);
  struct simulation *simulation = start(&scene);
  const struct discs *d = simulation_discs(simulation);
  const double *gravity = scene.particles.gravity;
  for (int step = 0; step < 200; step++) {
    double before[DISCS][3];
    for (size_t i = 0; i < d->count; i++) before[i][0] = d->vx[i], before[i][1] = d->vy[i], before[i][2] = d->omega[i];
    advance(simulation, 1);
    for (size_t i = 0; i < d->count; i++) {
      const double area = M_PI * d->radius[i] * d->radius[i], mass = 1.6 * area, buoyant = 0.6 * area;
      const double fx = d->fx[i] + d->contact_fx[i] + buoyant * gravity[0];
      const double fy = d->fy[i] + d->contact_fy[i] + buoyant * gravity[1];
      const double inertia = mass * d->radius[i] * d->radius[i] / 2;
      cr_assert_float_eq(mass * (d->vx[i] - before[i][0]), fx, 1e-12, "step %d disc %zu", step, i);
      cr_assert_float_eq(mass * (d->vy[i] - before[i][1]), fy, 1e-12, "step %d disc %zu", step, i);
      cr_assert_float_eq(inertia * (d->omega[i] - before[i][2]), d->torque[i], 1e-11, "step %d disc %zu", step, i);
    }
  }
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* Velocities of all cells, and force on the first disc, after some steps. */
static double *flow_after(const struct scene *scene, int64_t steps, double force[3])
{
  const size_t cells = (size_t)scene_cells(scene);
  double *velocity = malloc(2 * cells * sizeof *velocity);
  struct simulation *simulation = start(scene);
  const struct discs *d = simulation_discs(simulation);
  cr_assert(velocity);
  advance(simulation, steps);
  simulation_fields(simulation, NULL, velocity, velocity + cells);
  force[0] = d->fx[0], force[1] = d->fy[0], force[2] = d->torque[0];
  simulation_destroy(simulation);
  return velocity;
}

Test(hydraulic_radius, fluid_flows_past_a_fixed_disc_as_past_a_disc_of_that_radius)
{
  double force[2][3], *velocity[2];
  size_t cells = 0;
  for (int k = 0; k < 2; k++) {
    struct scene scene = scene_box(48, 40, 0.02, SIDES_PERIODIC);
    scene.fluid.force[0] = 1e-5;
    scene.coupling.hydraulic_radius = k ? 0.75 : 1;
    struct disc_spec *disc = scene_add_disc(&scene, k ? 8 : 6, 1, 20.3, 19.6);
    disc->motion = DISC_FIXED;
    disc->spin = 0.004;
    velocity[k] = flow_after(&scene, 500, force[k]);
    cells = (size_t)scene_cells(&scene);
    scene_clear(&scene);
  }
  cr_expect_eq(memcmp(velocity[0], velocity[1], 2 * cells * sizeof(double)), 0);
  cr_expect_eq(memcmp(force[0], force[1], sizeof force[0]), 0);
  cr_expect_gt(force[0][0], 0);
  for (int k = 0; k < 2; k++) free(velocity[k]);
}

/* Mass, buoyant weight and radius for the fluid are equal; only the moment of inertia is not, and symmetry forbids spin. */
Test(hydraulic_radius, a_disc_falls_as_one_of_that_radius_with_the_same_mass_and_weight)
{
  const double part = 0.8, density = 1.5, gravity = 1e-4;
  double at[2], speed[2];
  for (int k = 0; k < 2; k++) {
    struct scene scene = scene_box(60, 80, 0.02, SIDES_CLOSED);
    const double own = k ? density : density / (part * part);
    scene.coupling.hydraulic_radius = k ? part : 1;
    scene.fluid.zero_flux = true;
    scene.particles.gravity[1] = -gravity * (k ? 1 : (density - 1) / (density - part * part));
    scene_add_disc(&scene, k ? 10 : 10 * part, own, 30, 50);
    struct simulation *simulation = start(&scene);
    advance(simulation, 800);
    at[k] = simulation_discs(simulation)->y[0];
    speed[k] = simulation_discs(simulation)->vy[0];
    simulation_destroy(simulation);
    scene_clear(&scene);
  }
  cr_expect_lt(speed[0], -0.01);
  cr_expect_float_eq(at[0], at[1], 1e-9, "%.15g %.15g", at[0], at[1]);
  cr_expect_float_eq(speed[0], speed[1], 1e-11, "%.15g %.15g", speed[0], speed[1]);
}

/* Discs that spin without moving: moments of inertia and radii for the fluid are equal. */
Test(hydraulic_radius, a_disc_spins_down_as_one_of_that_radius_with_the_same_moment_of_inertia)
{
  const double part = 0.8, density = 1.5;
  double spin[2];
  for (int k = 0; k < 2; k++) {
    struct scene scene = scene_box(60, 60, 0.02, SIDES_CLOSED);
    scene.coupling.hydraulic_radius = k ? part : 1;
    scene_add_disc(&scene, k ? 10 : 10 * part, k ? density : density / pow(part, 4), 30, 30)->spin = 0.01;
    struct simulation *simulation = start(&scene);
    advance(simulation, 800);
    spin[k] = simulation_discs(simulation)->omega[0];
    simulation_destroy(simulation);
    scene_clear(&scene);
  }
  cr_expect_lt(spin[0], 0.009);
  cr_expect_float_eq(spin[0], spin[1], 1e-13, "%.15g %.15g", spin[0], spin[1]);
}

/* Hydraulic radii leave gaps of up to 7 cells between discs that touch, for radii that are equal or differ up to 7-fold. */
Test(hydraulic_radius, contacts_do_not_depend_on_the_search_for_pairs)
{
  static const enum contact_search searches[] = {SEARCH_GRID, SEARCH_LINKED_CELL};
  for (int n = 0; n < 4; n++) {
    double state[2][4][DISCS], touching = 0;
    for (int k = 0; k < 2; k++) {
      struct scene scene = crowd(n / 2 ? 7 : 1, n % 2 ? SIDES_CLOSED : SIDES_PERIODIC);
      scene.coupling.hydraulic_radius = 0.5;
      scene.contact.search = searches[k];
      struct simulation *simulation = start(&scene);
      const struct discs *d = simulation_discs(simulation);
      const double *const arrays[] = {d->x, d->y, d->vx, d->contact_fy};
      for (int step = 0; step < 400; step++) {
        advance(simulation, 1);
        for (size_t i = 0; i < d->count; i++) touching += d->contact_fx[i] != 0;
      }
      for (int a = 0; a < 4; a++) memcpy(state[k][a], arrays[a], sizeof state[k][a]);
      simulation_destroy(simulation);
      scene_clear(&scene);
    }
    cr_expect_gt(touching, 500, "crowd %d: %g", n, touching);
    cr_expect_eq(memcmp(state[0], state[1], sizeof state[0]), 0, "crowd %d", n);
  }
}

/* Fixed discs of R = 15 that touch, centres at (7.5, h/4) + offset; the cell of the hexagonal array has two of them and a
 * ratio of sides of sqrt(3) to within 0.1 %. */
static struct scene packed_array(enum stokes_lattice lattice, double hydraulic_radius, double offset)
{
  const int width = 30, height = lattice == STOKES_SQUARE ? width : 52;
  const double radius = width / 2.0, viscosity = 0.05;
  struct scene scene = scene_box(width, height, viscosity, SIDES_PERIODIC);
  scene.coupling.hydraulic_radius = hydraulic_radius;
  scene.fluid.force[0] = 1e-6 * viscosity;
  for (int k = 0; k < (lattice == STOKES_SQUARE ? 1 : 2); k++)
    scene_add_disc(&scene, radius, 1, (0.25 + 0.5 * k) * width + offset, (0.25 + 0.5 * k) * height + offset)->motion =
        DISC_FIXED;
  return scene;
}

/* K = F/(mu U) of the array, where U has changed by less than 10^-5 in 500 steps or after 10,000 steps. */
static double drag_of(const struct scene *scene)
{
  struct simulation *simulation = start(scene);
  double speed = 0, before = 1;
  for (int k = 0; k < 20 && !(fabs(speed / before - 1) < 1e-5); k++) {
    struct simulation_report report;
    before = speed;
    advance(simulation, 500);
    simulation_report(simulation, &report);
    speed = report.mean_velocity[0];
  }
  simulation_destroy(simulation);
  return scene->fluid.force[0] * (double)scene_cells(scene) / (double)scene->particles.count /
         (scene->fluid.viscosity * speed);
}

Test(hydraulic_radius, the_reference_for_arrays_agrees_with_sangani_and_acrivos)
{
  static const double square[][2] = {{0.05, 15.55782}, {0.2, 51.52695}, {0.3, 102.8813}, {0.5, 532.5481}};
  for (size_t k = 0; k < sizeof square / sizeof square[0]; k++)
    cr_expect_float_eq(stokes_array_drag(STOKES_SQUARE, square[k][0]) / square[k][1], 1, 1e-5);
}

/* Bars of the drag benchmark for single square arrays: 3 % up to a solid fraction of 0.33, 5 % at 0.58. */
Test(hydraulic_radius, discs_that_touch_let_fluid_pass_as_arrays_of_the_effective_solid_fraction_do)
{
  static const double parts[][2] = {{0.6, 0.03}, {0.8, 0.05}}, offsets[] = {0, 0.3};
  for (int lattice = STOKES_SQUARE; lattice <= STOKES_HEXAGONAL; lattice++)
    for (int k = 0; k < 4; k++) {
      const double part = parts[k / 2][0], bar = parts[k / 2][1];
      struct scene scene = packed_array((enum stokes_lattice)lattice, part, offsets[k % 2]);
      const double area = part * part * disc_spec_area(&scene.particles.discs[0]) * (double)scene.particles.count;
      const double exact = stokes_array_drag((enum stokes_lattice)lattice, area / (double)scene_cells(&scene));
      const double error = drag_of(&scene) / exact - 1;
      cr_expect_lt(fabs(error), bar, "lattice %d, R_h/R %g, offset %g: %+.2f %%", lattice, part, offsets[k % 2],
                   100 * error);
      scene_clear(&scene);
    }
}

Test(hydraulic_radius, discs_that_touch_are_sealed_without_one)
{
  for (int lattice = STOKES_SQUARE; lattice <= STOKES_HEXAGONAL; lattice++) {
    struct scene open = packed_array((enum stokes_lattice)lattice, 0.8, 0),
                 sealed = packed_array((enum stokes_lattice)lattice, 1, 0);
    cr_expect_gt(drag_of(&sealed), 50 * drag_of(&open), "lattice %d", lattice);
    scene_clear(&open);
    scene_clear(&sealed);
  }
}
