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

Test(restitution, that_is_asked_for_is_got_at_any_speed_by_every_law)
{
  static const double wanted[] = {0.2, 0.5, 0.9, 1}, speeds[] = {1e-4, 1e-3, 1e-2, 1e-1};
  for (unsigned n = 0; n < 3 * 4 * 4 * 2; n++) {
    const unsigned law = n % 3;
    const double e = wanted[n / 3 % 4], speed = speeds[n / 12 % 4];
    const bool wall = n / 48;
    struct scene scene = impact_scene(wall, speed);
    scene.contact.law = law;
    scene.contact.restitution = e;
    scene.contact.stiffness = stiffness_for(&scene, wall, speed, 0.01);
    struct simulation *simulation = start(&scene);
    double overlap;
    const double got = separation_speed(simulation, wall, &overlap) / speed;
    cr_expect_float_eq(got, e, 0.01 * e, "law %u, speed %g, wall %d: %g in place of %g", law, speed, wall, got, e);
    simulation_destroy(simulation);
    scene_clear(&scene);
  }
}

/* Force at equal overlap, and one impact at equal stiffness. */
Test(laws, overlap_and_hertz_agree_within_1_percent_below_an_overlap_of_1_percent)
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
  double speed[2], overlap[2];
  for (unsigned law = 0; law < 2; law++) {
    struct scene scene = impact_scene(false, 0.05);
    scene.contact.law = law;
    scene.contact.alpha = 0;
    scene.contact.stiffness = 800;
    struct simulation *simulation = start(&scene);
    speed[law] = separation_speed(simulation, false, &overlap[law]);
    simulation_destroy(simulation);
    scene_clear(&scene);
  }
  cr_expect_lt(overlap[0], 0.011);
  cr_expect_float_eq(speed[1] / speed[0], 1, 0.01);
  cr_expect_float_eq(overlap[1] / overlap[0], 1, 0.01);
}

/* A disc on a wall at x = 0 that lies on its left, in the variables x, v (along the normal), u (slip speed of the contact
 * point, along t), F (tangential spring), omega; the law as in METHOD.md, hertz, friction mu. */
struct oblique {
  double mass, radius, stiffness, eta_0, mu, ratio;
};

static int oblique_rates(double time, const double s[], double rate[], void *context)
{
  const struct oblique *o = context;
  const double depth = fmax(0, s[0]), c = o->stiffness * 4 / 3 * sqrt(2 * o->radius), slope = 1.5 * c * sqrt(depth);
  const double eta = 2 * o->eta_0 * sqrt(o->mass * slope), normal = fmax(0, c * depth * sqrt(depth) + eta * s[1]);
  const double slip = s[2] + (o->radius - depth) * s[3], kt = o->ratio * slope, cap = o->mu * normal;
  const double wanted = s[4] + sqrt(o->ratio) * eta * slip, force = fmax(-cap, fmin(cap, wanted));
  const double falls = s[1] < 0 && depth > 0 ? 0.5 * s[1] / depth : 0; /* d ln k_t/dt when the overlap falls */
  const double spring = kt * slip + falls * s[4];
  (void)time;
  rate[0] = s[1];
  rate[1] = -normal / o->mass;
  rate[2] = -force / o->mass;
  rate[3] = -force * (o->radius - depth) / (o->mass * o->radius * o->radius / 2);
  /* the spring stays within the cap, which changes with the normal force */
  const double limited = fmax(-cap, fmin(cap, s[4]));
  rate[4] = spring + 1e3 * fabs(s[1]) / fmax(depth, 1e-9) * (limited - s[4]);
  return GSL_SUCCESS;
}

/* Velocities after the impact: [v, u, omega]. */
static void integrate(const struct oblique *o, double v, double u, double omega, double after[3])
{
  gsl_odeiv2_system system = {oblique_rates, NULL, 5, (void *)o};
  const double c = o->stiffness * 4 / 3 * sqrt(2 * o->radius);
  const double depth = pow(1.25 * o->mass * v * v / c, 0.4), h = depth / v / 20000;
  gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(gsl_odeiv2_step_rk4, 5);
  double s[5] = {1e-9 * depth, v, u, omega, 0}, error[5];
  for (int k = 0; k < 200000 && s[0] > 0; k++) {
    gsl_odeiv2_step_apply(step, k * h, h, s, error, NULL, NULL, &system);
    const double left = fmax(0, s[0]), slope = 1.5 * c * sqrt(left);
    const double cap = o->mu * fmax(0, c * left * sqrt(left) + 2 * o->eta_0 * sqrt(o->mass * slope) * s[1]);
    s[4] = fmax(-cap, fmin(cap, s[4]));
  }
  gsl_odeiv2_step_free(step);
  after[0] = s[1];
  after[1] = s[2];
  after[2] = s[3];
}

