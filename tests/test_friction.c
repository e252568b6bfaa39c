/* Dry discs that slide, roll and rebound, against exact solutions and an independent integration of the same law. */
#include "contact/law.h"
#include "drive.h"
#include "scenes.h"
#include "solid/lens.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

static struct scene dry_box(int nx, int ny, enum sides sides)
{
  struct scene scene = scene_box(nx, ny, 0.1, sides);
  scene_dry(&scene);
  return scene;
}

/* Disc 0 of radius 6 and, unless `wall`, disc 1 of radius 9, about to touch; disc 0 approaches at the speed. */
static struct scene impact_scene(bool wall, double speed)
{
  struct scene scene = dry_box(200, 200, SIDES_CLOSED);
  const double gap = 5 * speed;
  scene_add_disc(&scene, 6, 2, wall ? 194 - gap : 60, 100)->velocity[0] = speed;
  if (!wall) scene_add_disc(&scene, 9, 3, 75 + gap, 100);
  return scene;
}

/* k_n for an overlap of this part of the smaller radius in an undamped impact. */
static double stiffness_for(const struct scene *scene, bool wall, double speed, double part)
{
  struct contact_law law = contact_law_of(scene);
  const double radius[2] = {6, wall ? INFINITY : 9}, a = 2 * M_PI * 36, b = 3 * M_PI * 81;
  law.k_n = 1;
  return 0.5 * (wall ? a : a * b / (a + b)) * speed * speed / contact_energy(&law, radius, 6 * part);
}

/* Advances until the discs have separated; the relative speed then. */
static double separation_speed(struct simulation *simulation, bool wall, double *max_overlap)
{
  const struct discs *d = simulation_discs(simulation);
  for (int k = 0; k < 10000; k++) {
    advance(simulation, 1);
    const double speed = d->vx[0] - (wall ? 0 : d->vx[1]);
    const double gap = wall ? 194 - d->x[0] : d->x[1] - d->x[0] - 15;
    if (speed < 0 && gap > 0) {
      struct simulation_report report;
      simulation_report(simulation, &report);
      *max_overlap = report.max_overlap;
      return -speed;
    }
  }
  cr_assert_fail("no separation");
  return NAN;
}

/* Of stiffness for 1 % of the radius at this speed, and of one stiffness, for 1 % at the largest speed. */
Test(restitution, that_is_asked_for_is_got_at_any_speed_by_every_law)
{
  static const double wanted[] = {0.2, 0.5, 0.9, 1}, speeds[] = {1e-4, 1e-3, 1e-2, 1e-1};
  for (unsigned n = 0; n < 3 * 4 * 4 * 2 * 2; n++) {
    const unsigned law = n % 3;
    const double e = wanted[n / 3 % 4], speed = speeds[n / 12 % 4];
    const bool wall = n / 48 % 2, one_stiffness = n / 96;
    struct scene scene = impact_scene(wall, speed);
    scene.contact.law = law;
    scene.contact.restitution = e;
    scene.contact.stiffness = stiffness_for(&scene, wall, one_stiffness ? speeds[3] : speed, 0.01);
    struct simulation *simulation = start(&scene);
    double overlap;
    const double got = separation_speed(simulation, wall, &overlap) / speed;
    cr_expect_float_eq(got, e, 0.01 * e, "law %u, speed %g, wall %d, one stiffness %d: %g in place of %g", law, speed,
                       wall, one_stiffness, got, e);
    simulation_destroy(simulation);
    scene_clear(&scene);
  }
}

Test(laws, overlap_and_hertz_have_the_same_force_within_1_percent_below_an_overlap_of_1_percent)
{
  for (double beta = 1; beta <= 5; beta++)
    for (double part = 0.001; part <= 0.01; part *= 2) {
      const double radius[2] = {5, 5 * beta};
      struct scene scene = {.contact = {.stiffness = 1, .law = SPRING_OVERLAP}};
      const struct contact_law area = contact_law_of(&scene);
      scene.contact.law = SPRING_HERTZ;
      const struct contact_law hertz = contact_law_of(&scene);
      const double ratio =
          contact_spring_at(&hertz, radius, 5 * part).force / contact_spring_at(&area, radius, 5 * part).force;
      cr_expect_float_eq(ratio, 1, 0.01, "beta %g, overlap %g R: %g", beta, part, ratio);
    }
}

/* What an observer measures of an impact. */
struct observed {
  double duration, overlap, force, separation;
};

