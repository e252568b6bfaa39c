/* Sub-grid lubrication: its coefficients and the forces of simulations against exact solutions; conservation, energy. */
#include "contact/lubrication.h"
#include "drive.h"
#include "film.h"
#include "rebound.h"
#include "scenes.h"

#include <criterion/criterion.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

static double exact_s(double gap, double inverse_a, double inverse_b)
{
  return acosh(1 + gap * (inverse_a + inverse_b) + gap * gap * inverse_a * inverse_b / 2);
}

Test(lubrication, closed_forms_are_exact_within_a_part_in_ten_thousand_at_small_gaps_and_one_per_cent_at_large_gaps)
{
  for (double s = 1e-3; s < 2; s *= 1.1) {
    const double tolerance = s < 1 ? 0.003 : 0.015, opening = 2 * (cosh(s) - 1);
    const double inverse_s2 = lubrication_inverse_s2(opening);
    cr_expect_float_eq(sqrt(inverse_s2) * s, 1, s < 0.5 ? 1e-4 : tolerance, "s = %g: %g", s, sqrt(inverse_s2) * s - 1);
    cr_expect_float_eq(lubrication_squeeze(inverse_s2) * (s - tanh(s)), 1, s < 0.5 ? 5e-4 : tolerance, "s = %g: %g", s,
                       lubrication_squeeze(inverse_s2) * (s - tanh(s)) - 1);
  }
}

Test(lubrication, force_of_approach_is_that_of_two_discs_of_any_radii_in_stokes_flow)
{
  static const double radius[][2] = {{5, 5}, {5, 10}, {3, 9}};
  for (int r = 0; r < 3; r++)
    for (double gap = 4; gap > 0.2; gap /= 3) {
      const struct two_discs discs = {.radius = {radius[r][0], radius[r][1]}, .gap = gap, .approach = 1};
      struct two_discs_force force;
      cr_assert(two_discs_force(&discs, &force));
      const double s = exact_s(gap, 1 / radius[r][0], 1 / radius[r][1]);
      cr_expect_float_eq(force.normal * (s - tanh(s)) / (4 * M_PI), 1, 1e-5, "radii %g %g, gap %g: %g", radius[r][0],
                         radius[r][1], gap, force.normal);
    }
}

/* Slip and entrainment speeds of discs that slide or spin, and the forces of the coefficients. */
static struct two_discs_force leading_force(const struct two_discs *d)
{
  const double ra = d->radius[0], rb = d->radius[1], distance = ra + rb + d->gap;
  const double arm_a = (distance + (ra - rb) * (ra + rb) / distance) / 2, arm_b = distance - arm_a;
  const double turning = -d->slide / distance, a = (d->spin[0] - turning) * arm_a, b = (d->spin[1] - turning) * arm_b;
  const double shear = 2 * M_PI / exact_s(d->gap, 1 / ra, 1 / rb), slip = shear * (a + b),
               entrained = 4 * shear * (a - b) / 2;
  return (struct two_discs_force){
      .tangential = slip + entrained * (arm_a - arm_b) / (2 * distance),
      .torque = {slip * arm_a + entrained * arm_a / 2, slip * arm_b - entrained * arm_b / 2}};
}

/* The part of a force that grows as the gap closes; the rest of order s grows by up to 5 % of it. */
Test(lubrication, growth_of_forces_of_slip_and_entrainment_is_that_of_two_discs_in_stokes_flow)
{
  static const double motion[][3] = {{1, 0, 0}, {0, 0.2, 0}, {0, 0, 0.2}, {0, 0.2, -0.2}}; /* slide, spins */
  for (int rb = 5; rb <= 10; rb += 5)
    for (int m = 0; m < 4; m++) {
      struct two_discs discs = {
          .radius = {5, rb}, .gap = 0.2, .slide = motion[m][0], .spin = {motion[m][1], motion[m][2]}};
      struct two_discs_force near, far;
      cr_assert(two_discs_force(&discs, &near));
      const struct two_discs_force leading_near = leading_force(&discs);
      discs.gap = 0.8;
      cr_assert(two_discs_force(&discs, &far));
      const struct two_discs_force leading_far = leading_force(&discs);
      const double force = near.tangential - far.tangential, torque = near.torque[0] - far.torque[0];
      const double scale = 2 * M_PI / exact_s(0.2, 0.2, 1.0 / rb); /* of the force at a slip speed of 1 */
      cr_expect_float_eq(leading_near.tangential - leading_far.tangential, force, 0.06 * scale, "R %d, motion %d", rb,
                         m);
      cr_expect_float_eq(leading_near.torque[0] - leading_far.torque[0], torque, 5 * 0.06 * scale, "R %d, motion %d",
                         rb, m);
    }
}