/* The disc of radius 6 against the right wall; t = (0, 1) there. */
Test(friction, of_an_oblique_impact_is_that_of_an_independent_integration)
{
  static const double slopes[] = {0.2, 1, 4}, spins[] = {0, 0.004, -0.008}, mus[] = {0.1, 0.5};
  for (int n = 0; n < 18; n++) {
    const double v = 0.02, u = v * slopes[n % 3], omega = spins[n / 3 % 3], mu = mus[n / 9], scale = hypot(v, u);
    struct scene scene = impact_scene(true, v);
    struct disc_spec *disc = &scene.particles.discs[0];
    disc->position[1] = 60;
    disc->velocity[1] = u;
    disc->spin = omega;
    scene.contact.law = SPRING_HERTZ;
    scene.contact.restitution = 0.6;
    scene.contact.friction = mu;
    scene.contact.steps_per_contact = 200;
    scene.contact.stiffness = stiffness_for(&scene, true, v, 0.01);
    const struct contact_law law = contact_law_of(&scene);
    const struct oblique o = {.mass = 2 * M_PI * 36,
                              .radius = 6,
                              .stiffness = law.k_n * law.alpha,
                              .eta_0 = law.damping,
                              .mu = mu,
                              .ratio = law.tangential_ratio};
    double after[3], overlap;
    integrate(&o, v, u, omega, after);
    struct simulation *simulation = start(&scene);
    separation_speed(simulation, true, &overlap);
    const struct discs *d = simulation_discs(simulation);
    cr_expect_float_eq(d->vx[0], after[0], 0.02 * scale, "%d: v %g, not %g", n, d->vx[0], after[0]);
    cr_expect_float_eq(d->vy[0], after[1], 0.02 * scale, "%d: u %g, not %g", n, d->vy[0], after[1]);
    cr_expect_float_eq(6 * d->omega[0], 6 * after[2], 0.02 * scale, "%d: omega %g, not %g", n, d->omega[0], after[2]);
    simulation_destroy(simulation);
    scene_clear(&scene);
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
    cr_expect_float_eq(d->vx[0] - wall, v0 * 2 / 3, 0.01 * v0, "wall %g: %g", wall, d->vx[0] - wall);
    simulation_destroy(simulation);
    scene_clear(&scene);
  }
}

