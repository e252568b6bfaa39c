/* Coefficients of sub-grid lubrication against exact solutions. */
#include "contact/lubrication.h"
#include "two_discs.h"

#include <criterion/criterion.h>
#include <math.h>

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