static const struct lubrication usual = {.viscosity = 0.1, .cutoff = 2, .least_gap = 0.01};

Test(lubrication, vanishes_continuously_at_the_cut_off_and_in_contact_and_is_constant_below_the_least_gap)
{
  for (double inverse_b = 0; inverse_b < 0.3; inverse_b += 0.1) {
    const struct lubrication_coefficients end = lubrication_at(&usual, 2, 0.2, inverse_b),
                                          beyond = lubrication_at(&usual, 3, 0.2, inverse_b),
                                          before = lubrication_at(&usual, 1.999, 0.2, inverse_b),
                                          touch = lubrication_at(&usual, -1e-9, 0.2, inverse_b),
                                          least = lubrication_at(&usual, 0.01 / fmax(0.2, inverse_b), 0.2, inverse_b),
                                          below = lubrication_at(&usual, 1e-6, 0.2, inverse_b);
    cr_expect_eq(end.normal + end.slip + end.entrainment, 0);
    cr_expect_eq(beyond.normal + beyond.slip + beyond.entrainment, 0);
    cr_expect_lt(before.normal + before.slip + before.entrainment, 1e-3);
    cr_expect_eq(touch.normal + touch.slip + touch.entrainment, 0);
    cr_expect_eq(least.normal, below.normal);
    cr_expect_eq(least.slip, below.slip);
    cr_expect_eq(least.entrainment, below.entrainment);
    cr_expect_gt(least.normal, 100);
  }
}

Test(lubrication, grows_as_the_gap_closes)
{
  for (double inverse_b = 0; inverse_b < 0.3; inverse_b += 0.1)
    for (double gap = 2; gap > 0.02; gap *= 0.9) {
      const struct lubrication_coefficients far = lubrication_at(&usual, gap, 0.2, inverse_b),
                                            near = lubrication_at(&usual, 0.9 * gap, 0.2, inverse_b);
      cr_expect_geq(far.normal, 0);
      cr_expect_geq(near.normal, far.normal, "gap %g", gap);
      cr_expect_geq(near.slip, far.slip, "gap %g", gap);
      cr_expect_geq(near.entrainment, far.entrainment, "gap %g", gap);
    }
}

/* Mean error of a force over places; `worst` of the largest. */
static double mean_error(const struct film *film, enum film_motion motion, double *worst)
{
  static const double at[][3] = {{0.2, 0.5, 0.25}, {0.6, 0.1, 0.4}}; /* angle, offsets */
  const int count = isinf(film->radius[1]) ? 1 : 2;                  /* beside a wall places hardly count */
  double sum = 0;
  for (int k = 0; k < count; k++) {
    struct film here = *film;
    struct status status;
    double error, excess;
    here.angle = at[k][0];
    here.offset[0] = at[k][1];
    here.offset[1] = at[k][2];
    cr_assert(film_far(&here, motion, &excess, &status) && film_error(&here, motion, excess, &error, &status), "%s",
              status.message);
    sum += error / count;
    *worst = fmax(*worst, fabs(error));
  }
  return sum;
}

static void expect_within(const struct film *film, double tolerance)
{
  double worst = 0;
  for (enum film_motion m = 0; m < FILM_MOTIONS; m++) {
    if (m == FILM_ENTRAINMENT && isinf(film->radius[1])) continue;
    const double error = mean_error(film, m, &worst);
    cr_expect_lt(fabs(error), tolerance, "radii %g %g, motion %d, gap %g: %g, at worst %g", film->radius[0],
                 film->radius[1], m, film->gap, error, worst);
  }
}

Test(lubrication, forces_and_torques_at_a_wall_are_within_ten_per_cent_down_to_the_least_gap)
{
  struct film film = {.radius = {5, INFINITY}, .viscosity = 1.0 / 6, .cutoff = 2};
  static const double gaps[] = {2, 0.3, 0.05};
  for (int g = 0; g < 3; g++) {
    film.gap = gaps[g];
    expect_within(&film, 0.1);
  }
}