/* A floor tilted by tan = part mu; rolling is excluded. */
Test(friction, discs_that_cannot_roll_slip_from_the_slope_mu_on)
{
  static const double parts[] = {0.9, 0.99, 1.01, 1.5};
  const double mu = 0.4, g = 1e-4;
  for (int n = 0; n < 4; n++) {
    const double along = parts[n] * mu * g, wanted = fmax(0, along - mu * g);
    struct scene scene = floor_scene((const double[2]){along, -g}, mu);
    scene.contact.rolling_friction = 5;
    struct simulation *simulation = start(&scene);
    const struct discs *d = simulation_discs(simulation);
    advance(simulation, 500);
    const double before = d->vx[0];
    advance(simulation, 1000);
    const double acceleration = (d->vx[0] - before) / 1000;
    cr_expect_float_eq(acceleration, wanted, 0.01 * wanted + 1e-4 * along, "slope %g mu: %g, not %g", parts[n],
                       acceleration, wanted);
    cr_expect(fabs(d->omega[0]) < 1e-3 * mu * g * 1500 / 10, "slope %g mu: spin %g", parts[n], d->omega[0]);
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

static void momenta(const struct discs *d, double sum[3])
{
  memset(sum, 0, 3 * sizeof *sum);
  for (size_t i = 0; i < d->count; i++) {
    sum[0] += d->mass[i] * d->vx[i];
    sum[1] += d->mass[i] * d->vy[i];
    sum[2] += d->mass[i] * (d->x[i] * d->vy[i] - d->y[i] * d->vx[i]) + d->inertia[i] * d->omega[i];
  }
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
  struct simulation *simulation = start(&scene);
  const struct discs *d = simulation_discs(simulation);
  double before[3], after[3], scale = 0;
  momenta(d, before);
  const double energy = kinetic_energy(d);
  for (size_t i = 0; i < d->count; i++) scale += d->mass[i] * hypot(d->vx[i], d->vy[i]);
  advance(simulation, 1500);
  momenta(d, after);
  cr_expect_lt(kinetic_energy(d), 0.8 * energy, "no collisions");
  for (int k = 0; k < 2; k++)
    cr_expect_float_eq(after[k], before[k], 1e-13 * scale, "component %d: %g", k, after[k] - before[k]);
  cr_expect_float_eq(after[2], before[2], 1e-13 * scale * 400, "%g of %g", after[2] - before[2], before[2]);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* Discs that slide over each other on a floor, periodic in x; all shifted by `shift`. */
static struct scene pile_scene(double shift)
{
  struct scene scene = dry_box(160, 120, SIDES_CLOSED);
  scene.domain.side[SIDE_LEFT].type = scene.domain.side[SIDE_RIGHT].type = SIDE_PERIODIC;
  scene.particles.gravity[0] = 2e-5;
  scene.particles.gravity[1] = -1e-4;
  for (int k = 0; k < 28; k++) {
    const double x = fmod(12 + 20.0 * (k % 7) + (k / 7 % 2 ? 9.5 : 0) + shift, 160);
    scene_add_disc(&scene, 7 + k % 3, 2, x, 11 + 18.0 * (double)(k / 7));
  }
  scene.contact.stiffness = 100;
  scene.contact.friction = 0.4;
  scene.contact.rolling_friction = 0.05;
  return scene;
}

Test(friction, crosses_periodic_sides)
{
  struct scene scene[2] = {pile_scene(0), pile_scene(96)};
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

static bool pass_state(struct simulation *s, char *bytes, size_t size, bool saving)
{
  struct status status;
  struct store store = {.stream = fmemopen(bytes, size, saving ? "wb" : "rb"), .path = "memory", .saving = saving};
  const bool passed = saving ? simulation_save(s, &store, &status) : simulation_restore(s, &store, &status);
  fclose(store.stream);
  return passed;
}

Test(friction, survives_a_restart_and_any_number_of_threads_bit_for_bit)
{
  enum { ROOM = 1 << 20 };
  char *bytes = calloc(1, ROOM);
  struct scene scene = pile_scene(0);
  struct simulation *whole = start(&scene), *resumed = start(&scene);
  advance(whole, 230);
  cr_assert(pass_state(whole, bytes, ROOM, true) && pass_state(resumed, bytes, ROOM, false));
  advance(whole, 300);
  omp_set_num_threads(3);
  advance(resumed, 300);
  const struct discs *a = simulation_discs(whole), *b = simulation_discs(resumed);
  const size_t size = a->count * sizeof(double);
  cr_expect(memcmp(a->x, b->x, size) == 0 && memcmp(a->omega, b->omega, size) == 0 &&
            memcmp(a->contact_fx, b->contact_fx, size) == 0);
  simulation_destroy(whole);
  simulation_destroy(resumed);
  scene_clear(&scene);
  free(bytes);
}

/* In fluid, where the painted rows can be searched. */
Test(friction, has_the_same_bits_by_either_search)
{
  struct scene scene = pile_scene(0);
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
  struct scene scene = pile_scene(0);
  scene.particles.gravity[0] = 0;
  scene.domain.side[SIDE_LEFT].type = scene.domain.side[SIDE_RIGHT].type = SIDE_WALL;
  struct simulation *simulation = start(&scene);
  const struct discs *d = simulation_discs(simulation);
  double most = 0;
  for (int k = 0; k < 300; k++) {
    advance(simulation, 100);
    most = fmax(most, kinetic_energy(d));
  }
  cr_expect(kinetic_energy(d) < 1e-12 * most, "%g of %g", kinetic_energy(d), most);
  simulation_destroy(simulation);
  scene_clear(&scene);
}