/* Discs of radius 6 and 6 beta in a contact of some 2000 steps, hardly damped. */
static struct observed observe(enum contact_spring_law law, double beta, double stiffness, double speed)
{
  struct scene scene = dry_box(200, 100, SIDES_CLOSED);
  scene_add_disc(&scene, 6, 2, 60, 50)->velocity[0] = speed;
  scene_add_disc(&scene, 6 * beta, 3, 66 + 6 * beta + 5 * speed, 50);
  scene.contact.law = law;
  scene.contact.alpha = 0;
  scene.contact.damping = 0.05;
  scene.contact.stiffness = stiffness;
  struct simulation *simulation = start(&scene);
  const struct discs *d = simulation_discs(simulation);
  struct observed o = {0};
  bool acts = false;
  for (int k = 0; k < 10000 && (acts || o.duration == 0); k++) {
    advance(simulation, 1);
    acts = d->contact_fx[0] < 0;
    o.duration += acts;
    o.force = fmax(o.force, -d->contact_fx[0]);
  }
  struct simulation_report report;
  simulation_report(simulation, &report);
  o.overlap = report.max_overlap;
  o.separation = d->vx[1] - d->vx[0];
  simulation_destroy(simulation);
  scene_clear(&scene);
  return o;
}

/* By one stiffness, without a constant per pair. */
Test(laws, overlap_and_hertz_have_the_same_impact_within_1_percent_for_discs_of_any_ratio)
{
  const double speed = 1e-4;
  for (double beta = 1; beta <= 5; beta++) {
    struct scene scene = {.contact = {
                              .law = SPRING_HERTZ,
                          }};
    struct contact_law law = contact_law_of(&scene);
    const double a = 2 * M_PI * 36, b = 3 * M_PI * 36 * beta * beta, mass = a * b / (a + b);
    law.k_n = 1;
    const double stiffness = 0.5 * mass * speed * speed / contact_energy(&law, (const double[2]){6, 6 * beta}, 0.06);
    const struct observed hertz = observe(SPRING_HERTZ, beta, stiffness, speed);
    const struct observed area = observe(SPRING_OVERLAP, beta, stiffness, speed);
    cr_expect(hertz.overlap > 0.008 && hertz.overlap < 0.01, "beta %g: overlap %g", beta, hertz.overlap);
    cr_expect_gt(hertz.duration, 1000);
    cr_expect_float_eq(area.duration / hertz.duration, 1, 0.01, "beta %g: %g", beta, area.duration / hertz.duration);
    cr_expect_float_eq(area.overlap / hertz.overlap, 1, 0.01, "beta %g: %g", beta, area.overlap / hertz.overlap);
    cr_expect_float_eq(area.force / hertz.force, 1, 0.01, "beta %g: %g", beta, area.force / hertz.force);
    cr_expect_float_eq(area.separation / hertz.separation, 1, 0.01, "beta %g: %g", beta,
                       area.separation / hertz.separation);
  }
}

/* An impact as the law of METHOD.md, section 7, has it: body 0 is disc 0, body 1 is disc 1, or the wall x = 200 if its radius is
 * infinite, or a fixed disc if its mass is. */
struct impact {
  enum contact_spring_law law;
  double radius[2], mass[2];
  double stiffness, damping, friction, ratio; /* alpha k_n, eta_0, mu, tangential_ratio */
};

/* Place (x, y, angle), then velocity and spin, of body 0 and body 1, and the force of the tangential spring. */
enum { X, Y, ANGLE, VX, VY, SPIN, VALUES, SHEAR = 2 * VALUES, STATE };

struct force {
  double n[2], arm[2], depth, approach, slip; /* normal, arms of the contact point, speeds */
  double normal, tangential_stiffness, eta;   /* F_n, k_t, eta_t */
};

/* Area of the part of a disc beyond the chord at this distance from the centre. */
static double segment_area(double radius, double distance)
{
  return radius * radius * acos(distance / radius) - distance * sqrt(radius * radius - distance * distance);
}

static double spring_of(const struct impact *i, const double arm[2], double depth, double *slope)
{
  const double *r = i->radius, reduced = 1 / (1 / r[0] + 1 / r[1]), c = i->stiffness, h = 4. / 3 * sqrt(2 * reduced);
  const bool wall = isinf(r[1]);
  if (i->law == SPRING_HERTZ) {
    *slope = 1.5 * c * h * sqrt(depth);
    return c * h * depth * sqrt(depth);
  }
  if (i->law == SPRING_OVERLAP) {
    *slope = c * 2 * sqrt(fmax(0, r[0] * r[0] - arm[0] * arm[0]));
    return c * (segment_area(r[0], arm[0]) + (wall ? 0 : segment_area(r[1], arm[1])));
  }
  const double small = 0.01 * fmin(r[0], r[1]), d = r[0] + r[1] - small; /* c_1 */
  const double at = wall ? r[0] - small : (d * d + r[0] * r[0] - r[1] * r[1]) / (2 * d);
  *slope = c * 2 * sqrt(r[0] * r[0] - at * at);
  return *slope * depth;
}