Test(lubrication, forces_and_torques_of_two_discs_are_within_ten_per_cent_at_the_least_gap)
{
  struct film film = {.radius = {5, 5}, .gap = 0.05, .viscosity = 1.0 / 6, .cutoff = 2};
  double worst = 0;
  expect_within(&film, 0.1);
  film.gap = 0.4;
  cr_expect_lt(fabs(mean_error(&film, FILM_APPROACH, &worst)), 0.1, "at worst %g", worst);
}

/* The exact torque is 0. */
Test(lubrication, a_disc_that_slides_along_a_wall_without_spin_has_less_torque_than_without_the_model)
{
  struct film film = {.radius = {5, INFINITY}, .gap = 0.05, .viscosity = 0.05};
  double without[2], with[2];
  struct status status;
  cr_assert(film_loads(&film, FILM_SLIDE, without, &status), "%s", status.message);
  film.cutoff = 2;
  cr_assert(film_loads(&film, FILM_SLIDE, with, &status), "%s", status.message);
  cr_expect_lt(fabs(with[1] / with[0]), 0.1, "%g", with[1] / with[0]);
  cr_expect_gt(fabs(without[1] / without[0]), 0.3, "%g", without[1] / without[0]);
}

/* Approach is independent of viscosity; at a large one the flow is soon steady. */
Test(lubrication, the_lattice_alone_resolves_less_than_a_fifth_of_the_force_at_the_least_gap_of_a_large_disc)
{
  struct film film = {.radius = {10, INFINITY}, .gap = 0.1, .viscosity = 0.5};
  double exact, without, with;
  struct status status;
  cr_assert(film_exact(&film, FILM_APPROACH, &exact) && film_force(&film, FILM_APPROACH, &without, &status));
  film.cutoff = 2;
  cr_assert(film_force(&film, FILM_APPROACH, &with, &status));
  cr_expect_lt(without / exact, 0.2);
  cr_expect_float_eq(with / exact, 1, 0.1, "%g", with / exact);
}

/* Two free discs of different size at a small gap, with velocities and spins of their own. */
static struct scene near_discs(double gap)
{
  struct scene scene = scene_box(60, 50, 0.1, SIDES_PERIODIC);
  struct disc_spec *disc = scene_add_disc(&scene, 5, 1.5, 58, 25.3);
  disc->velocity[0] = 0.01;
  disc->velocity[1] = 0.02;
  disc->spin = 0.003;
  disc = scene_add_disc(&scene, 7, 2, 58 + (12 + gap) * cos(0.4) - 60, 25.3 + (12 + gap) * sin(0.4));
  disc->velocity[0] = -0.02;
  disc->spin = 0.002;
  scene.contact.lubrication.cutoff = 2;
  return scene;
}

