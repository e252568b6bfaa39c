/* Fluid and discs: conservation, stability, start and settling of discs. */
#include "drive.h"
#include "scenes.h"
#include "sim/simulation.h"
#include "solid/occupation.h"

#include <criterion/criterion.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>

static struct simulation_report report_of(struct simulation *simulation)
{
  struct simulation_report report;
  simulation_report(simulation, &report);
  return report;
}

/* Discs on a square grid with random velocities. */
static struct scene moving_discs(int n, double spacing, double radius, double density, double speed, enum sides sides)
{
  const int size = (int)lround(n * spacing);
  struct scene scene = scene_box(size, size, 0.02, sides);
  gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
  for (int k = 0; k < n * n; k++) {
    const double jitter = 0.3 * (gsl_rng_uniform(random) - 0.5);
    struct disc_spec *disc =
        scene_add_disc(&scene, radius, density, (k % n + 0.5) * spacing + jitter, (k / n + 0.5) * spacing - jitter);
    disc->velocity[0] = speed * (2 * gsl_rng_uniform(random) - 1);
    disc->velocity[1] = speed * (2 * gsl_rng_uniform(random) - 1);
    disc->spin = speed / radius * (2 * gsl_rng_uniform(random) - 1);
  }
  gsl_rng_free(random);
  return scene;
}