static struct force force_of(const struct impact *i, const double s[])
{
  const double *r = i->radius, *b = s + VALUES;
  const bool wall = isinf(r[1]);
  const double dx = wall ? 200 - s[X] : b[X] - s[X], dy = wall ? 0 : b[Y] - s[Y], d = hypot(dx, dy);
  struct force f = {.n = {dx / d, dy / d}, .depth = wall ? r[0] - d : r[0] + r[1] - d};
  const double vx = s[VX] - b[VX], vy = s[VY] - b[VY], effective = 1 / (1 / i->mass[0] + 1 / i->mass[1]);
  double slope;
  f.arm[0] = wall ? d : (d * d + r[0] * r[0] - r[1] * r[1]) / (2 * d);
  f.arm[1] = wall ? 0 : d - f.arm[0];
  f.approach = vx * f.n[0] + vy * f.n[1];
  f.slip = f.n[0] * vy - f.n[1] * vx + f.arm[0] * s[SPIN] + f.arm[1] * b[SPIN];
  if (f.depth <= 0) return f;
  const double spring = spring_of(i, f.arm, f.depth, &slope), eta = 2 * i->damping * sqrt(effective * slope);
  f.normal = fmax(0, spring + eta * f.approach);
  f.tangential_stiffness = i->ratio * slope;
  f.eta = sqrt(i->ratio) * eta;
  return f;
}

static double limited(double value, double limit)
{
  return fmax(-limit, fmin(limit, value));
}

static int rates_of(double time, const double s[], double rate[], void *context)
{
  const struct impact *i = context;
  const struct force f = force_of(i, s);
  const double limit = i->friction * f.normal, along = limited(limited(s[SHEAR], limit) + f.eta * f.slip, limit);
  (void)time;
  for (int k = 0; k < 2; k++) {
    const double *body = s + k * VALUES, sign = k ? 1 : -1;
    double *of = rate + k * VALUES;
    of[X] = body[VX];
    of[Y] = body[VY];
    of[ANGLE] = body[SPIN];
    of[VX] = sign * (f.normal * f.n[0] - along * f.n[1]) / i->mass[k];
    of[VY] = sign * (f.normal * f.n[1] + along * f.n[0]) / i->mass[k];
    of[SPIN] = isinf(i->mass[k]) ? 0 : -f.arm[k] * along / (i->mass[k] * i->radius[k] * i->radius[k] / 2);
  }
  rate[SHEAR] = f.tangential_stiffness * f.slip;
  return GSL_SUCCESS;
}

/* Steps of 1/2500 of the contact until it ends, each by the Runge-Kutta method of fourth order; the limit of the tangential
 * spring, and its loss where its stiffness falls, between steps. */
static void integrate(const struct impact *i, double duration, double s[])
{
  struct impact constants = *i;
  gsl_odeiv2_system system = {rates_of, NULL, STATE, &constants};
  gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(gsl_odeiv2_step_rk4, STATE);
  const double h = duration / 2500;
  double error[STATE];
  struct force before = force_of(i, s);
  bool acted = false;
  for (int k = 0; k < 50000 && !(acted && before.normal <= 0); k++) {
    gsl_odeiv2_step_apply(step, k * h, h, s, error, NULL, NULL, &system);
    const struct force f = force_of(i, s);
    if (f.tangential_stiffness < before.tangential_stiffness)
      s[SHEAR] *= f.tangential_stiffness / before.tangential_stiffness;
    s[SHEAR] = limited(s[SHEAR], i->friction * f.normal);
    acted |= f.normal > 0;
    before = f;
  }
  gsl_odeiv2_step_free(step);
}

enum partner { FREE_DISC, FIXED_DISC, WALL, PARTNERS };