Test(lubrication, forces_on_both_discs_are_opposite_and_without_a_couple_and_take_energy)
{
  struct scene scene = near_discs(0.4);
  struct simulation *simulation = start(&scene);
  const struct discs *d = simulation_discs(simulation);
  double force = 0, torque = 0;
  for (int step = 0; step < 200; step++) {
    const double dx = nearest_image(d->x[1] - d->x[0], 60, true), dy = nearest_image(d->y[1] - d->y[0], 50, true);
    advance(simulation, 1);
    if (hypot(dx, dy) < 12) continue; /* in contact */
    const double fx = d->contact_fx[1], fy = d->contact_fy[1], size = hypot(fx, fy);
    double power = 0;
    for (int i = 0; i < 2; i++)
      power += d->contact_fx[i] * d->vx[i] + d->contact_fy[i] * d->vy[i] + d->contact_torque[i] * d->omega[i];
    cr_assert_float_eq(d->contact_fx[0] + fx, 0, 1e-12 * size);
    cr_assert_float_eq(d->contact_fy[0] + fy, 0, 1e-12 * size);
    cr_assert_float_eq(d->contact_torque[0] + d->contact_torque[1] + dx * fy - dy * fx, 0, 1e-11 * size, "step %d",
                       step);
    cr_assert_leq(power, 0, "step %d", step);
    force = fmax(force, size);
    torque = fmax(torque, fabs(d->contact_torque[0]));
  }
  cr_expect_gt(force, 1e-3, "%g", force);
  cr_expect_gt(torque, 1e-4, "%g", torque);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* A disc so heavy that it sinks in steady state, in little fluid motion: the speed is that of its weight over the exact
 * resistance. */
Test(lubrication, a_disc_sinks_on_a_wall_at_the_speed_of_the_exact_resistance)
{
  struct scene scene = scene_box(80, 60, 0.1, SIDES_CLOSED);
  scene.domain.side[SIDE_LEFT].type = scene.domain.side[SIDE_RIGHT].type = SIDE_PERIODIC;
  scene_add_disc(&scene, 5, 1.5, 40.2, 5.6);
  scene.particles.gravity[1] = -1e-4;
  scene.contact.lubrication.cutoff = 2;
  const double weight = 0.5 * M_PI * 25 * 1e-4;
  struct simulation *simulation = start(&scene);
  const struct discs *d = simulation_discs(simulation);
  int measured = 0;
  for (int k = 0; k < 60 && d->y[0] > 5.06; k++) {
    const double before = d->y[0];
    advance(simulation, 250);
    const double gap = (before + d->y[0]) / 2 - 5, s = acosh(1 + gap / 5);
    const double speed = weight * (s - tanh(s)) / (4 * M_PI * 0.1);
    if (k < 4) continue; /* start */
    cr_expect_float_eq((before - d->y[0]) / 250 / speed, 1, 0.1, "gap %g: %g", gap, (before - d->y[0]) / 250 / speed);
    measured++;
  }
  cr_expect_gt(measured, 5);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

Test(lubrication, rebound_falls_with_the_stokes_number_and_vanishes_at_small_ones)
{
  static const double viscosities[] = {0.01, 0.04, 0.12};
  double last = 0.97;
  for (int k = 0; k < 3; k++) {
    struct rebound with = {.density = 80, .viscosity = viscosities[k], .cutoff = 2}, without = with;
    struct status status;
    without.cutoff = 0;
    cr_assert(rebound_run(&with, &status) && rebound_run(&without, &status), "%s", status.message);
    cr_expect_lt(with.restitution, last - 0.1);
    cr_expect_lt(with.restitution, without.restitution - 0.05);
    last = with.restitution;
  }
  cr_expect_eq(last, 0);
}

/* Films that would stop a disc within a small part of a step, many to a disc: implicit by each contact alone, the impulses of all
 * contacts of a disc would add up to more than its speed. */
Test(lubrication, a_crowd_of_light_discs_in_stiff_films_sinks_quietly)
{
  struct scene scene = scene_box(100, 100, 5, SIDES_CLOSED);
  struct status status;
  scene.particles.gravity[1] = -1e-3;
  scene.particles.fill = (struct fill_spec){.present = true,
                                            .spacing = 8.2,
                                            .radius = 4,
                                            .density = 0.5,
                                            .jitter = 0.09,
                                            .region = {0, 0, 100, 100},
                                            .seed = 1};
  cr_assert(scene_fill(&scene, &status), "%s", status.message);
  scene.contact.lubrication.cutoff = 2;
  scene.contact.lubrication.least_gap = 0.001;
  struct simulation *simulation = start(&scene);
  struct simulation_report report;
  advance(simulation, 300);
  simulation_report(simulation, &report);
  cr_expect_lt(report.max_mach, 0.05, "%g", report.max_mach);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

Test(lubrication, has_the_same_bits_for_any_number_of_threads_and_any_search)
{
  struct scene crowd = scene_crowd(160, 160, 4, 8.5, 0.2);
  const size_t bytes = crowd.particles.count * sizeof(double);
  double *first = malloc(3 * bytes), *state = malloc(3 * bytes);
  crowd.contact.lubrication.cutoff = 2;
  crowd.contact.stiffness = 30;
  for (int k = 0; k < 4; k++) {
    omp_set_num_threads(1 + k % 3);
    crowd.contact.search = k > 1 ? SEARCH_LINKED_CELL : SEARCH_GRID;
    struct simulation *simulation = start(&crowd);
    advance(simulation, 40);
    const struct discs *d = simulation_discs(simulation);
    const double *const arrays[] = {d->x, d->omega, d->contact_torque};
    for (size_t a = 0; a < 3; a++) memcpy((k > 0 ? state : first) + a * crowd.particles.count, arrays[a], bytes);
    cr_expect(k == 0 || memcmp(first, state, 3 * bytes) == 0, "run %d", k);
    simulation_destroy(simulation);
  }
  free(first);
  free(state);
  scene_clear(&crowd);
}