Test(conservation, mass_is_constant_in_a_closed_box_with_moving_discs)
{
  struct scene scene = moving_discs(4, 24, 7, 1.5, 0.03, SIDES_CLOSED);
  scene.particles.gravity[1] = -2e-4;
  scene.fluid.zero_flux = true;
  struct simulation *simulation = start(&scene);
  advance(simulation, 10000);
  cr_expect_lt(report_of(simulation).mass_drift, 1e-12);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* Cells with more than two owners, counted in the bands' lists: each owner of a cell is listed once. */
static size_t shares_beyond_two(const struct occupation *o)
{
  size_t beyond = 0;
  for (int k = 0; k < o->band_count; k++) beyond += o->bands[k].shared_owners - 2 * o->bands[k].shared_cells;
  return beyond;
}

static size_t shared_cells(const struct occupation *o)
{
  size_t cells = 0;
  for (int k = 0; k < o->band_count; k++) cells += o->bands[k].shared_cells;
  return cells;
}

static void expect_momentum_kept(enum coupling_form form, enum contact_area area)
{
  struct scene scene = moving_discs(6, 18, 6.3, 1.3, 0.04, SIDES_PERIODIC);
  scene.coupling.form = form;
  scene.contact.area = area;
  scene.contact.stiffness = 0.02;
  for (size_t i = 0; i < scene.particles.count; i++) scene.particles.discs[i].velocity[0] += 0.04; /* they all drift */
  /* three more at one place */
  scene_add_disc(&scene, 6, 2, 50, 50)->velocity[0] = 0.05;
  scene_add_disc(&scene, 6, 2, 58, 50)->velocity[0] = -0.05;
  scene_add_disc(&scene, 6, 2, 54, 56)->velocity[1] = -0.05;
  double scale = 0; /* of the exchanged momentum */
  for (size_t k = 0; k < scene.particles.count; k++) {
    const struct disc_spec *disc = &scene.particles.discs[k];
    scale += disc->density * M_PI * disc->radius * disc->radius * hypot(disc->velocity[0], disc->velocity[1]);
  }
  struct simulation *simulation = start(&scene);
  size_t twos = 0, threes = 0, crossings = 0;
  const struct discs *discs = simulation_discs(simulation);
  double previous[64];
  memcpy(previous, discs->x, discs->count * sizeof *previous);
  for (int k = 0; k < 40; k++) {
    for (int step = 0; step < 50; step++) {
      advance(simulation, 1);
      for (size_t i = 0; i < discs->count; i++) crossings += fabs(discs->x[i] - previous[i]) > 50;
      memcpy(previous, discs->x, discs->count * sizeof *previous);
      twos += shared_cells(simulation_occupation(simulation));
      threes += shares_beyond_two(simulation_occupation(simulation));
    }
  }
  const double drift = report_of(simulation).momentum_drift * scene.domain.size[0] * scene.domain.size[1];
  cr_expect_lt(drift / scale, 1e-10, "form %d, area %d: %g", form, area, drift / scale);
  cr_expect_gt(twos, 1000, "discs overlap: %zu", twos);
  cr_expect_gt(threes, 100, "cells have three owners: %zu", threes);
  cr_expect_gt(crossings, 0, "discs cross the periodic sides");
  simulation_destroy(simulation);
  scene_clear(&scene);
}

Test(conservation, momentum_is_constant_while_discs_collide_and_cross_periodic_sides)
{
  expect_momentum_kept(FORM_OWEN, AREA_LENS);
  expect_momentum_kept(FORM_UNIFIED, AREA_LENS);
  expect_momentum_kept(FORM_MIDPOINT, AREA_LENS);
  expect_momentum_kept(FORM_OWEN, AREA_CELLS);
}

Test(conservation, a_free_disc_accelerates_by_the_forces_reported_for_it)
{
  struct scene scene = moving_discs(4, 16, 7, 1.7, 0.05, SIDES_CLOSED);
  scene.particles.gravity[0] = 1e-5;
  scene.particles.gravity[1] = -3e-4;
  scene.fluid.zero_flux = true;
  struct simulation *simulation = start(&scene);
  const struct discs *d = simulation_discs(simulation);
  double contacts = 0;
  for (int step = 0; step < 400; step++) {
    double before[16][3];
    for (size_t i = 0; i < d->count; i++) before[i][0] = d->vx[i], before[i][1] = d->vy[i], before[i][2] = d->omega[i];
    advance(simulation, 1);
    for (size_t i = 0; i < d->count; i++) {
      const double buoyant = d->mass[i] - d->fluid_mass[i];
      const double fx = d->fx[i] + d->contact_fx[i] + buoyant * scene.particles.gravity[0];
      const double fy = d->fy[i] + d->contact_fy[i] + buoyant * scene.particles.gravity[1];
      cr_assert_float_eq(d->mass[i] * (d->vx[i] - before[i][0]), fx, 1e-12, "step %d disc %zu", step, i);
      cr_assert_float_eq(d->mass[i] * (d->vy[i] - before[i][1]), fy, 1e-12, "step %d disc %zu", step, i);
      cr_assert_float_eq(d->inertia[i] * (d->omega[i] - before[i][2]), d->torque[i], 1e-11, "step %d disc %zu", step,
                         i);
      contacts += fabs(d->contact_fx[i]) + fabs(d->contact_fy[i]);
    }
  }
  cr_expect_gt(contacts, 0, "some discs have touched");
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* All of a disc's state after a run with so many threads. */
static void state_after(const struct scene *scene, int threads, int64_t steps, double *state)
{
  omp_set_num_threads(threads);
  struct simulation *simulation = start(scene);
  advance(simulation, steps);
  const struct discs *d = simulation_discs(simulation);
  const double *const arrays[] = {d->x,  d->y,  d->vx,     d->vy,         d->omega,
                                  d->fx, d->fy, d->torque, d->contact_fx, d->contact_fy};
  for (size_t k = 0; k < 10; k++) memcpy(state + k * d->count, arrays[k], d->count * sizeof *state);
  simulation_fields(simulation, state + 10 * d->count, NULL, NULL);
  simulation_destroy(simulation);
}

Test(reproducibility, any_number_of_threads_gives_the_same_bits)
{
  static const int threads[] = {1, 2, 3, 4, 7};
  for (int k = 0; k < 6; k++) {
    const int sides = k % 2;
    struct scene scene = moving_discs(7, 26, 11.5, 1.2, 0.05, sides ? SIDES_CLOSED : SIDES_PERIODIC);
    if (k == 4) scene.domain.side[SIDE_LEFT].type = scene.domain.side[SIDE_RIGHT].type = SIDE_OUTLET;
    if (k == 5) scene.domain.side[SIDE_TOP].type = SIDE_OUTLET;
    scene.fluid.zero_flux = sides && k < 4;
    scene.contact.area = k < 2 ? AREA_CELLS : AREA_LENS;
    scene.contact.stiffness = k < 2 ? 0.25 : 30;
    scene.particles.gravity[1] = -1e-4;
    const size_t count = 10 * 49 + (size_t)(scene.domain.size[0] * scene.domain.size[1]);
    double *first = malloc(count * sizeof *first), *other = malloc(count * sizeof *other);
    state_after(&scene, threads[0], 301, first);
    for (size_t t = 1; t < sizeof threads / sizeof threads[0]; t++) {
      state_after(&scene, threads[t], 301, other);
      cr_expect_eq(memcmp(first, other, count * sizeof *first), 0, "%d threads differ from 1", threads[t]);
    }
    free(first);
    free(other);
    scene_clear(&scene);
  }
}

/* Both searches find all pairs that overlap, and lens areas are independent of the search. */
Test(reproducibility, linked_cells_and_the_grid_give_the_same_run)
{
  for (int sides = 0; sides < 2; sides++) {
    struct scene scene = moving_discs(8, 24, 11.5, 1.2, 0.05, sides ? SIDES_CLOSED : SIDES_PERIODIC);
    scene_add_disc(&scene, 3, 1.2, 95.7, 96.2); /* another radius, in contact from the start */
    const size_t count = 10 * 65 + (size_t)(scene.domain.size[0] * scene.domain.size[1]);
    double *by_grid = malloc(count * sizeof *by_grid), *by_cells = malloc(count * sizeof *by_cells);
    state_after(&scene, 2, 200, by_grid);
    static const double edges[] = {0, 5, 200};
    for (int k = 0; k < 3; k++) {
      scene.contact.search = SEARCH_LINKED_CELL;
      scene.contact.edge = edges[k];
      state_after(&scene, 2, 200, by_cells);
      cr_expect_eq(memcmp(by_grid, by_cells, count * sizeof *by_grid), 0, "sides %d, edge %g", sides, edges[k]);
    }
    free(by_grid);
    free(by_cells);
    scene_clear(&scene);
  }
}

Test(reproducibility, results_do_not_depend_on_how_steps_are_grouped)
{
  struct scene scene = moving_discs(5, 14, 5, 1.2, 0.05, SIDES_CLOSED);
  struct simulation *whole = start(&scene), *parts = start(&scene);
  advance(whole, 120);
  for (int k = 0; k < 40; k++) advance(parts, 1 + (k % 3) * 2);
  cr_assert_eq(simulation_step(parts), 118);
  advance(parts, 2);
  const struct discs *a = simulation_discs(whole), *b = simulation_discs(parts);
  cr_expect_eq(memcmp(a->x, b->x, a->count * sizeof *a->x), 0);
  cr_expect_eq(memcmp(a->vy, b->vy, a->count * sizeof *a->vy), 0);
  cr_expect_eq(memcmp(a->torque, b->torque, a->count * sizeof *a->torque), 0);
  simulation_destroy(whole);
  simulation_destroy(parts);
  scene_clear(&scene);
}

/* Added mass of a cylinder: (m + m_f) a = (m - m_f) g, once sound has crossed the flow around the disc and before
 * the boundary layer has grown: the rest is the history force, 4 % at the smallest ratio. */
Test(motion, a_released_disc_starts_with_the_added_mass_of_a_cylinder)
{
  static const double ratios[] = {0.2, 0.5, 2, 10};
  for (int k = 0; k < 4; k++) {
    const double radius = 24, gravity = 1e-6;
    struct scene scene = scene_box(400, 400, 1e-5, SIDES_PERIODIC);
    scene.coupling.form = FORM_UNIFIED;
    scene_add_disc(&scene, radius, ratios[k], 200.3, 200.4);
    scene.particles.gravity[1] = -gravity;
    struct simulation *simulation = start(&scene);
    const struct discs *d = simulation_discs(simulation);
    advance(simulation, 300);
    const double before = d->vy[0];
    advance(simulation, 200);
    const double expected = -(ratios[k] - 1) / (ratios[k] + 1) * gravity, obtained = (d->vy[0] - before) / 200;
    cr_expect(fabs(obtained / expected - 1) < 0.05, "ratio %g: %g, expected %g", ratios[k], obtained, expected);
    simulation_destroy(simulation);
    scene_clear(&scene);
  }
}

Test(motion, a_settling_crowd_in_a_closed_box_sinks_steadily_without_ringing)
{
  struct scene scene = scene_box(400, 400, 0.05, SIDES_CLOSED);
  for (int k = 0; k < 400; k++)
    scene_add_disc(&scene, 5, 1.5, (k % 20 + 0.5) * 20 + 1e-3 * (k % 7), (k / 20 + 0.5) * 20);
  scene.particles.gravity[1] = -5e-4;
  scene.fluid.zero_flux = true;
  struct simulation *simulation = start(&scene);
  const struct discs *d = simulation_discs(simulation);
  double height = 1e9, *density = malloc(400 * 400 * sizeof *density), low = 1, high = 1;
  for (int k = 0; k < 40; k++) {
    advance(simulation, 50);
    double mean = 0;
    for (size_t i = 0; i < d->count; i++) mean += d->y[i] / (double)d->count;
    cr_expect_lt(mean, height, "mean height at step %d", 50 * (k + 1));
    height = mean;
    simulation_fields(simulation, density, NULL, NULL);
    for (int c = 0; c < 400 * 400; c++) low = fmin(low, density[c]), high = fmax(high, density[c]);
  }
  cr_expect(low > 0.98 && high < 1.04, "density between %g and %g", low, high);
  free(density);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* Two discs with cells in common from the start, one of them moving; mirrored in x. */
static struct simulation *shared_from_the_start(struct scene *scene, enum coupling_form form, double force, bool mirror)
{
  *scene = scene_box(40, 40, 0.1, SIDES_PERIODIC);
  scene->coupling.form = form;
  scene->fluid.force[1] = force;
  struct disc_spec *disc = scene_add_disc(scene, 2, 2, mirror ? 21.5 : 18.5, 20.5);
  disc->velocity[0] = mirror ? -0.05 : 0.05;
  disc->velocity[1] = 0.03;
  disc->spin = mirror ? 0.01 : -0.01;
  scene_add_disc(scene, 2, 2, mirror ? 18.7 : 21.3, 23.6);
  return start(scene);
}

Test(motion, cells_shared_at_the_start_favour_neither_owner_so_that_mirror_images_agree)
{
  for (int form = 0; form < FORM_COUNT; form++)
    for (int forced = 0; forced < 2; forced++) {
      struct scene scenes[2];
      struct simulation *simulations[2];
      for (int k = 0; k < 2; k++) {
        simulations[k] = shared_from_the_start(&scenes[k], (enum coupling_form)form, forced ? 1e-30 : 0, k == 1);
        advance(simulations[k], 40);
      }
      const struct discs *a = simulation_discs(simulations[0]), *b = simulation_discs(simulations[1]);
      for (size_t i = 0; i < 2; i++) {
        cr_expect_float_eq(a->x[i], 40 - b->x[i], 1e-12, "form %d, force %d, disc %zu", form, forced, i);
        cr_expect_float_eq(a->y[i], b->y[i], 1e-12, "form %d, force %d, disc %zu", form, forced, i);
        cr_expect_float_eq(a->omega[i], -b->omega[i], 1e-13, "form %d, force %d, disc %zu", form, forced, i);
      }
      for (int k = 0; k < 2; k++) {
        simulation_destroy(simulations[k]);
        scene_clear(&scenes[k]);
      }
    }
}

Test(stability, the_implicit_solve_is_stable_at_any_density_ratio, .timeout = 100 * SLOWNESS)
{
  static const double ratios[] = {0.05, 0.3, 0.8, 1.0001, 1.01, 10, 100};
  for (int form = 0; form < 2; form++)
    for (size_t k = 0; k < sizeof ratios / sizeof ratios[0]; k++) {
      struct scene scene = scene_box(64, 96, 0.05, SIDES_CLOSED);
      scene.coupling.form = form;
      scene.fluid.zero_flux = true;
      scene_add_disc(&scene, 6, ratios[k], 30.2, 50);
      scene_add_disc(&scene, 6, ratios[k], 30.0, 65);
      scene.particles.gravity[1] = -2e-4 / fmax(1, ratios[k]);
      struct simulation *simulation = start(&scene);
      advance(simulation, 20000);
      const struct discs *d = simulation_discs(simulation);
      for (size_t i = 0; i < d->count; i++) {
        cr_expect(d->x[i] > 5 && d->x[i] < 59 && d->y[i] > 5 && d->y[i] < 91, "ratio %g: disc %zu left the box",
                  ratios[k], i);
        cr_expect_lt(hypot(d->vx[i], d->vy[i]), 0.01, "ratio %g, form %d: disc %zu comes to rest, moves at %g",
                     ratios[k], form, i, hypot(d->vx[i], d->vy[i]));
      }
      simulation_destroy(simulation);
      scene_clear(&scene);
    }
}

/* The largest difference of the fluid at least 1.5 cells inside of a disc from the disc's own velocity. */
static double slip_inside(struct simulation *simulation, int nx, int ny)
{
  const size_t cells = (size_t)nx * (size_t)ny;
  const struct discs *d = simulation_discs(simulation);
  double *field = malloc(3 * cells * sizeof *field), *ux = field + cells, *uy = ux + cells, slip = 0;
  simulation_fields(simulation, field, ux, uy);
  for (size_t i = 0; i < d->count; i++)
    for (size_t k = 0; k < cells; k++) {
      const double x = (double)(k % (size_t)nx) + 0.5 - d->x[i], y = (double)(k / (size_t)nx) + 0.5 - d->y[i];
      if (hypot(x, y) < d->radius[i] - 1.5)
        slip = fmax(slip, hypot(ux[k] - d->vx[i] + d->omega[i] * y, uy[k] - d->vy[i] - d->omega[i] * x));
    }
  free(field);
  return slip;
}

/* The rim must not drive oscillations of the fluid inside: owen's form diverges at this spin by step 1300. */
Test(stability, a_fixed_disc_spinning_at_mach_a_quarter_turns_its_fluid_with_it)
{
  static const double viscosities[] = {0.005, 0.05, 1.0 / 6};
  const double spin = 0.015;
  for (int k = 0; k < 3; k++) {
    struct scene scene = scene_box(60, 60, viscosities[k], SIDES_PERIODIC);
    struct disc_spec *disc = scene_add_disc(&scene, 10, 1, 30.3, 30.2);
    disc->motion = DISC_FIXED;
    disc->spin = spin;
    struct simulation *simulation = start(&scene);
    advance(simulation, 20000);
    const double slip = slip_inside(simulation, 60, 60);
    cr_expect_lt(slip, 0.02 * 10 * spin, "viscosity %g: %g", viscosities[k], slip);
    simulation_destroy(simulation);
    scene_clear(&scene);
  }
}

/* Reynolds number 460 at Mach 0.1, where the rates that are best for slow flow diverge by step 450. */
Test(stability, fast_fluid_at_small_viscosity_is_stable_with_the_default_rates)
{
  struct scene scene = scene_box(160, 80, 0.002, SIDES_PERIODIC);
  struct disc_spec *disc = scene_add_disc(&scene, 8, 1, 80, 40.2);
  disc->motion = DISC_DRIVEN;
  disc->velocity[0] = 0.1 / sqrt(3);
  struct simulation *simulation = start(&scene);
  advance(simulation, 2770);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* The uniform force of zero flux must not overshoot where discs are lighter than fluid. */
Test(stability, light_discs_packed_in_a_closed_box_rise)
{
  struct scene scene = scene_box(100, 80, 0.05, SIDES_CLOSED);
  scene.fluid.zero_flux = true;
  scene.particles.gravity[1] = -1e-3;
  for (int k = 0; k < 56; k++) scene_add_disc(&scene, 4.9, 0.1, 5.4 + 10.2 * (k % 8), 5.4 + 10.2 * (k / 8));
  struct simulation *simulation = start(&scene);
  const struct discs *d = simulation_discs(simulation);
  double before = 0, after = 0;
  for (size_t i = 0; i < d->count; i++) before += d->y[i] / 56;
  advance(simulation, 3000);
  for (size_t i = 0; i < d->count; i++) after += d->y[i] / 56;
  cr_expect(after > before + 2, "from %g to %g", before, after);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* The deferred momentum of light discs must not drive oscillations: with too short a delay they reach Mach 0.1. */
Test(stability, a_crowd_of_small_light_discs_at_small_viscosity_rises_quietly)
{
  struct scene scene = scene_box(80, 72, 0.005, SIDES_CLOSED);
  scene.fluid.zero_flux = true;
  scene.particles.gravity[1] = -2e-5;
  for (int k = 0; k < 72; k++)
    scene_add_disc(&scene, 3, 0.1, 5 + 8.7 * (k % 9) + 0.3 * (k / 9 % 3), 4.5 + 8.8 * (k / 9));
  struct simulation *simulation = start(&scene);
  advance(simulation, 6000);
  struct simulation_report report;
  simulation_report(simulation, &report);
  cr_expect_lt(report.max_mach, 0.04, "Mach %g", report.max_mach);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* Without damping inside discs the fluid there moves against them by 0.03. */
Test(stability, fluid_inside_the_discs_of_a_pile_moves_with_them)
{
  struct scene scene = scene_box(100, 100, 0.005, SIDES_CLOSED);
  scene.fluid.zero_flux = true;
  scene.particles.gravity[1] = -5e-4;
  for (int k = 0; k < 36; k++) scene_add_disc(&scene, 6, 1.5, 9 + 16 * (k % 6) + 1.7 * (k / 6 % 2), 9 + 15 * (k / 6));
  struct simulation *simulation = start(&scene);
  advance(simulation, 10000);
  const double slip = slip_inside(simulation, 100, 100);
  cr_expect_lt(slip, 0.003, "%g", slip);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* The largest Mach number in 3000 steps with a disc of R = 3 overlapped by a wall or another disc that moves at Mach
 * `mach`. */
static double fastest_between(bool wall, double mach, double overlap)
{
  struct scene scene = scene_box(90, 60, 0.007, SIDES_CLOSED);
  scene_add_disc(&scene, 3, 1, 40, 57 + overlap)->motion = DISC_FIXED;
  if (wall) {
    scene.domain.side[SIDE_TOP].velocity[0] = mach / sqrt(3);
  } else {
    struct disc_spec *other = scene_add_disc(&scene, 5, 1, 41, 49.06 + 2 * overlap);
    other->motion = DISC_FIXED;
    other->spin = mach / sqrt(3) / 5;
  }
  struct simulation *simulation = start(&scene);
  advance(simulation, 3000);
  struct simulation_report report;
  simulation_report(simulation, &report);
  simulation_destroy(simulation);
  scene_clear(&scene);
  return report.max_mach;
}

/* They drive the trapped fluid, without damping to Mach 0.6 in 50 steps. */
Test(stability, surfaces_that_pass_each_other_drive_fluid_between_them_hardly_faster_than_themselves)
{
  static const double overlaps[] = {-0.1, 0.2, 0.5, 0.9};
  const double mach = 0.15;
  for (int k = 0; k < 4; k++)
    for (int wall = 0; wall < 2; wall++) {
      const double fastest = fastest_between(wall, mach, overlaps[k]);
      cr_expect_lt(fastest, 1.5 * mach, "%s, overlap %g: Mach %g", wall ? "wall" : "disc", overlaps[k], fastest);
    }
}

/* With zero flux, the default in a closed box with gravity. */
Test(stability, a_disc_on_the_ground_comes_to_rest_and_the_contact_supports_its_weight)
{
  struct scene scene = scene_box(60, 60, 0.05, SIDES_CLOSED);
  scene_add_disc(&scene, 10, 1.01, 30.3, 11);
  scene.fluid.zero_flux = true;
  scene.particles.gravity[1] = -0.0245;
  struct simulation *simulation = start(&scene);
  advance(simulation, 25000);
  const struct discs *d = simulation_discs(simulation);
  const double weight = (d->mass[0] - d->fluid_mass[0]) * 0.0245;
  cr_expect_float_eq(d->contact_fy[0], weight, 0.001 * weight, "%g of %g", d->contact_fy[0], weight);
  for (int step = 0; step < 2; step++, advance(simulation, 1))
    cr_expect_lt(hypot(d->vx[0], d->vy[0]), 1e-7, "moves at %g", hypot(d->vx[0], d->vy[0]));
  simulation_destroy(simulation);
  scene_clear(&scene);
}

Test(stability, explicit_coupling_of_a_light_disc_diverges_and_says_so_soon)
{
  struct scene scene = scene_box(64, 64, 0.05, SIDES_CLOSED);
  scene.coupling.solve = SOLVE_EXPLICIT_AVERAGED;
  scene_add_disc(&scene, 8, 0.3, 32, 32);
  scene.particles.gravity[1] = -1e-3;
  struct simulation *simulation = start(&scene);
  struct status status;
  cr_assert_not(simulation_advance(simulation, 5000, &status));
  cr_expect_eq(status.code, DELBM_FAILED);
  cr_expect_lt(simulation_step(simulation), 1000);
  cr_expect(strstr(status.message, "diverged") && strstr(status.message, "disc 0"), "%s", status.message);
  cr_expect_not(simulation_check(simulation, &status), "and it stays failed");
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* A heavy disc runs into a wall through viscous fluid. */
Test(stability, fluid_squeezed_out_of_a_gap_too_fast_is_named_as_that)
{
  struct scene scene = scene_box(100, 100, 0.5, SIDES_CLOSED);
  struct status status;
  scene_add_disc(&scene, 5, 50, 50.3, 7)->velocity[1] = -0.08;
  scene.contact.stiffness = 25;
  struct simulation *simulation = start(&scene);
  cr_assert_not(simulation_advance(simulation, 1000, &status));
  cr_expect(strstr(status.message, "it lies between disc 0 and the bottom side"), "%s", status.message);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

Test(stability, discs_that_close_an_outlet_are_named_as_the_cause_of_the_pressure)
{
  struct scene scene = scene_box(60, 24, 0.05, SIDES_CLOSED);
  struct simulation *simulation;
  struct status status;
  scene.domain.side[SIDE_LEFT] = (struct side){SIDE_INLET, {0.01, 0}};
  scene.domain.side[SIDE_RIGHT].type = SIDE_OUTLET;
  for (int k = 0; k < 3; k++) scene_add_disc(&scene, 4.1, 1, 50, 4 + 8 * k)->motion = DISC_FIXED;
  cr_assert(simulation_create(&simulation, &scene, &status), "%s", status.message);
  cr_assert_not(simulation_advance(simulation, 100000, &status));
  cr_expect(strstr(status.message, "denser than the method can describe"), "%s", status.message);
  cr_expect(strstr(status.message, "more enters than leaves: discs may close an outlet"), "%s", status.message);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

Test(stability, fluid_of_negative_density_inside_a_disc_is_called_that)
{
  struct scene scene = scene_box(60, 100, 0.05, SIDES_CLOSED);
  struct simulation *simulation;
  struct status status;
  scene_use_paper_rates(&scene);
  scene.coupling.form = FORM_OWEN;
  scene.contact.stiffness = 0;
  scene_add_disc(&scene, 3, 50, 30, 8)->velocity[1] = -0.28;
  cr_assert(simulation_create(&simulation, &scene, &status), "%s", status.message);
  cr_assert_not(simulation_advance(simulation, 400, &status));
  cr_expect(strstr(status.message, "negative density"), "%s", status.message);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

Test(stability, fluid_too_fast_is_found_within_the_interval_of_checks)
{
  struct scene scene = scene_box(32, 32, 0.05, SIDES_PERIODIC);
  scene.fluid.force[0] = 1e-3;
  struct simulation *simulation = start(&scene);
  struct status status;
  cr_assert_not(simulation_advance(simulation, 5000, &status));
  const int64_t exceeded = 347; /* step at which force * steps passes 0.6/sqrt(3) */
  cr_expect(simulation_step(simulation) >= exceeded && simulation_step(simulation) <= exceeded + 100,
            "stopped at %lld: %s", (long long)simulation_step(simulation), status.message);
  cr_expect(strstr(status.message, "Mach"), "%s", status.message);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* Sedimentation of a regular square array, one in a periodic cell, in water without net flux: their net weight is
 * the drag K mu U of the array, K = 51.527 at solid fraction 0.2 (Sangani & Acrivos 1982). */
Test(exchange, a_regular_array_settles_at_the_speed_that_its_drag_allows)
{
  static const struct {
    enum coupling_form form;
    void (*use)(struct scene *scene);
    double percent;
  } choices[] = {{FORM_UNIFIED, scene_use_paper_rates, 8},
                 {FORM_OWEN, scene_use_paper_rates, 3},
                 {FORM_OWEN, scene_use_magic, 4},
                 {FORM_MIDPOINT, scene_use_adaptive, 2}};
  const double radius = 20 * sqrt(0.2 / M_PI), weight = 0.01 * 0.2 * 400 * 0.005, viscosity = 0.05;
  for (size_t k = 0; k < sizeof choices / sizeof choices[0]; k++) {
    struct scene scene = scene_box(20, 20, viscosity, SIDES_PERIODIC);
    struct simulation *simulation;
    struct status status;
    scene.coupling.form = choices[k].form;
    choices[k].use(&scene);
    scene.particles.gravity[1] = -0.005;
    scene.fluid.force[1] = weight / 400;
    scene_add_disc(&scene, radius, 1.01, 10.3, 10.1);
    cr_assert(simulation_create(&simulation, &scene, &status), "%s", status.message);
    cr_assert(simulation_advance(simulation, 6000, &status), "%s", status.message);
    double before = simulation_discs(simulation)->y[0], fallen = 0; /* averaged over the cells crossed */
    for (int n = 0; n < 6000; n += 100) {
      cr_assert(simulation_advance(simulation, 100, &status), "%s", status.message);
      const double y = simulation_discs(simulation)->y[0];
      fallen += remainder(before - y, 20);
      before = y;
    }
    const double speed = fallen / 6000, expected = weight / (51.527 * viscosity);
    cr_expect(fabs(speed / expected - 1) < choices[k].percent / 100, "choice %zu: %g, %+.2f %% off %g", k, speed,
              100 * (speed / expected - 1), expected);
    simulation_destroy(simulation);
    scene_clear(&scene);
  }
}

/* Discs so light that they have virtual mass and deferred momentum. */
static struct scene light_discs(void)
{
  struct scene scene = moving_discs(3, 20, 6, 1, 0.03, SIDES_PERIODIC);
  for (size_t i = 0; i < scene.particles.count; i++) scene.particles.discs[i].density = 0.02 + 0.04 * (double)i;
  scene.particles.gravity[1] = -1e-5;
  scene.particles.gravity[0] = 4e-6;
  return scene;
}

Test(conservation, a_very_light_disc_accelerates_by_the_forces_reported_for_it)
{
  struct scene scene = light_discs();
  struct simulation *simulation = start(&scene);
  const struct discs *d = simulation_discs(simulation);
  for (int step = 0; step < 200; step++) {
    double before[9][3];
    for (size_t i = 0; i < d->count; i++) before[i][0] = d->vx[i], before[i][1] = d->vy[i], before[i][2] = d->omega[i];
    advance(simulation, 1);
    for (size_t i = 0; i < d->count; i++) {
      const double buoyant = d->mass[i] - d->fluid_mass[i];
      const double fx = d->fx[i] + d->contact_fx[i] + buoyant * scene.particles.gravity[0];
      const double fy = d->fy[i] + d->contact_fy[i] + buoyant * scene.particles.gravity[1];
      cr_assert_float_eq(d->mass[i] * (d->vx[i] - before[i][0]), fx, 1e-12, "step %d disc %zu", step, i);
      cr_assert_float_eq(d->mass[i] * (d->vy[i] - before[i][1]), fy, 1e-12, "step %d disc %zu", step, i);
      cr_assert_float_eq(d->inertia[i] * (d->omega[i] - before[i][2]), d->torque[i], 1e-11, "step %d disc %zu", step,
                         i);
    }
  }
  simulation_destroy(simulation);
  scene_clear(&scene);
}

Test(conservation, momentum_is_constant_with_very_light_discs)
{
  struct scene scene = light_discs();
  struct simulation *simulation = start(&scene);
  advance(simulation, 501);
  cr_expect_lt(report_of(simulation).momentum_drift, 1e-15, "%g", report_of(simulation).momentum_drift);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* Angular momentum of all fluid about the middle of a box of this size; conserved by collision and streaming. */
static double angular_momentum(struct simulation *simulation, int size)
{
  const size_t cells = (size_t)size * (size_t)size;
  double *rho = malloc(3 * cells * sizeof *rho), *ux = rho + cells, *uy = ux + cells, sum = 0;
  simulation_fields(simulation, rho, ux, uy);
  for (size_t k = 0; k < cells; k++) {
    const double x = (double)(k % (size_t)size) + 0.5 - size / 2.0, y = (double)(k / (size_t)size) + 0.5 - size / 2.0;
    sum += rho[k] * (x * uy[k] - y * ux[k]);
  }
  free(rho);
  return sum;
}

/* A free disc that spins in the middle of a box so large that the flow has not reached its sides: the fluid gains
 * the angular momentum that the disc loses. The averaged solve lags by half a step's torque at start and end. */
static void expect_angular_momentum_kept(enum coupling_solve solve, double spin)
{
  enum { SIZE = 80, STEPS = 50 };
  struct scene scene = scene_box(SIZE, SIZE, 0.02, SIDES_PERIODIC);
  const bool implicit = solve == SOLVE_IMPLICIT;
  const double radius = 8.2, density = 2.5, fluid_inertia = M_PI * pow(radius, 4) / 2,
               inertia = density * fluid_inertia;
  scene.coupling.solve = solve;
  scene_add_disc(&scene, radius, density, SIZE / 2.0, SIZE / 2.0)->spin = spin;
  struct simulation *simulation = start(&scene);
  const struct discs *d = simulation_discs(simulation);
  const double before = angular_momentum(simulation, SIZE);
  double impulse = 0, first = 0;
  for (int step = 0; step < STEPS; step++) {
    advance(simulation, 1);
    impulse += d->torque[0];
    if (step == 0) first = d->torque[0];
  }
  const double gained = angular_momentum(simulation, SIZE) - before, lag = implicit ? 0 : (first - d->torque[0]) / 2;
  const double lost = inertia * (spin - d->omega[0]), scale = fabs(inertia * spin);
  const double of_fluid_inside = implicit ? fluid_inertia * (spin - d->omega[0]) : 0;
  cr_expect_gt(lost / (inertia * spin), 0.05, "the disc slows down: by %g", lost / (inertia * spin));
  cr_expect_float_eq((lost + impulse + lag) / scale, 0, 1e-12, "by its torque: %g", (lost + impulse + lag) / scale);
  cr_expect_float_eq((gained - (lost - of_fluid_inside) - lag) / scale, 0, 1e-9, "gained %.12g, lost %.12g", gained,
                     lost - of_fluid_inside + lag);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

Test(conservation, a_disc_that_spins_loses_the_angular_momentum_that_the_fluid_gains)
{
  for (int k = 0; k < 2; k++) {
    expect_angular_momentum_kept(SOLVE_IMPLICIT, k ? -0.008 : 0.006);
    expect_angular_momentum_kept(SOLVE_EXPLICIT_AVERAGED, k ? -0.008 : 0.006);
  }
}

/* 0.6 c_s = 0.3464 cells/step, at the fastest point of the rim. */
Test(stability, a_disc_whose_rim_passes_mach_0_6_is_refused_whichever_way_it_spins)
{
  static const struct {
    double velocity, spin;
    bool allowed;
  } cases[] = {{0.3, 0.004, true},   {0.3, -0.004, true}, {0.3, 0.006, false}, {0.3, -0.006, false},
               {-0.3, 0.006, false}, {0, 0.034, true},    {0, 0.036, false},   {0, -0.036, false}};
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
    struct scene scene = scene_box(60, 60, 0.1, SIDES_PERIODIC);
    struct disc_spec *disc = scene_add_disc(&scene, 10, 1, 30, 30);
    disc->motion = DISC_DRIVEN;
    disc->velocity[k % 2] = cases[k].velocity;
    disc->spin = cases[k].spin;
    struct simulation *simulation = start(&scene);
    struct status status;
    const bool done = simulation_advance(simulation, 1, &status);
    cr_expect_eq(done, cases[k].allowed, "case %zu", k);
    if (!done)
      cr_expect(status.code == DELBM_FAILED && strstr(status.message, "disc 0") && strstr(status.message, "Mach 0.6"),
                "case %zu: %s", k, status.message);
    simulation_destroy(simulation);
    scene_clear(&scene);
  }
}

Test(motion, discs_start_as_the_case_says_with_the_mass_and_the_inertia_of_discs)
{
  struct scene scene = scene_box(60, 50, 0.1, SIDES_CLOSED);
  const double radius = 4.2, density = 2.5;
  *scene_add_disc(&scene, radius, density, 0, 0) = (struct disc_spec){.radius = radius,
                                                                      .density = density,
                                                                      .position = {20.3, 30.7},
                                                                      .velocity = {0.01, -0.02},
                                                                      .angle = 0.7,
                                                                      .spin = -0.003};
  struct simulation *simulation = start(&scene);
  const struct discs *d = simulation_discs(simulation);
  cr_expect(d->x[0] == 20.3 && d->y[0] == 30.7 && d->angle[0] == 0.7, "at (%g, %g), angle %g", d->x[0], d->y[0],
            d->angle[0]);
  cr_expect(d->vx[0] == 0.01 && d->vy[0] == -0.02 && d->omega[0] == -0.003);
  const double area = M_PI * radius * radius;
  cr_expect_float_eq(d->mass[0], density * area, 1e-12);
  cr_expect_float_eq(d->fluid_mass[0], area, 1e-12);
  cr_expect_float_eq(d->inertia[0], density * area * radius * radius / 2, 1e-11);
  cr_expect_float_eq(d->fluid_inertia[0], area * radius * radius / 2, 1e-11);
  const double before = d->omega[0];
  advance(simulation, 1);
  cr_expect_float_eq(d->angle[0], 0.7 + d->omega[0], 1e-15, "turns by its new spin");
  cr_expect_float_eq(d->x[0], 20.3 + d->vx[0], 1e-14, "moves by its new velocity");
  cr_expect_float_eq(d->y[0], 30.7 + d->vy[0], 1e-14, "moves by its new velocity");
  cr_expect_neq(d->omega[0], before);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* Fluid at rest but for one cell. */
struct odd_cell {
  int x, y;
  struct flow_state state;
};

static struct flow_state but_for_one(const void *context, int x, int y)
{
  const struct odd_cell *odd = context;
  return x == odd->x && y == odd->y ? odd->state : (struct flow_state){.density = 1};
}

Test(stability, a_cell_that_is_not_finite_or_has_no_mass_is_named_wherever_it_is)
{
  static const struct odd_cell cells[] = {{0, 0, {.density = NAN}},
                                          {36, 129, {.density = 1, .velocity = {NAN, 0}}},
                                          {69, 100, {.density = 1, .velocity = {0, INFINITY}}},
                                          {5, 64, {.density = -0.5}},
                                          {68, 65, {.density = INFINITY}}};
  for (size_t k = 0; k < sizeof cells / sizeof cells[0]; k++)
    for (int threads = 1; threads <= 2; threads++) {
      struct scene scene = scene_box(70, 130, 0.1, SIDES_PERIODIC);
      struct status status;
      char expected[64];
      omp_set_num_threads(threads);
      struct simulation *simulation = start(&scene);
      simulation_start(simulation, but_for_one, &cells[k]);
      cr_expect_not(simulation_check(simulation, &status), "case %zu", k);
      snprintf(expected, sizeof expected, "cell (%d, %d) is no longer finite", cells[k].x, cells[k].y);
      cr_expect(strstr(status.message, expected), "%s, not %s", status.message, expected);
      simulation_destroy(simulation);
      scene_clear(&scene);
    }
}

Test(stability, a_free_disc_pushed_out_of_the_box_is_named_with_the_key_to_change)
{
  static const double gravity[SIDE_COUNT][2] = {{-3e-4, 0}, {3e-4, 0}, {0, -3e-4}, {0, 3e-4}};
  for (int side = 0; side < SIDE_COUNT; side++) {
    struct scene scene = scene_box(30, 30, 0.1, SIDES_CLOSED);
    struct status status;
    scene.contact.stiffness = 1e-9;
    scene_add_disc(&scene, 3, 20, 15, 15);
    memcpy(scene.particles.gravity, gravity[side], sizeof scene.particles.gravity);
    struct simulation *simulation = start(&scene);
    cr_assert_not(simulation_advance(simulation, 5000, &status));
    cr_expect(strstr(status.message, "disc 0 near") && strstr(status.message, "pushed out of the box") &&
                  strstr(status.message, "contact.stiffness, 1e-09"),
              "%s", status.message);
    simulation_destroy(simulation);
    scene_clear(&scene);
  }
}