/* Disc 0 approaches its partner at the speed v along the normal and u along the surface, five steps before the contact. */
static struct scene oblique_scene(enum partner partner, double v, double u, double spin)
{
  struct scene scene = dry_box(200, 200, SIDES_CLOSED);
  const double angle = partner == WALL ? 0 : 0.6, nx = cos(angle), ny = sin(angle);
  struct disc_spec *disc = scene_add_disc(&scene, 6, 2, partner == WALL ? 194 - 5 * v : 80, 80);
  disc->velocity[0] = nx * v - ny * u;
  disc->velocity[1] = ny * v + nx * u;
  disc->spin = spin;
  if (partner == WALL) return scene;
  struct disc_spec *other = scene_add_disc(&scene, 9, 3, 80 + nx * (15 + 5 * v), 80 + ny * (15 + 5 * v));
  if (partner == FIXED_DISC) {
    other->motion = DISC_FIXED;
    return scene;
  }
  other->spin = 0.15 * v;
  for (int k = 0; k < 2; k++) {
    const double drift = k ? -0.5 * v : 0.75 * v;
    disc->velocity[k] += drift;
    other->velocity[k] = drift;
  }
  return scene;
}

/* The places when the bodies touch. */
static void touch(const struct scene *scene, double s[])
{
  const struct disc_spec *discs = scene->particles.discs;
  const bool wall = scene->particles.count == 1;
  memset(s, 0, STATE * sizeof *s);
  for (size_t k = 0; k < scene->particles.count; k++)
    for (int axis = 0; axis < 2; axis++) {
      s[k * VALUES + X + (size_t)axis] = discs[k].position[axis];
      s[k * VALUES + VX + (size_t)axis] = discs[k].velocity[axis];
      s[k * VALUES + SPIN] = discs[k].spin;
    }
  const double dx = s[VALUES + X] - s[X], dy = s[VALUES + Y] - s[Y], vx = s[VX] - s[VALUES + VX],
               vy = s[VY] - s[VALUES + VY];
  const double a = vx * vx + vy * vy, b = dx * vx + dy * vy, c = dx * dx + dy * dy - 15 * 15;
  const double time = wall ? (194 - s[X]) / vx : (b - sqrt(b * b - a * c)) / a;
  for (int k = 0; k < 2; k++)
    for (int axis = 0; axis < 2; axis++) s[k * VALUES + X + axis] += time * s[k * VALUES + VX + axis];
}

/* Case n of friction and restitution: the largest error of a velocity or of radius times spin, over the initial speed. */
static double oblique_error(enum partner partner, double v, double u, double spin, int n, double steps)
{
  static const double wanted[] = {0.6, 0.9, 1};
  struct scene scene = oblique_scene(partner, v, u, spin);
  scene.contact.law = n % 3;
  scene.contact.steps_per_contact = steps;
  scene.contact.restitution = wanted[n / 3 % 3];
  scene.contact.friction = n % 2 ? 0.1 : 0.5;
  scene.contact.alpha = n % 4 ? 0.3 : 0;
  scene.contact.stiffness = stiffness_for(&scene, partner == WALL, v, 0.01);
  const struct contact_law law = contact_law_of(&scene);
  const double rb = partner == WALL ? INFINITY : 9, beta = 6 / rb;
  const double alpha = n % 4 ? 0.3 : 4 * M_SQRT2 / (3 * M_PI) * (1 + beta * beta) / ((1 + beta) * (1 + beta));
  const struct impact impact = {.law = scene.contact.law,
                                .radius = {6, rb},
                                .mass = {2 * M_PI * 36, partner == FREE_DISC ? 3 * M_PI * 81 : INFINITY},
                                .stiffness = alpha * scene.contact.stiffness,
                                .damping = law.damping,
                                .friction = scene.contact.friction,
                                .ratio = scene.contact.tangential_ratio};
  double s[STATE], error = 0;
  touch(&scene, s);
  integrate(&impact, 3 * 0.06 / v, s);
  struct simulation *simulation = start(&scene);
  const struct discs *d = simulation_discs(simulation);
  bool acted = false, acts = false;
  for (int k = 0; k < 1000 && (!acted || acts); k++) {
    advance(simulation, 1);
    acts = d->contact_fx[0] != 0;
    acted |= acts;
  }
  for (size_t k = 0; k < d->count; k++) {
    error = fmax(error, fabs(d->vx[k] - s[k * VALUES + VX]));
    error = fmax(error, fabs(d->vy[k] - s[k * VALUES + VY]));
    error = fmax(error, impact.radius[k] * fabs(d->omega[k] - s[k * VALUES + SPIN]));
  }
  simulation_destroy(simulation);
  scene_clear(&scene);
  return error / hypot(v, u);
}

