/* Damping ratio for a coefficient of restitution, against the law's own integration, published numbers and closed forms. */
#include "contact/restitution.h"

#include <criterion/criterion.h>
#include <math.h>

/* Spring force k x^p with the damper 2 eta_0 sqrt(m dF/dx), and the speed of approach. */
struct impact {
  double mass, stiffness, exponent, damping, speed;
};

static double force_of(const struct impact *i, double overlap, double speed)
{
  const double slope = i->stiffness * i->exponent * pow(overlap, i->exponent - 1);
  return i->stiffness * pow(overlap, i->exponent) + 2 * i->damping * sqrt(i->mass * slope) * speed;
}

/* One step of the fourth-order Runge-Kutta method for overlap and approach speed. */
static void advance(const struct impact *i, double h, double state[2])
{
  static const double weight[4] = {1, 2, 2, 1}, part[4] = {0, 0.5, 0.5, 1};
  double rate[2] = {0, 0}, sum[2] = {0, 0};
  for (int k = 0; k < 4; k++) {
    const double x = fmax(0, state[0] + part[k] * h * rate[0]), v = state[1] + part[k] * h * rate[1];
    rate[0] = v;
    rate[1] = -force_of(i, x, v) / i->mass;
    for (int c = 0; c < 2; c++) sum[c] += weight[k] / 6 * h * rate[c];
  }
  for (int c = 0; c < 2; c++) state[c] += sum[c];
}

/* Separation speed over approach speed. Steps grow with the overlap at first, since x^(1/4) is not smooth at 0. */
static double restitution_of(const struct impact *i)
{
  const double energy = 0.5 * i->mass * i->speed * i->speed;
  const double depth = pow((i->exponent + 1) * energy / i->stiffness, 1 / (i->exponent + 1));
  double state[2] = {1e-12 * depth, i->speed};
  while (force_of(i, fmax(0, state[0]), state[1]) > 0)
    advance(i, fmin(2e-3 * depth, 1e-2 * fabs(state[0])) / i->speed, state);
  return -state[1] / i->speed;
}

Test(restitution, asked_for_is_that_of_an_impact_for_linear_springs_and_hertz_at_any_mass_stiffness_and_speed)
{
  static const struct impact impacts[] = {{.mass = 1, .stiffness = 1, .exponent = 1, .speed = 1},
                                          {.mass = 40, .stiffness = 0.3, .exponent = 1, .speed = 0.01},
                                          {.mass = 1, .stiffness = 1, .exponent = 1.5, .speed = 1},
                                          {.mass = 40, .stiffness = 0.3, .exponent = 1.5, .speed = 0.01},
                                          {.mass = 0.2, .stiffness = 7, .exponent = 1.5, .speed = 10}};
  static const double wanted[] = {0.15, 0.3, 0.5, 0.8, 0.95, 0.999};
  for (size_t k = 0; k < sizeof impacts / sizeof impacts[0]; k++)
    for (size_t n = 0; n < sizeof wanted / sizeof wanted[0]; n++) {
      struct impact impact = impacts[k];
      impact.damping = restitution_damping(wanted[n], impact.exponent);
      cr_expect_float_eq(restitution_of(&impact), wanted[n], 1e-6, "impact %zu: %.9g in place of %g", k,
                         restitution_of(&impact), wanted[n]);
    }
}

Test(restitution, of_a_linear_spring_needs_the_damping_of_the_reference)
{
  /* zeta, restitution if the contact ends at no force: Schwager & Poeschel 2007, six digits */
  static const double rows[][2] = {{0.01, 0.969265}, {0.02, 0.939841}, {0.05, 0.858758}, {0.1, 0.744079},
                                   {0.2, 0.571740},  {0.3, 0.450975},  {0.34, 0.412731}, {0.4, 0.363527},
                                   {0.5, 0.298436},  {0.6, 0.248841},  {0.7, 0.210285},  {0.8, 0.179783},
                                   {0.9, 0.155283}};
  for (size_t k = 0; k < sizeof rows / sizeof rows[0]; k++)
    cr_expect_float_eq(restitution_damping(rows[k][1], 1), rows[k][0], 5e-6, "restitution %g", rows[k][1]);
}

/* e = exp(-zeta (pi - phi)/sqrt(1 - zeta^2)), phi the argument of 1 - 2 zeta^2 + 2 i zeta sqrt(1 - zeta^2). */
Test(restitution, of_a_linear_spring_is_the_closed_form_to_round_off)
{
  for (double wanted = 0.15; wanted < 1; wanted += 0.05) {
    const double zeta = restitution_damping(wanted, 1), root = sqrt(1 - zeta * zeta);
    const double phase = M_PI - atan2(2 * zeta * root, 1 - 2 * zeta * zeta);
    cr_expect_float_eq(exp(-zeta * phase / root), wanted, 1e-14);
  }
}

Test(restitution, damping_falls_as_it_rises_and_is_none_without_loss)
{
  for (int law = 0; law < 2; law++) {
    const double exponent = law ? 1.5 : 1;
    double last = INFINITY;
    for (int k = 150; k <= 1000; k++) {
      const double damping = restitution_damping(k / 1000.0, exponent);
      cr_expect(damping < last && damping >= 0, "exponent %g, restitution %g: %g", exponent, k / 1000.0, damping);
      last = damping;
    }
    cr_expect_eq(last, 0);
    cr_expect(restitution_damping(restitution_min, exponent) < 1);
    cr_expect_eq(restitution_damping(restitution_max, exponent), 0);
  }
}