/* With the sub-steps of the default, and closer with more of them: the limit is the law. */
Test(friction, of_an_oblique_impact_is_that_of_an_independent_integration)
{
  static const double slopes[] = {0.2, 1, 4}, spins[] = {0, 0.2, -0.4}, steps[] = {20, 200}, bars[] = {0.02, 0.0025};
  const double v = 0.02;
  for (int n = 0; n < 54 * 2; n++)
    for (enum partner partner = 0; partner < PARTNERS; partner++) {
      const double slope = slopes[n / 18 % 3], spin = spins[(n / 6 + n / 18) % 3];
      const int kind = n % 18, fine = n / 54;
      const double error = oblique_error(partner, v, slope * v, spin * v, kind, steps[fine]);
      cr_expect_lt(error, bars[fine], "partner %d, slip %g v, spin %g v, case %d, %g steps: %g", partner, slope, spin,
                   kind, steps[fine], error);
    }
}

/* A disc on the floor, at the overlap at rest. */
static struct scene floor_scene(const double gravity[2], double mu)
{
  struct scene scene = dry_box(600, 40, SIDES_CLOSED);
  scene.domain.side[SIDE_LEFT].type = scene.domain.side[SIDE_RIGHT].type = SIDE_PERIODIC;
  for (int axis = 0; axis < 2; axis++) scene.particles.gravity[axis] = gravity[axis];
  scene.contact.law = SPRING_LINEAR;
  scene.contact.friction = mu;
  scene.contact.stiffness = 1000;
  const struct contact_law law = contact_law_of(&scene);
  const double weight = 2 * M_PI * 100 * -gravity[1];
  const double overlap = weight / contact_spring_at(&law, (const double[2]){10, INFINITY}, 1e-3).stiffness;
  scene_add_disc(&scene, 10, 2, 100, 10 - overlap);
  return scene;
}

/* Each impulse of the floor changes the velocity by dv and the spin by 2 dv/R, so that the angle is twice the delay over R at
 * any time. The angle is thus integrated over the sub-steps, as the position is. */
Test(friction, a_sliding_disc_turns_by_twice_its_delay_over_its_radius)
{
  const double v0 = 0.05, start_x = 100;
  const int steps = 100;
  struct scene scene = floor_scene((const double[2]){0, -1e-4}, 0.3);
  scene.particles.discs[0].velocity[0] = v0;
  struct simulation *simulation = start(&scene);
  const struct discs *d = simulation_discs(simulation);
  advance(simulation, steps);
  struct simulation_report report;
  simulation_report(simulation, &report);
  cr_assert_gt(report.max_substeps, 4);
  const double delay = start_x + v0 * steps - d->x[0];
  cr_expect_float_eq(fabs(d->angle[0]), 2 * delay / 10, 0.002 * delay / 5, "%g, not %g", d->angle[0], delay / 5);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* Sliding at the speed v0 relative to the floor, without spin, a disc rolls after v0/(3 mu g), at 2/3 of v0. */
Test(friction, a_disc_thrown_along_a_floor_rolls_after_v0_over_3_mu_g)
{
  const double mu = 0.3, g = 1e-4, v0 = 0.1;
  for (int moving = 0; moving < 2; moving++) {
    const double wall = moving ? -0.05 : 0, exact = v0 / (3 * mu * g);
    struct scene scene = floor_scene((const double[2]){0, -g}, mu);
    scene.domain.side[SIDE_BOTTOM].velocity[0] = wall;
    scene.particles.discs[0].velocity[0] = v0 + wall;
    struct simulation *simulation = start(&scene);
    const struct discs *d = simulation_discs(simulation);
    int steps = 0;
    while (d->vx[0] - wall + 10 * d->omega[0] > 1e-3 * v0 && steps < 3000) advance(simulation, 1), steps++;
    cr_expect_float_eq(steps, exact, 0.01 * exact, "wall %g: rolls after %d steps, not %g", wall, steps, exact);
    advance(simulation, 200);
    cr_expect_float_eq(d->vx[0] - wall, v0 * 2 / 3, 0.01 * v0 * 2 / 3, "wall %g: %g", wall, d->vx[0] - wall);
    simulation_destroy(simulation);
    scene_clear(&scene);
  }
}

/* A floor tilted by tan = part mu; rolling is excluded. By resolved sub-steps, and by one and four. */
Test(friction, discs_that_cannot_roll_slip_from_the_slope_mu_on)
{
  static const double parts[] = {0.9, 0.99, 1.01, 1.5};
  static const int substeps[] = {0, 1, 4};
  const double mu = 0.4, g = 1e-4;
  for (int n = 0; n < 4 * 3; n++) {
    const double part = parts[n % 4], along = part * mu * g, wanted = fmax(0, along - mu * g);
    struct scene scene = floor_scene((const double[2]){along, -g}, mu);
    scene.contact.rolling_friction = 5;
    scene.contact.substeps = substeps[n / 4];
    struct simulation *simulation = start(&scene);
    const struct discs *d = simulation_discs(simulation);
    advance(simulation, 500);
    const double before = d->vx[0];
    advance(simulation, 1000);
    const double acceleration = (d->vx[0] - before) / 1000;
    cr_expect_float_eq(acceleration, wanted, 0.01 * wanted + 1e-4 * along, "slope %g mu, %d sub-steps: %g, not %g",
                       part, substeps[n / 4], acceleration, wanted);
    cr_expect(fabs(d->omega[0]) < 1e-3 * mu * g * 1500 / 10, "slope %g mu: spin %g", part, d->omega[0]);
    simulation_destroy(simulation);
    scene_clear(&scene);
  }
}

/* A crowd of unequal discs in random motion, with friction and rolling friction. */
static struct scene rough_crowd(enum sides sides, double stiffness)
{
  struct scene scene = dry_box(120, 120, sides);
  gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
  for (int k = 0; k < 36; k++) {
    struct disc_spec *disc =
        scene_add_disc(&scene, 6 + 3 * gsl_rng_uniform(random), 2, 10 + 20 * (k % 6), 10 + 20 * (double)(k / 6));
    for (int axis = 0; axis < 2; axis++) disc->velocity[axis] = 0.1 * (gsl_rng_uniform(random) - 0.5);
    disc->spin = 0.01 * (gsl_rng_uniform(random) - 0.5);
  }
  gsl_rng_free(random);
  scene.contact.stiffness = stiffness;
  scene.contact.friction = 0.5;
  scene.contact.rolling_friction = 0.1;
  return scene;
}

static double kinetic_energy(const struct discs *d)
{
  double sum = 0;
  for (size_t i = 0; i < d->count; i++)
    sum += d->mass[i] * (d->vx[i] * d->vx[i] + d->vy[i] * d->vy[i]) + d->inertia[i] * d->omega[i] * d->omega[i];
  return sum / 2;
}

/* Kinetic energy above that of the start would be a gain, since no energy is stored at the start. */
Test(energy, is_never_gained_over_eight_decades_of_stiffness_with_friction)
{
  static const int substeps[] = {0, 1, 4};
  for (int n = 0; n < 9 * 3 * 2; n++) {
    const double stiffness = pow(10, n % 9 - 2);
    struct scene scene = rough_crowd(n / 27 ? SIDES_CLOSED : SIDES_PERIODIC, stiffness);
    scene.contact.substeps = substeps[n / 9 % 3];
    scene.contact.damping = n % 2 ? 0 : 0.05;
    struct simulation *simulation = start(&scene);
    const struct discs *d = simulation_discs(simulation);
    const double first = kinetic_energy(d);
    double most = 0;
    for (int k = 0; k < 40; k++) {
      advance(simulation, 10);
      most = fmax(most, kinetic_energy(d));
    }
    cr_expect(most <= first * (1 + 1e-3), "stiffness %g, %d sub-steps: %g times", stiffness, scene.contact.substeps,
              most / first);
    simulation_destroy(simulation);
    scene_clear(&scene);
  }
}

/* An impact of one pair ends without stored energy. By stiffness over eight decades, and where a contact lasts a few sub-steps. */
Test(energy, is_never_gained_in_an_oblique_impact_however_few_the_sub_steps)
{
  static const double frictions[] = {0.5, 2, 10}, rolling[] = {0, 0.1, 1, 5}, ratios[] = {0.3, 0.8};
  static const int substeps[] = {1, 4, 1, 4, 0};
  gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
  for (int n = 0; n < 3000; n++) {
    const double v = 0.03 * gsl_rng_uniform(random) + 0.002, u = 0.1 * (gsl_rng_uniform(random) - 0.5);
    struct scene scene = oblique_scene((enum partner)gsl_rng_uniform_int(random, PARTNERS), v, u,
                                       0.02 * (gsl_rng_uniform(random) - 0.5));
    scene.particles.discs[0].position[0] += 4 * v * gsl_rng_uniform(random);
    scene.contact.substeps = substeps[n % 5];
    const bool any = n % 5 == 4 || n % 10 == 0;
    scene.contact.stiffness = any ? pow(10, 8 * gsl_rng_uniform(random) - 2)
                                  : pow(10, 1.5 + 2.5 * gsl_rng_uniform(random)) * (n % 5 % 2 ? 16 : 1);
    scene.contact.law = (unsigned)gsl_rng_uniform_int(random, 3);
    scene.contact.damping = n % 7 == 0 ? 0.05 : 0;
    scene.contact.friction = frictions[gsl_rng_uniform_int(random, 3)];
    scene.contact.rolling_friction = rolling[gsl_rng_uniform_int(random, 4)];
    scene.contact.tangential_ratio = ratios[gsl_rng_uniform_int(random, 2)];
    struct simulation *simulation = start(&scene);
    const struct discs *d = simulation_discs(simulation);
    const double first = kinetic_energy(d);
    double max = 0;
    for (int k = 0; k < 8 || (k < 100 && d->contact_fx[0] != 0); k++) {
      advance(simulation, 1);
      max = fmax(max, kinetic_energy(d));
    }
    cr_expect(max <= first * (1 + 1e-12), "case %d, stiffness %g, %d sub-steps: %.15g times", n,
              scene.contact.stiffness, scene.contact.substeps, max / first);
    simulation_destroy(simulation);
    scene_clear(&scene);
  }
  gsl_rng_free(random);
}

static void momenta(const struct discs *d, double sum[3])
{
  memset(sum, 0, 3 * sizeof *sum);
  for (size_t i = 0; i < d->count; i++) {
    sum[0] += d->mass[i] * d->vx[i];
    sum[1] += d->mass[i] * d->vy[i];
    sum[2] += d->mass[i] * (d->x[i] * d->vy[i] - d->y[i] * d->vx[i]) + d->inertia[i] * d->omega[i];
  }
}

/* Collisions leave the first `components` of the momenta as they are. */
static void check_momenta(const struct scene *scene, int components)
{
  struct simulation *simulation = start(scene);
  const struct discs *d = simulation_discs(simulation);
  double before[3], after[3], scale = 0;
  momenta(d, before);
  const double energy = kinetic_energy(d);
  for (size_t i = 0; i < d->count; i++) scale += d->mass[i] * hypot(d->vx[i], d->vy[i]);
  advance(simulation, 1500);
  momenta(d, after);
  cr_expect_lt(kinetic_energy(d), 0.8 * energy, "no collisions");
  for (int k = 0; k < components; k++)
    cr_expect_float_eq(after[k], before[k], 1e-13 * scale * (k == 2 ? 400 : 1), "component %d: %g of %g", k,
                       after[k] - before[k], scale);
  simulation_destroy(simulation);
}

/* A crowd that collapses on its centre, far from all sides. */
Test(friction, keeps_momentum_and_angular_momentum_of_a_crowd_to_round_off)
{
  struct scene scene = dry_box(400, 400, SIDES_CLOSED);
  for (int k = 0; k < 36; k++) {
    const double x = 18.0 * (k % 6) - 45, y = 18.0 * (double)(k / 6) - 45;
    struct disc_spec *disc = scene_add_disc(&scene, 5 + k % 4, 1 + k % 3, 200 + x, 200 + y);
    disc->velocity[0] = -0.001 * x - 0.0004 * y;
    disc->velocity[1] = -0.001 * y + 0.0004 * x;
    disc->spin = 0.002 * (k % 5 - 2);
  }
  scene.contact.stiffness = 50;
  scene.contact.friction = 0.5;
  scene.contact.rolling_friction = 0.1;
  check_momenta(&scene, 3);
  scene_clear(&scene);
}

Test(friction, keeps_the_momentum_of_a_periodic_crowd_to_round_off)
{
  struct scene scene = rough_crowd(SIDES_PERIODIC, 50);
  check_momenta(&scene, 2);
  scene_clear(&scene);
}

/* Discs in four layers that slide over each other on a floor, periodic in x; all shifted by `shift`. */
static struct scene pile_scene(int columns, double shift)
{
  const int width = 20 * columns + 20;
  struct scene scene = dry_box(width, 120, SIDES_CLOSED);
  scene.domain.side[SIDE_LEFT].type = scene.domain.side[SIDE_RIGHT].type = SIDE_PERIODIC;
  scene.particles.gravity[0] = 2e-5;
  scene.particles.gravity[1] = -1e-4;
  for (int k = 0; k < 4 * columns; k++) {
    const int layer = k / columns;
    const double x = fmod(12 + 20.0 * (k % columns) + (layer % 2 ? 9.5 : 0) + shift, width);
    scene_add_disc(&scene, 7 + k % 3, 2, x, 11 + 18.0 * layer);
  }
  scene.contact.stiffness = 100;
  scene.contact.friction = 0.4;
  scene.contact.rolling_friction = 0.05;
  return scene;
}

Test(friction, crosses_periodic_sides)
{
  struct scene scene[2] = {pile_scene(7, 0), pile_scene(7, 96)};
  struct simulation *simulation[2] = {start(&scene[0]), start(&scene[1])};
  for (int k = 0; k < 2; k++) advance(simulation[k], 400);
  const struct discs *a = simulation_discs(simulation[0]), *b = simulation_discs(simulation[1]);
  double moved = 0;
  for (size_t i = 0; i < a->count; i++) {
    const double dx = b->x[i] - a->x[i];
    cr_expect_float_eq(dx, dx > 0 ? 96 : -64, 1e-9, "disc %zu: %g", i, dx);
    cr_expect_float_eq(b->y[i], a->y[i], 1e-9);
    cr_expect_float_eq(b->omega[i], a->omega[i], 1e-11);
    moved = fmax(moved, fabs(a->omega[i]));
  }
  cr_expect_gt(moved, 1e-4, "nothing turns");
  for (int k = 0; k < 2; k++) {
    simulation_destroy(simulation[k]);
    scene_clear(&scene[k]);
  }
}

enum { ROOM = 1 << 20 };

/* Saves or restores a state; its size, without the times, which are its end. */
static size_t pass_state(struct simulation *s, char *bytes, bool saving)
{
  struct status status;
  struct store store = {.stream = fmemopen(bytes, ROOM, saving ? "wb" : "rb"), .path = "memory", .saving = saving};
  cr_assert(saving ? simulation_save(s, &store, &status) : simulation_restore(s, &store, &status), "%s",
            status.message);
  const long size = ftell(store.stream);
  fclose(store.stream);
  return (size_t)size - sizeof(struct stage_times);
}

/* By all bytes of a checkpoint, with the springs of friction in it; threads share the work of 200 discs. */
Test(friction, survives_a_restart_and_any_number_of_threads_bit_for_bit)
{
  char *middle = malloc(ROOM), *end[2] = {malloc(ROOM), malloc(ROOM)};
  struct scene scene = pile_scene(50, 0);
  size_t size = 0;
  for (int threads = 1; threads <= 3; threads++) {
    struct simulation_report report;
    omp_set_num_threads(threads);
    struct simulation *simulation = start(&scene);
    advance(simulation, 230);
    if (threads == 1) pass_state(simulation, middle, true);
    if (threads > 1) pass_state(simulation, middle, false);
    advance(simulation, 300);
    simulation_report(simulation, &report);
    cr_expect_eq(report.threads, threads);
    const size_t got = pass_state(simulation, end[threads > 1], true);
    if (threads == 1) size = got;
    cr_expect(got == size && memcmp(end[0], end[threads > 1], size) == 0, "%d threads", threads);
    simulation_destroy(simulation);
  }
  scene_clear(&scene);
  for (int k = 0; k < 2; k++) free(end[k]);
  free(middle);
}

/* In fluid, where the painted rows can be searched. */
Test(friction, has_the_same_bits_by_either_search)
{
  struct scene scene = pile_scene(7, 0);
  struct simulation *simulation[2];
  scene.fluid.none = false;
  for (int k = 0; k < 2; k++) {
    scene.contact.search = k ? SEARCH_LINKED_CELL : SEARCH_GRID;
    simulation[k] = start(&scene);
    advance(simulation[k], 300);
  }
  const struct discs *a = simulation_discs(simulation[0]), *b = simulation_discs(simulation[1]);
  const size_t size = a->count * sizeof(double);
  cr_expect(memcmp(a->x, b->x, size) == 0 && memcmp(a->omega, b->omega, size) == 0);
  for (int k = 0; k < 2; k++) simulation_destroy(simulation[k]);
  scene_clear(&scene);
}

Test(friction, lets_a_pile_come_to_rest)
{
  static const int substeps[] = {0, 1, 4};
  for (int n = 0; n < 3; n++) {
    struct scene scene = pile_scene(7, 0);
    scene.particles.gravity[0] = 0;
    scene.domain.side[SIDE_LEFT].type = scene.domain.side[SIDE_RIGHT].type = SIDE_WALL;
    scene.contact.substeps = substeps[n];
    struct simulation *simulation = start(&scene);
    const struct discs *d = simulation_discs(simulation);
    double max = 0;
    for (int k = 0; k < 250; k++) {
      advance(simulation, 100);
      max = fmax(max, kinetic_energy(d));
    }
    cr_expect(kinetic_energy(d) < 1e-12 * max, "%d sub-steps: %g of %g", substeps[n], kinetic_energy(d), max);
    simulation_destroy(simulation);
    scene_clear(&scene);
  }
}
