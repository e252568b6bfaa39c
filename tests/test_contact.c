/* Contact: overlap areas, the force law, and whole impacts of discs with discs and walls. */
#include "case/case_overlaps.h"
#include "contact/cells_area.h"
#include "contact/contact_kernel.h"
#include "drive.h"
#include "scenes.h"
#include "solid/lens.h"
#include "solid/solid_kernel.h"

#include <criterion/criterion.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

static gsl_rng *random_from(unsigned long seed)
{
  gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
  cr_assert(random);
  gsl_rng_set(random, seed);
  return random;
}

static double between(gsl_rng *random, double low, double high)
{
  return low + (high - low) * gsl_rng_uniform(random);
}

Test(lens, areas_of_two_discs_agree_with_the_reference)
{
  /* R_j (R_i = 1), delta* = delta (R_i + R_j)/(R_i R_j), area from an independent computation */
  static const double rows[][3] = {{1, 0.001, 1.4906561e-05}, {1, 0.2, 0.041846049}, {1, 1, 0.45331175},
                                   {1.5, 0.05, 0.0075734887}, {1.5, 1, 0.64858954},  {2, 0.01, 0.00083763311},
                                   {3, 0.1, 0.033318309},     {5, 0.5, 0.44127482},  {10, 0.001, 4.9274173e-05},
                                   {10, 0.05, 0.017324149},   {10, 1, 1.3565227}};
  for (size_t k = 0; k < sizeof rows / sizeof rows[0]; k++) {
    const double r = rows[k][0], overlap = rows[k][1] * r / (1 + r);
    cr_expect_float_eq(lens_of_discs(1, r, 1 + r - overlap).area / rows[k][2], 1, 5e-8, "row %zu", k);
  }
}

/* The textbook formula: loses digits at small overlap. */
static double naive_lens(double ra, double rb, double d)
{
  const double a = (d * d + ra * ra - rb * rb) / (2 * d), b = d - a;
  return ra * ra * acos(a / ra) - a * sqrt(ra * ra - a * a) + rb * rb * acos(b / rb) - b * sqrt(rb * rb - b * b);
}

/* Two radii and a distance between all inside and just touching, clear of both ends. */
struct overlapping {
  double ra, rb, d;
};

static struct overlapping random_overlap(gsl_rng *random, double clear)
{
  const double ra = between(random, 1, 20), rb = between(random, 1, 20);
  return (struct overlapping){ra, rb, between(random, fabs(ra - rb) + clear, ra + rb - clear)};
}

Test(lens, area_agrees_with_the_textbook_formula_where_it_is_accurate)
{
  const unsigned long seed = 1;
  gsl_rng *random = random_from(seed);
  for (int n = 0; n < 10000; n++) {
    const struct overlapping o = random_overlap(random, 0.1);
    const double area = lens_of_discs(o.ra, o.rb, o.d).area, naive = naive_lens(o.ra, o.rb, o.d);
    cr_expect_float_eq(area, naive, 1e-11, "seed %lu, R = %.17g, %.17g, d = %.17g: %.17g, not %.17g", seed, o.ra, o.rb,
                       o.d, area, naive);
    cr_expect_float_eq(area, lens_of_discs(o.rb, o.ra, o.d).area, 1e-12 * area, "not symmetric");
    const double x = between(random, -0.99 * o.ra, 0.99 * o.ra);
    const double segment = o.ra * o.ra * acos(x / o.ra) - x * sqrt(o.ra * o.ra - x * x);
    cr_expect_float_eq(lens_of_wall(o.ra, x).area, segment, 1e-11, "seed %lu, wall, R = %.17g, d = %.17g", seed, o.ra,
                       x);
  }
  gsl_rng_free(random);
}

/* The relative error of the limit is of the order of the overlap over the smaller radius; cancellation would exceed
 * it. */
Test(lens, area_tends_to_the_small_overlap_limit_without_cancellation)
{
  static const double radii[] = {1, 1.5, 3, 10, 20};
  for (size_t k = 0; k < sizeof radii / sizeof radii[0]; k++)
    for (double wanted = 1e-12; wanted < 2e-3; wanted *= 7) {
      const double r = radii[k], d = 1 + r - wanted, overlap = 1 + r - d; /* as rounded: exact */
      const double limit = 4. / 3 * sqrt(2 * r / (1 + r)) * pow(overlap, 1.5);
      const double wall = 4. / 3 * sqrt(2) * pow(1 - (1 - wanted), 1.5);
      const double tolerance = 0.2 * overlap + 1e-14;
      cr_expect_float_eq(lens_of_discs(1, r, d).area / limit, 1, tolerance, "R = 1, %g, overlap %g", r, overlap);
      cr_expect_float_eq(lens_of_wall(1, 1 - wanted).area / wall, 1, tolerance, "wall, overlap %g", wanted);
    }
}

Test(lens, chord_is_the_rate_at_which_the_area_grows)
{
  const unsigned long seed = 2;
  const double h = 1e-4;
  gsl_rng *random = random_from(seed);
  for (int n = 0; n < 10000; n++) {
    const struct overlapping o = random_overlap(random, 0.1);
    const double rate = (lens_of_discs(o.ra, o.rb, o.d - h).area - lens_of_discs(o.ra, o.rb, o.d + h).area) / (2 * h);
    cr_expect_float_eq(rate / lens_of_discs(o.ra, o.rb, o.d).chord, 1, 1e-6, "seed %lu, R = %.17g, %.17g, d = %.17g",
                       seed, o.ra, o.rb, o.d);
    const double x = between(random, 0.1 - o.ra, o.ra - 0.1);
    const double wall = (lens_of_wall(o.ra, x - h).area - lens_of_wall(o.ra, x + h).area) / (2 * h);
    cr_expect_float_eq(wall / lens_of_wall(o.ra, x).chord, 1, 1e-6, "seed %lu, wall, R = %.17g, d = %.17g", seed, o.ra,
                       x);
  }
  gsl_rng_free(random);
}

/* If the chord is a diameter, its half-length does not determine the side of the centre. */
Test(lens, area_grows_smoothly_where_the_chord_is_a_diameter)
{
  const double big = 10, small = 3, d = sqrt(big * big - small * small);
  for (double h = 1e-3; h > 1e-10; h /= 10) {
    const double rate = (lens_of_discs(big, small, d - h).area - lens_of_discs(big, small, d + h).area) / (2 * h);
    const double wall = (lens_of_wall(big, -h).area - lens_of_wall(big, h).area) / (2 * h);
    const double tolerance = 1e-6 + 1e-13 / h;
    cr_expect_float_eq(rate / (2 * small), 1, tolerance, "h = %g: %.17g", h, rate);
    cr_expect_float_eq(wall / (2 * big), 1, tolerance, "wall, h = %g: %.17g", h, wall);
  }
}

Test(lens, contained_discs_overlap_wholly_and_distant_ones_not_at_all)
{
  static const double contained[] = {0, 1e-300, 1e-9, 1, 6.999, 7};
  for (size_t k = 0; k < sizeof contained / sizeof contained[0]; k++) {
    cr_expect_float_eq(lens_of_discs(10, 3, contained[k]).area, M_PI * 9, 1e-13);
    cr_expect_float_eq(lens_of_discs(3, 10, contained[k]).area, M_PI * 9, 1e-13);
  }
  cr_expect_float_eq(lens_of_discs(10, 3, 7 + 1e-9).area, M_PI * 9, 1e-7);
  cr_expect_float_eq(lens_of_discs(5, 5, 0).area, M_PI * 25, 1e-13);
  cr_expect_float_eq(lens_of_discs(5, 5, 1e-9).area, M_PI * 25, 1e-7);
  cr_expect_float_eq(lens_of_wall(5, -5).area, M_PI * 25, 1e-13);
  cr_expect_float_eq(lens_of_wall(5, -7).area, M_PI * 25, 1e-13);
  cr_expect_float_eq(lens_of_wall(5, 0).area, M_PI * 12.5, 1e-13);
  cr_expect_eq(lens_of_discs(10, 3, 13).area, 0);
  cr_expect_eq(lens_of_discs(10, 3, 14).area, 0);
  cr_expect_eq(lens_of_wall(5, 5).area, 0);
  cr_expect_eq(lens_of_wall(5, 6).area, 0);
}

/* (11): alpha is the limit of the dimensionless area over delta*^1.5. */
Test(lens, dimensionless_area_tends_to_the_alpha_of_the_radii)
{
  for (double beta = 1; beta < 20; beta *= 1.3) {
    const double ri = 7, rj = beta * ri, dimensionless = 1e-6, overlap = dimensionless * ri * rj / (ri + rj);
    const double area = lens_of_discs(ri, rj, ri + rj - overlap).area;
    const double fit = area * (ri * ri + rj * rj) / (M_PI * ri * ri * rj * rj) / pow(dimensionless, 1.5);
    const double f = 4 * M_SQRT2 / (3 * M_PI) * (1 + beta * beta) / ((1 + beta) * (1 + beta));
    cr_expect_float_eq(fit / f, 1, 1e-6, "beta %g: %.9g, not %.9g", beta, fit, f);
    if (beta == 1) cr_expect_float_eq(fit, 0.3001, 5e-5);
  }
}

/* Mean area by cells (23) of two discs of radius 10, over places and directions. */
static double mean_cells_area(double overlap, unsigned long seed)
{
  enum { PLACES = 20000 };
  struct status status;
  struct scene scene = scene_box(64, 64, 0.05, SIDES_PERIODIC);
  struct discs discs;
  for (int k = 0; k < 2; k++) scene_add_disc(&scene, 10, 2, 0, 0);
  cr_assert(discs_create(&discs, &scene, &status), "%s", status.message);
  double *scratch = calloc(cells_area_scratch(&discs), sizeof *scratch), sum = 0;
  gsl_rng *random = random_from(seed);
  for (int n = 0; n < PLACES; n++) {
    const double angle = between(random, 0, 2 * M_PI), d = 20 - overlap;
    discs.x[0] = between(random, 31, 32), discs.y[0] = between(random, 31, 32);
    discs.x[1] = discs.x[0] + d * cos(angle), discs.y[1] = discs.y[0] + d * sin(angle);
    sum += cells_area(&scene, &discs, 0, 1, scratch);
  }
  gsl_rng_free(random);
  free(scratch);
  discs_destroy(&discs);
  scene_clear(&scene);
  return sum / PLACES;
}

Test(overlap, areas_by_cells_have_the_mean_measured_for_the_paper_s_rule)
{
  static const double measured[][2] = {{0.2, 0.57}, {0.5, 1.82}, {1, 4.75}}; /* R = 10, means over many places */
  for (unsigned long k = 0; k < 3; k++) {
    const double mean = mean_cells_area(measured[k][0], k);
    cr_expect_float_eq(mean / measured[k][1], 1, 0.03, "overlap %g, seed %lu: %g", measured[k][0], k, mean);
  }
}

static struct contact_law law_of(double stiffness, double alpha, double damping, enum contact_damping form)
{
  const struct scene scene = {
      .contact = {.stiffness = stiffness, .alpha = alpha, .damping = damping, .damping_form = form}};
  return contact_law_of(&scene);
}

/* A pair of free discs beside each other as the one entry of a contact table. */
struct lone {
  struct scene scene;
  struct discs discs;
  struct pair pair;
  struct contact_table table;
  struct contact_law law;
  struct response response[2];
  struct shape_kind kind;
  struct contact_pass pass;
  const struct contact_kernel *kernel;
};

static void lone_create(struct lone *l, const struct scene *contact, const double radius[2], double overlap,
                        double angle)
{
  struct status status;
  const double distance = radius[0] + radius[1] - overlap;
  *l = (struct lone){.scene = scene_box(100, 100, 0.1, SIDES_CLOSED), .pair = {0, 1}};
  l->scene.contact = contact->contact;
  scene_add_disc(&l->scene, radius[0], 2, 50, 50);
  scene_add_disc(&l->scene, radius[1], 3, 50 + distance * cos(angle), 50 + distance * sin(angle));
  const struct pair_list list = {.pairs = &l->pair, .count = 1};
  l->law = contact_law_of(&l->scene);
  cr_assert(discs_create(&l->discs, &l->scene, &status) && table_create(&l->table, 2, &status) &&
                table_build(&l->table, &l->scene, &l->discs, &list, &(struct contact_states){0}, &status),
            "%s", status.message);
  l->table.has_spin = l->table.limited = true;
  for (size_t block = 0; block < l->table.blocks; block++) table_fill(&l->table, &l->scene, &l->discs, &l->law, block);
  for (int k = 0; k < 2; k++)
    l->response[k] =
        (struct response){.xx = 1 / l->discs.mass[k], .yy = 1 / l->discs.mass[k], .ww = 1 / l->discs.inertia[k]};
  l->kind = *l->discs.shape[0].kind;
  l->kernel = contact_kernel_find(NULL);
  const struct discs *d = &l->discs;
  l->pass = (struct contact_pass){.table = &l->table,
                                  .scene = &l->scene,
                                  .law = &l->law,
                                  .kind = &l->kind,
                                  .response = l->response,
                                  .at = {d->x, d->y, d->angle, d->vx, d->vy, d->omega},
                                  .within = 1,
                                  .moved = 0,
                                  .h = 1,
                                  .duration = 1};
}

static void lone_destroy(struct lone *l)
{
  table_destroy(&l->table);
  discs_destroy(&l->discs);
  scene_clear(&l->scene);
}

static void lone_act(struct lone *l)
{
  double overlap = 0;
  l->kernel->select(&l->pass, 0);
  l->kernel->impulses(&l->pass, 0, &overlap);
}

/* Impulse on b along the direction from a to b. */
static double lone_normal(const struct lone *l, double angle)
{
  return l->table.fx[0] * cos(angle) + l->table.fy[0] * sin(angle);
}

/* Contact points off the line of centroids, as of shapes that are not round: offsets 2 and -1.5. */
static void shifted_overlaps(const struct body_pairs *pairs, struct body_overlaps *o)
{
  solid_kernel_find(NULL)->disc.overlaps(pairs, o);
  for (int k = 0; k < pairs->count; k++) {
    o->offset[0][k] = 2;
    o->offset[1][k] = -1.5;
  }
}

/* Approach speed at the contact point at these offsets. */
static double approach_of(double v[2][3], double nx, double ny, const double offset[2])
{
  double speed = 0;
  for (int end = 0; end < 2; end++)
    speed += (end ? -1 : 1) * (v[end][0] * nx + v[end][1] * ny - offset[end] * v[end][2]);
  return speed;
}

/* The limit of an impulse by an empty store of energy reverses the approach speed, whatever the response. */
Test(law, impulses_without_stored_energy_reverse_the_approach_at_the_contact_point)
{
  static const double offset[2] = {2, -1.5}, radius[2] = {6, 8};
  const unsigned long seed = 7;
  gsl_rng *random = random_from(seed);
  const struct scene stiff = {.contact = {.stiffness = 1e9, .alpha = 0.3, .tangential_ratio = 0.8}};
  for (int n = 0; n < 1000; n++) {
    struct lone l;
    const double angle = between(random, 0, 2 * M_PI), nx = cos(angle), ny = sin(angle);
    lone_create(&l, &stiff, radius, 0.3, angle);
    l.kind.round = false;
    l.kind.overlaps = shifted_overlaps;
    double v[2][3], dv[3], *const arrays[3] = {l.discs.vx, l.discs.vy, l.discs.omega};
    for (size_t end = 0; end < 2; end++) {
      for (int k = 0; k < 3; k++) arrays[k][end] = v[end][k] = between(random, -0.1, 0.1);
      l.response[end] = (struct response){.xx = between(random, 1, 2),
                                          .xy = between(random, -0.5, 0.5),
                                          .xw = between(random, -0.3, 0.3),
                                          .yy = between(random, 1, 2),
                                          .yw = between(random, -0.3, 0.3),
                                          .ww = between(random, 1, 2)};
    }
    const double before = approach_of(v, nx, ny, offset);
    lone_act(&l);
    for (int end = 0; end < 2; end++) {
      const double sign = end ? 1 : -1, torque = end ? l.table.torque_b[0] : l.table.torque_a[0];
      response_to(&l.response[end], (const double[3]){sign * l.table.fx[0], sign * l.table.fy[0], torque}, dv);
      for (int k = 0; k < 3; k++) v[end][k] += dv[k];
    }
    const double after = approach_of(v, nx, ny, offset), expected = before > 0 ? -before : before;
    cr_expect_float_eq(after, expected, 1e-12, "seed %lu: %g before, %g after", seed, before, after);
    lone_destroy(&l);
  }
  gsl_rng_free(random);
}

Test(law, force_is_never_attractive_and_acts_on_overlap_only)
{
  static const double radius[2] = {6, 8};
  const unsigned long seed = 3;
  gsl_rng *random = random_from(seed);
  for (int n = 0; n < 3000; n++) {
    const double k = pow(10, between(random, -3, 6)), overlap = pow(10, between(random, -6, 0.3));
    const struct scene scene = {.contact = {.law = (unsigned)n % 3,
                                            .stiffness = k,
                                            .alpha = 0.3,
                                            .damping = between(random, 0, 2),
                                            .damping_form = n / 3 % 2}};
    struct lone l;
    const double angle = between(random, 0, 2 * M_PI), approach = between(random, -0.5, 0.5);
    lone_create(&l, &scene, radius, n % 7 ? overlap : -overlap, angle);
    l.discs.vx[0] = approach * cos(angle);
    l.discs.vy[0] = approach * sin(angle);
    l.table.live[0] = 1;
    l.table.stored[0] = 1e300; /* any force */
    lone_act(&l);
    const double force = lone_normal(&l, angle), spring = contact_spring_at(&l.law, radius, overlap).force;
    cr_expect(force >= -1e-13 * spring, "seed %lu: %g", seed, force);
    if (n % 7 == 0) cr_expect_eq(force, 0, "seed %lu: %g over a gap", seed, force);
    const double slack = 1e-7 * spring;
    const double mean = approach - 0.5 * force * (l.response[0].xx + l.response[1].xx);
    cr_expect(n % 7 == 0 || mean < 0 || force >= spring - slack, "seed %lu: damping helps the approach", seed);
    cr_expect(n % 7 == 0 || mean > 0 || force <= spring + slack, "seed %lu: damping helps the parting", seed);
    lone_destroy(&l);
  }
  gsl_rng_free(random);
}

/* The spring alone, through an overlap that comes and goes at speeds that others set. */
Test(law, impulses_return_the_stored_energy_and_no_more)
{
  static const double radius[2] = {5, 5};
  const struct scene scene = {.contact = {.stiffness = 1e6, .alpha = 1}};
  for (int stored = 0; stored < 2; stored++) {
    struct lone l;
    lone_create(&l, &scene, radius, 0.3, 0);
    l.discs.vx[0] = -0.1;
    l.table.live[0] = 1;
    l.table.stored[0] = stored ? 0.01 : 0;
    lone_act(&l);
    const double j = l.table.fx[0], c = l.response[0].xx + l.response[1].xx;
    cr_expect_float_eq(j * (-0.1 - c * j / 2), stored ? -0.01 : 0, 1e-15, "impulse %g", j);
    lone_destroy(&l);
  }
}

/* Whatever history and motion: |J_t| <= mu J_n, and both torques with the forces leave angular momentum as it is. */
Test(friction, impulses_obey_coulomb_and_conserve_angular_momentum)
{
  const unsigned long seed = 5;
  gsl_rng *random = random_from(seed);
  int sliding = 0, sticking = 0;
  for (int n = 0; n < 3000; n++) {
    const double radius[2] = {between(random, 2, 9), between(random, 2, 9)}, angle = between(random, 0, 2 * M_PI);
    const double overlap = between(random, 0.01, 0.5), friction = between(random, 0.05, 1);
    const struct scene scene = {.contact = {.law = (unsigned)n % 3,
                                            .stiffness = pow(10, between(random, -2, 3)),
                                            .damping = 0.3,
                                            .friction = friction,
                                            .tangential_ratio = 0.8,
                                            .rolling_friction = n % 2 ? 0.1 : 0}};
    struct lone l;
    lone_create(&l, &scene, radius, overlap, angle);
    for (int end = 0; end < 2; end++) {
      l.discs.vx[end] = between(random, -0.02, 0.02);
      l.discs.vy[end] = between(random, -0.02, 0.02);
      l.discs.omega[end] = between(random, -0.01, 0.01);
    }
    l.table.live[0] = 1;
    l.table.stored[0] = 1e3;
    l.table.shear[0] = between(random, -1, 1);
    l.table.shear_stiffness[0] = l.table.moment_stiffness[0] = 1;
    l.table.moment[0] = between(random, -1, 1);
    lone_act(&l);
    const struct contact_table *t = &l.table;
    const double nx = cos(angle), ny = sin(angle), jn = lone_normal(&l, angle);
    const double jt = -t->fx[0] * ny + t->fy[0] * nx, distance = radius[0] + radius[1] - overlap;
    const double turned = t->torque_a[0] + t->torque_b[0] + distance * jt;
    cr_expect(fabs(jt) <= friction * jn * (1 + 1e-12), "seed %lu: %g beyond %g times %g", seed, jt, friction, jn);
    cr_expect_float_eq(turned, 0, 1e-14 * (1 + 20 * jn), "seed %lu: %g", seed, turned);
    sliding += jn > 0 && fabs(jt) > 0.999 * friction * jn;
    sticking += jn > 0 && fabs(jt) < 0.9 * friction * jn;
    lone_destroy(&l);
  }
  cr_expect(sliding > 100 && sticking > 100, "%d slide, %d stick", sliding, sticking);
  gsl_rng_free(random);
}

Test(law, damping_is_critical_at_one_or_as_printed)
{
  const double mi = 3, mj = 5, k = 7, reduced = mi * mj / (mi + mj);
  struct contact_law law = law_of(k, 1, 0.34, DAMPING_CRITICAL);
  cr_expect_float_eq(contact_damping(&law, 1 / mi + 1 / mj, 1), 2 * 0.34 * sqrt(k * reduced), 1e-14);
  cr_expect_float_eq(contact_damping(&law, 1 / mi, 1), 2 * 0.34 * sqrt(k * mi), 1e-14);
  cr_expect_eq(contact_damping(&law, 0, 1), 0);
  law.form = DAMPING_PRINTED;
  cr_expect_float_eq(contact_damping(&law, 1 / mi + 1 / mj, 1), 2 * 0.34 * sqrt(k * (mi + mj) / (mi * mj)), 1e-14);
}

/* The rate at which the force grows with the overlap sets the sub-steps; its integral is the energy of discs put into each other. */
Test(law, stiffness_and_energy_are_those_of_the_force)
{
  static const double radii[][2] = {{5, 5}, {3, 8}, {5, INFINITY}};
  for (unsigned choice = 0; choice < 3; choice++) {
    const struct scene scene = {.contact = {.law = choice, .stiffness = 10, .alpha = 0.3}};
    const struct contact_law law = contact_law_of(&scene);
    for (int n = 0; n < 3; n++)
      for (double overlap = 1e-4; overlap < 2; overlap *= 3) {
        const double h = 1e-4 * overlap;
        const double low = contact_spring_at(&law, radii[n], overlap - h).force;
        const double high = contact_spring_at(&law, radii[n], overlap + h).force;
        const double work = contact_energy(&law, radii[n], overlap + h) - contact_energy(&law, radii[n], overlap - h);
        cr_expect_float_eq((high - low) / (2 * h) / contact_spring_at(&law, radii[n], overlap).stiffness, 1, 1e-5);
        cr_expect_float_eq(work / (2 * h) / contact_spring_at(&law, radii[n], overlap).force, 1, 1e-5);
      }
  }
}

/* A linear spring: the overlap itself as the area. Unclamped, the force may pull. */
static double spring_acceleration(const struct contact_law *law, double mass, const double state[2], bool clamped)
{
  const double force = law->k_n * state[0] + contact_damping(law, 1 / mass, 1) * state[1];
  return -(clamped ? fmax(0, force) : force) / mass;
}

/* Restitution of an impact with this spring by fourth-order Runge-Kutta steps, until the overlap ends. */
static double spring_restitution(const struct contact_law *law, double mass, bool clamped)
{
  const double h = 2e-5 / sqrt(law->k_n / mass);
  double s[2] = {1e-15, 1}, last = 1;
  while (s[0] > 0) {
    static const double weight[4] = {1, 2, 2, 1}, reach[4] = {0, 0.5, 0.5, 1};
    double rate[2] = {0, 0}, sum[2] = {0, 0};
    for (int k = 0; k < 4; k++) {
      const double at[2] = {s[0] + reach[k] * h * rate[0], s[1] + reach[k] * h * rate[1]};
      rate[0] = at[1];
      rate[1] = spring_acceleration(law, mass, at, clamped);
      for (int c = 0; c < 2; c++) sum[c] += weight[k] / 6 * h * rate[c];
    }
    last = s[1];
    s[0] += sum[0];
    s[1] += sum[1];
  }
  return -(clamped ? s[1] : last);
}

Test(law, a_linear_spring_has_the_restitution_of_the_reference)
{
  /* zeta, restitution if the contact ends at no overlap, and at no force: from an independent computation */
  static const double rows[][3] = {{0.01, 0.969071, 0.969265},
                                   {0.1, 0.729248, 0.744079},
                                   {0.34, 0.321163, 0.412731},
                                   {0.5, 0.163034, 0.298436},
                                   {0.9, 0.001524, 0.155283}};
  for (size_t k = 0; k < sizeof rows / sizeof rows[0]; k++) {
    const struct contact_law law = law_of(4, 1, rows[k][0], DAMPING_CRITICAL);
    cr_expect_float_eq(spring_restitution(&law, 0.6, false), rows[k][1], 4e-5, "zeta %g", rows[k][0]);
    cr_expect_float_eq(spring_restitution(&law, 0.6, true), rows[k][2], 4e-5, "zeta %g", rows[k][0]);
  }
}

/* Head-on impact of two discs, or of a disc and a wall, so heavy that the fluid is negligible. The gap determines
 * the fraction of a step at which contact begins. */
struct impact {
  bool wall;
  double radius[2];
  double direction[2]; /* from the first disc to the second */
  double speed, gap;
  double overlap; /* largest overlap of an undamped impact, cells: determines the stiffness */
  double damping;
  double place[2]; /* offset of both discs on the grid: changes areas by cells */
  enum contact_area area;
  int substeps;
};

struct outcome {
  double restitution;
  double most_overlap;
  double imbalance; /* of the impulses on the two, relative to one of them */
  double drift;     /* of the momentum of fluid and discs, relative to a disc's momentum */
  int substeps;
};

enum { BOX = 80 };
static const double heavy = 1e6;

static double reduced_mass(const struct impact *i)
{
  const double ma = heavy * M_PI * i->radius[0] * i->radius[0], mb = heavy * M_PI * i->radius[1] * i->radius[1];
  return i->wall ? ma : ma * mb / (ma + mb);
}

/* Work against a contact of unit stiffness: the integral of the lens area, by Simpson's rule in the root of the
 * overlap, in which it is smooth. */
static double work(const struct impact *i, double overlap)
{
  enum { PARTS = 200 };
  const double top = sqrt(overlap), ra = i->radius[0], rb = i->radius[1];
  double sum = 0;
  for (int k = 1; k <= PARTS; k++) {
    const double root = top * k / PARTS, weight = k == PARTS ? 1 : k % 2 ? 4 : 2;
    const double at = root * root;
    sum += weight * 2 * root * (i->wall ? lens_of_wall(ra, ra - at) : lens_of_discs(ra, rb, ra + rb - at)).area;
  }
  return sum * top / PARTS / 3;
}

static struct scene impact_scene(const struct impact *i)
{
  struct scene scene = scene_box(BOX, BOX, 0.01, i->wall ? SIDES_CLOSED : SIDES_PERIODIC);
  scene.coupling.form = FORM_UNIFIED; /* stable at deeper overlaps, in which fluid is trapped */
  scene.contact.damping = i->damping;
  scene.contact.area = i->area;
  scene.contact.substeps = i->substeps;
  scene.contact.stiffness = 0.5 * reduced_mass(i) * i->speed * i->speed / work(i, i->overlap) / scene.contact.alpha;
  const double *n = i->direction, apart = i->radius[0] + i->radius[1] + i->gap;
  const double along = i->wall ? BOX / 2.0 - apart : -apart / 2; /* from the middle of the box */
  const double x[2] = {i->place[0] + BOX / 2.0 + along * n[0], i->place[1] + BOX / 2.0 + along * n[1]};
  const double part = reduced_mass(i) / (heavy * M_PI * i->radius[0] * i->radius[0]);
  struct disc_spec *first = scene_add_disc(&scene, i->radius[0], heavy, x[0], x[1]);
  for (int axis = 0; axis < 2; axis++) first->velocity[axis] = part * i->speed * n[axis];
  if (i->wall) return scene;
  struct disc_spec *second = scene_add_disc(&scene, i->radius[1], heavy, x[0] + apart * n[0], x[1] + apart * n[1]);
  for (int axis = 0; axis < 2; axis++) second->velocity[axis] = (part - 1) * i->speed * n[axis];
  return scene;
}

/* Overlap; *approach_speed is the speed of approach. */
static double overlap_of(const struct impact *i, const struct discs *d, double *approach_speed)
{
  const double *n = i->direction;
  *approach_speed = d->vx[0] * n[0] + d->vy[0] * n[1];
  if (i->wall) return (d->x[0] - BOX / 2.0) * n[0] + (d->y[0] - BOX / 2.0) * n[1] + i->radius[0] - BOX / 2.0;
  *approach_speed -= d->vx[1] * n[0] + d->vy[1] * n[1];
  return i->radius[0] + i->radius[1] - hypot(d->x[1] - d->x[0], d->y[1] - d->y[0]);
}

static double imbalance_of(const struct discs *d)
{
  if (d->count < 2) return 0;
  const double sum = hypot(d->contact_fx[0] + d->contact_fx[1], d->contact_fy[0] + d->contact_fy[1]);
  const double one = hypot(d->contact_fx[0], d->contact_fy[0]);
  return one > 0 ? sum / one : 0;
}

static struct outcome follow(const struct impact *i)
{
  struct status status;
  struct scene scene = impact_scene(i);
  struct simulation *simulation;
  struct simulation_report report;
  struct outcome outcome = {.restitution = NAN};
  omp_set_num_threads(1); /* a small box */
  cr_assert(simulation_create(&simulation, &scene, &status), "%s", status.message);
  const struct discs *d = simulation_discs(simulation);
  for (bool met = false; isnan(outcome.restitution) && simulation_step(simulation) < 2000;) {
    double approach_speed;
    cr_assert(simulation_advance(simulation, 1, &status), "overlap %g, speed %g: %s", i->overlap, i->speed,
              status.message);
    outcome.most_overlap = fmax(outcome.most_overlap, overlap_of(i, d, &approach_speed));
    outcome.imbalance = fmax(outcome.imbalance, imbalance_of(d));
    const bool touching = d->contact_fx[0] != 0 || d->contact_fy[0] != 0;
    if (met && !touching) outcome.restitution = -approach_speed / i->speed;
    met |= touching;
  }
  simulation_report(simulation, &report);
  outcome.substeps = report.max_substeps;
  outcome.drift = report.momentum_drift * BOX * BOX / (reduced_mass(i) * i->speed);
  simulation_destroy(simulation);
  scene_clear(&scene);
  return outcome;
}

static void check_impact(const struct impact *i)
{
  const struct outcome o = follow(i);
  const char *what = i->wall ? "wall" : "discs";
  /* kinetic energy that a sub-step may add where the contact begins or ends within it: (pi/20)^2/4 */
  const double surplus = i->damping > 0 ? 0 : 0.0062;
  cr_expect(o.restitution * o.restitution <= 1 + surplus,
            "%s, for overlap %g, speed %g, damping %g, gap %g: kinetic energy grows by %.2f %% in %d sub-steps", what,
            i->overlap, i->speed, i->damping, i->gap, 100 * (o.restitution * o.restitution - 1), o.substeps);
  if (i->damping == 0)
    cr_expect_float_eq(o.restitution, 1, 0.01, "%s, for overlap %g, speed %g, gap %g: restitution %g in %d sub-steps",
                       what, i->overlap, i->speed, i->gap, o.restitution, o.substeps);
  cr_expect(o.most_overlap <= 1.01 * i->overlap, "%s, for overlap %g, speed %g, damping %g: overlap %g", what,
            i->overlap, i->speed, i->damping, o.most_overlap);
  cr_expect(i->wall || (o.imbalance < 1e-14 && o.drift < 1e-12), "momentum: imbalance %g, drift %g", o.imbalance,
            o.drift);
}

/* Stiffness over eight decades: the overlap of an undamped impact is proportional to stiffness^(-0.4). At deeper
 * overlaps than the first the trapped fluid reaches the speed of sound. */
static void check_impacts(struct impact impact, double speed, double damping)
{
  impact.damping = damping;
  impact.speed = speed;
  for (double decade = 0; decade <= 8; decade += 0.25)
    for (int phase = 0; phase < 4; phase++) {
      impact.overlap = (impact.wall ? 0.25 : 0.8) * pow(10, -0.4 * decade);
      impact.gap = 1.3 + 0.277 * speed * phase;
      check_impact(&impact);
    }
}

static const struct impact along_x = {.radius = {10, 10}, .direction = {1, 0}};
static const struct impact oblique = {.radius = {12, 7}, .direction = {0.6, -0.8}};
static const struct impact on_right_wall = {.wall = true, .radius = {10, 0}, .direction = {1, 0}};
static const struct impact on_bottom_wall = {.wall = true, .radius = {7, 0}, .direction = {0, -1}};

Test(impact, without_damping_equal_discs_part_as_fast_as_they_met)
{
  check_impacts(along_x, 0.02, 0);
  check_impacts(along_x, 0.2, 0);
}

Test(impact, without_damping_unequal_discs_part_as_fast_as_they_met)
{
  check_impacts(oblique, 0.02, 0);
  check_impacts(oblique, 0.2, 0);
}

Test(impact, without_damping_walls_throw_discs_back_as_fast_as_they_came)
{
  check_impacts(on_right_wall, 0.02, 0);
  check_impacts(on_bottom_wall, 0.1, 0);
}

Test(impact, with_damping_kinetic_energy_never_grows)
{
  static const double dampings[] = {0.02, 0.34, 1};
  for (size_t k = 0; k < sizeof dampings / sizeof dampings[0]; k++) {
    check_impacts(along_x, 0.02, dampings[k]);
    check_impacts(oblique, 0.2, dampings[k]);
    check_impacts(on_bottom_wall, 0.1, dampings[k]);
  }
}

/* Steps that an undamped impact of two heavy discs takes from touch to parting, from where they are long after it; and the speed at
 * which they part over that at which they met. */
static double impact_duration(unsigned law, double stiffness, double *restitution)
{
  const struct impact impact = {.radius = {10, 10}, .direction = {1, 0}, .speed = 0.02, .gap = 1.3, .overlap = 0.3};
  struct scene scene = impact_scene(&impact);
  scene.contact.law = law;
  scene.contact.stiffness = stiffness;
  struct simulation *simulation = start(&scene);
  double closing, apart = -1;
  while (apart < 1 && simulation_step(simulation) < 2000) {
    advance(simulation, 10);
    const double overlap = overlap_of(&impact, simulation_discs(simulation), &closing);
    apart = closing < 0 ? -overlap : -1;
  }
  *restitution = -closing / impact.speed;
  const double steps = (double)simulation_step(simulation) - (impact.gap + apart / *restitution) / impact.speed;
  simulation_destroy(simulation);
  scene_clear(&scene);
  return steps;
}

Test(law, linear_lasts_half_a_period_of_its_spring_and_parts_as_the_overlap_law_does)
{
  const double mass = heavy * M_PI * 100 / 2, chord = lens_of_discs(10, 10, 19.9).chord;
  omp_set_num_threads(1);
  for (double half_period = 20; half_period <= 80; half_period *= 2) {
    const double k = mass * pow(M_PI / half_period, 2), stiffness = k / (0.3 * chord);
    double linear, overlap;
    const double steps = impact_duration(SPRING_LINEAR, stiffness, &linear);
    impact_duration(SPRING_OVERLAP, stiffness, &overlap);
    cr_expect_float_eq(steps / half_period, 1, 0.01, "half period %g: %g steps", half_period, steps);
    cr_expect_float_eq(linear, overlap, 0.005, "half period %g: restitution %g, by the overlap law %g", half_period,
                       linear, overlap);
  }
}

/* The largest speed of separation over the speed of approach, for contacts that may end and begin again. */
static double fastest_parting(const struct impact *i, int64_t steps)
{
  struct scene scene = impact_scene(i);
  omp_set_num_threads(1);
  struct simulation *simulation = start(&scene);
  double fastest = -i->speed;
  while (simulation_step(simulation) < steps) {
    double approach_speed;
    advance(simulation, 1);
    overlap_of(i, simulation_discs(simulation), &approach_speed);
    fastest = fmax(fastest, -approach_speed);
  }
  simulation_destroy(simulation);
  scene_clear(&scene);
  return fastest / i->speed;
}

/* Over eight decades of stiffness, offsets in a cell, directions, and sub-steps as needed or far too few; areas by cells take one. */
static void check_return(enum contact_area area, double damping, double most)
{
  static const double directions[][2] = {{1, 0}, {0.6, -0.8}};
  static const int substeps[] = {0, 1, 4};
  for (double decade = 0; decade <= 8; decade += 2)
    for (int k = 0; k < 12; k++) {
      const double *n = directions[k % 2];
      const struct impact impact = {.radius = {10, 7},
                                    .direction = {n[0], n[1]},
                                    .speed = 0.05,
                                    .gap = 1.3 + 0.01 * k,
                                    .overlap = 0.6 * pow(10, -0.4 * decade),
                                    .damping = damping,
                                    .place = {0.37 * k, 0.61 * k},
                                    .area = area,
                                    .substeps = area == AREA_CELLS ? 0 : substeps[k % 3]};
      const double parting = fastest_parting(&impact, 100);
      cr_expect(parting > -1 && parting <= most, "area %d, overlap %g, damping %g, sub-steps %d, place %d: parts at %g",
                area, impact.overlap, damping, impact.substeps, k, parting);
    }
}

Test(impact, returns_no_more_speed_than_before_for_any_area_and_number_of_sub_steps)
{
  check_return(AREA_LENS, 0, 1.001);
  check_return(AREA_CELLS, 0, 1.001);
  check_return(AREA_LENS, 0.34, 1.001);
  check_return(AREA_CELLS, 0.34, 1.001);
}

Test(impact, by_cells_takes_one_sub_step_however_stiff)
{
  const struct impact impact = {.radius = {10, 10},
                                .direction = {1, 0},
                                .speed = 0.05,
                                .gap = 1.3,
                                .overlap = 1e-3,
                                .damping = 0.34,
                                .area = AREA_CELLS};
  cr_expect_eq(follow(&impact).substeps, 1);
}

/* Head-on impact of two discs of radius 5 in a fluid that is not negligible. */
static struct scene wet_scene(double density, double stiffness, double gap)
{
  struct scene scene = scene_box(64, 40, 0.01, SIDES_PERIODIC);
  scene.contact.damping = 0;
  scene.contact.stiffness = stiffness;
  for (int k = 0; k < 2; k++)
    scene_add_disc(&scene, 5, density, 32.3 + (k - 0.5) * (10 + gap), 20)->velocity[0] = k ? -0.05 : 0.05;
  return scene;
}

/* Energy of motion, of the discs and of all fluid, and of the fluid's compression. */
static double energy_of(struct simulation *simulation)
{
  enum { CELLS = 64 * 40 };
  double density[CELLS], ux[CELLS], uy[CELLS], energy = 0;
  const struct discs *d = simulation_discs(simulation);
  simulation_fields(simulation, density, ux, uy);
  for (int k = 0; k < CELLS; k++) {
    const double excess = density[k] - 1;
    energy += density[k] * (ux[k] * ux[k] + uy[k] * uy[k]) / 2 + excess * excess / 6;
  }
  for (size_t k = 0; k < d->count; k++)
    energy += (d->mass[k] - d->fluid_mass[k]) * (d->vx[k] * d->vx[k] + d->vy[k] * d->vy[k]) / 2;
  return energy;
}

static void check_wet_impact(double density, double stiffness, double gap)
{
  struct status status;
  struct scene scene = wet_scene(density, stiffness, gap);
  struct simulation *simulation;
  double approach = 0.1, push = 0, energy, fastest = 0, most = 0;
  omp_set_num_threads(1);
  cr_assert(simulation_create(&simulation, &scene, &status), "%s", status.message);
  const struct discs *d = simulation_discs(simulation);
  do {
    push = approach - (d->vx[0] - d->vx[1]); /* impulse of the fluid between them in a step */
    approach = d->vx[0] - d->vx[1];
    energy = energy_of(simulation);
    advance(simulation, 1);
  } while (d->contact_fx[0] == 0 && simulation_step(simulation) < 500);
  for (int step = 0; step < 30; step++) {
    fastest = fmax(fastest, d->vx[1] - d->vx[0]);
    most = fmax(most, energy_of(simulation));
    advance(simulation, 1);
  }
  /* plus the impulse of the fluid, and the surplus of a sub-step (check_impact) */
  cr_expect(fastest > 0 && fastest <= 1.003 * approach + push,
            "density %g, stiffness %g, gap %g: part at %g, met at %g, fluid gives %g", density, stiffness, gap, fastest,
            approach, push);
  cr_expect_leq(most, 1.0062 * energy, "density %g, stiffness %g, gap %g: energy %g, was %g", density, stiffness, gap,
                most, energy);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* A contact shorter than a step must not gain energy from the fluid inside the discs. */
Test(impact, in_fluid_without_damping_no_energy_is_gained_at_any_stiffness)
{
  static const double densities[] = {2, 5, 20};
  for (int k = 0; k < 3; k++)
    for (double stiffness = 250; stiffness < 1e6; stiffness *= 10)
      for (int phase = 0; phase < 4; phase++) check_wet_impact(densities[k], stiffness, 3 + 0.02 * phase);
}

/* A stack of two discs on the bottom of a box: the overlaps, and the force on the bottom over the weight. */
struct rest {
  double overlap[2], weight;
};

static struct rest rest_of(const struct discs *d, double weight)
{
  return (struct rest){
      {d->radius[0] - d->y[0], d->radius[0] + d->radius[1] - hypot(d->x[1] - d->x[0], d->y[1] - d->y[0])},
      (d->contact_fy[0] + d->contact_fy[1]) / weight};
}

static void check_rest(double stiffness, enum contact_area area, int substeps, double tolerance)
{
  struct scene scene = scene_box(30, 44, 0.05, SIDES_CLOSED);
  scene.particles.gravity[1] = -1e-4;
  scene.contact.stiffness = stiffness;
  scene.contact.area = area;
  scene.contact.substeps = substeps;
  for (int k = 0; k < 2; k++) scene_add_disc(&scene, 5, 2, 15, 5 + 10 * k);
  omp_set_num_threads(1);
  struct simulation *simulation = start(&scene);
  const struct discs *d = simulation_discs(simulation);
  const double weight = 1e-4 * (d->mass[0] - d->fluid_mass[0] + d->mass[1] - d->fluid_mass[1]);
  advance(simulation, 5000);
  const struct rest early = rest_of(d, weight);
  advance(simulation, 15000);
  const struct rest late = rest_of(d, weight);
  cr_expect_float_eq(late.weight, 1, tolerance, "stiffness %g, area %d, sub-steps %d: bears %g of the weight",
                     stiffness, area, substeps, late.weight);
  for (int k = 0; k < 2; k++)
    cr_expect(late.overlap[k] > 0 && late.overlap[k] < 0.2 && fabs(late.overlap[k] - early.overlap[k]) < 1e-6,
              "stiffness %g, area %d, sub-steps %d: overlap %d is %g, was %g", stiffness, area, substeps, k,
              late.overlap[k], early.overlap[k]);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

Test(rest, contacts_support_the_whole_weight_of_a_stack_at_rest)
{
  for (double stiffness = 25; stiffness <= 250000; stiffness *= 100) check_rest(stiffness, AREA_LENS, 0, 1e-6);
  check_rest(25, AREA_CELLS, 0, 1e-6);
  check_rest(2500, AREA_LENS, 1, 0.5); /* far too few */
  check_rest(2500, AREA_CELLS, 0, 0.5);
}

/* The message with which the first step fails. */
static void expect_refusal(const struct scene *scene, int threads)
{
  struct status status;
  struct simulation *simulation = start(scene);
  omp_set_num_threads(threads);
  cr_expect_not(simulation_advance(simulation, 1, &status));
  cr_expect(strstr(status.message, "sub-steps a step, more than 1000000: use a smaller contact.stiffness"), "%s",
            status.message);
  simulation_destroy(simulation);
}

/* Contacts of a random few of so many discs, in order. */
static struct contact_states random_states(gsl_rng *random, uint32_t discs)
{
  struct contact_states memory = {0};
  struct status status;
  cr_assert(states_reserve(&memory, discs * (discs + 7) / 2, &status), "%s", status.message);
  for (int sides = 0; sides < 2; sides++)
    for (uint32_t a = 0; a < discs; a++)
      for (uint32_t b = sides ? 0 : a + 1; b < (sides ? 4 : discs); b++)
        if (gsl_rng_uniform(random) < 0.5)
          states_add(&memory, a, sides ? contact_sides + b : b,
                     &(struct contact_state){.stored = gsl_rng_uniform(random)});
  return memory;
}

static bool pass(struct contact_states *memory, uint32_t discs, char *bytes, size_t size, bool saving,
                 struct status *status)
{
  struct store store = {.stream = fmemopen(bytes, size, saving ? "wb" : "rb"), .path = "memory", .saving = saving};
  const bool passed = states_store(memory, discs, &store, status);
  fclose(store.stream);
  return passed;
}

/* A disc that rises against the top side, or a fixed disc below it. */
static void expect_rest(double density, double viscosity, bool held)
{
  struct scene scene = scene_box(24, 30, viscosity, SIDES_CLOSED);
  struct simulation *simulation;
  struct status status;
  scene.fluid.zero_flux = true;
  scene.particles.gravity[1] = -0.009;
  scene_add_disc(&scene, 3, density, 12.3, held ? 21.1 : 27.1);
  if (held) scene_add_disc(&scene, 3, 2, 12.3, 27)->motion = DISC_FIXED;
  cr_assert(simulation_create(&simulation, &scene, &status), "%s", status.message);
  const bool ran = simulation_advance(simulation, 6000, &status);
  const struct discs *d = simulation_discs(simulation);
  cr_expect(ran, "density %g, viscosity %g: %s", density, viscosity, ran ? "" : status.message);
  cr_expect_lt(hypot(d->vx[0], d->vy[0]), held ? 0.01 : 1e-4, "density %g, viscosity %g: at (%g, %g)", density,
               viscosity, d->x[0], d->y[0]); /* a disc on a disc may roll off */
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* If the inertia within a step is negative for a combination of motions, the discs oscillate until they diverge. */
Test(rest, light_discs_against_a_wall_or_a_disc_stay_there_at_any_viscosity)
{
  static const double densities[] = {0.01, 0.1, 0.3}, viscosities[] = {0.3, 1, 3, 10};
  for (int d = 0; d < 3; d++)
    for (int v = 0; v < 4; v++)
      for (int held = 0; held < 2; held++) expect_rest(densities[d], viscosities[v], held);
}

/* The deepest overlap allowed at the start: with the bottom side, or of two discs. */
static void expect_to_leave(double radius, double density, double viscosity, bool pair)
{
  const int size = (int)(4 * radius) + 8;
  struct scene scene = scene_box(size, size, viscosity, SIDES_CLOSED);
  struct simulation *simulation;
  struct status status;
  const double low = pair ? size / 2.0 - radius + 4 : radius - 4;
  scene_add_disc(&scene, radius, density, size / 2.0 + 0.3, low);
  if (pair) scene_add_disc(&scene, radius, density, size / 2.0 + 0.3, low + 2 * radius - 8);
  cr_assert(simulation_create(&simulation, &scene, &status), "%s", status.message);
  const bool ran = simulation_advance(simulation, density > 1 ? 1500 : 800, &status);
  const struct discs *d = simulation_discs(simulation);
  const double depth = pair ? 2 * radius - (d->y[1] - d->y[0]) : radius - d->y[0];
  cr_expect(ran, "R = %g, density %g, viscosity %g, pair %d: %s", radius, density, viscosity, pair,
            ran ? "" : status.message);
  cr_expect_lt(depth, pair ? 4 : 3, "R = %g, density %g, viscosity %g, pair %d: still %g cells deep", radius, density,
               viscosity, pair, depth);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

Test(rest, discs_that_start_in_a_wall_or_in_each_other_come_out_without_divergence)
{
  static const double densities[] = {0.05, 1, 50}, viscosities[] = {0.005, 0.5};
  for (int d = 0; d < 3; d++)
    for (int v = 0; v < 2; v++)
      for (int pair = 0; pair < 2; pair++)
        for (int k = 0; k < 2; k++) expect_to_leave(k ? 10 : 5, densities[d], viscosities[v], pair);
}

/* Number of overlaps by a loop over all pairs and sides; *depth: the largest. */
static size_t overlaps_one_by_one(const struct scene *scene, double *depth)
{
  const int *size = scene->domain.size;
  size_t count = 0;
  for (size_t i = 0; i < scene->particles.count; i++) {
    const struct disc_spec *a = &scene->particles.discs[i];
    for (size_t j = i + 1; j < scene->particles.count; j++) {
      const struct disc_spec *b = &scene->particles.discs[j];
      const double dx = remainder(b->position[0] - a->position[0], size[0]), dy = b->position[1] - a->position[1];
      const double overlap = a->radius + b->radius - hypot(dx, dy);
      if (overlap > 0 && (a->motion == DISC_FREE || b->motion == DISC_FREE)) count++, *depth += overlap;
    }
    const double beyond[2] = {a->radius - a->position[1], a->position[1] + a->radius - size[1]};
    for (int k = 0; k < 2; k++)
      if (beyond[k] > 0 && a->motion == DISC_FREE) count++, *depth += beyond[k];
  }
  return count;
}

Test(overlap, at_the_start_is_found_between_all_discs_and_with_all_sides)
{
  struct scene scene = scene_box(50, 40, 0.05, SIDES_PERIODIC);
  struct case_overlaps found;
  struct status status;
  double expected = 0, sum = 0;
  scene.domain.side[SIDE_BOTTOM].type = scene.domain.side[SIDE_TOP].type = SIDE_WALL;
  for (int k = 0; k < 60; k++)
    scene_add_disc(&scene, 1 + k % 7, 1, fmod(17.3 * k, 50), fmod(11.9 * k, 40))->motion =
        k % 3 ? DISC_FREE : DISC_FIXED;
  const size_t count = overlaps_one_by_one(&scene, &expected);
  cr_assert(case_overlaps_find(&scene, scene.particles.count, &found, &status));
  for (size_t k = 0; k < found.count; k++) sum += found.list[k].depth;
  cr_expect_gt(count, 50);
  cr_expect_eq(found.count, count, "%zu, not %zu", found.count, count);
  cr_expect_float_eq(sum, expected, 1e-9);
  case_overlaps_clear(&found);
  scene_clear(&scene);
}

Test(states, asked_for_in_order_are_found_each_and_no_other)
{
  enum { DISCS = 9 };
  gsl_rng *random = random_from(4), *again = random_from(4);
  struct contact_states states = random_states(random, DISCS);
  size_t at = 0, found = 0;
  for (int sides = 0; sides < 2; sides++)
    for (uint32_t a = 0; a < DISCS; a++)
      for (uint32_t b = sides ? 0 : a + 1; b < (sides ? 4 : DISCS); b++) {
        const struct contact_state *state = states_next(&states, &at, a, sides ? contact_sides + b : b);
        const bool saved = gsl_rng_uniform(again) < 0.5;
        cr_expect_eq(state != NULL, saved, "%u, %u", a, b);
        if (saved) cr_expect_eq(state ? state->stored : -1, gsl_rng_uniform(again));
        found += saved;
      }
  cr_expect_eq(found, states.count);
  states_destroy(&states);
  gsl_rng_free(random);
  gsl_rng_free(again);
}

Test(states, come_back_whole_and_are_refused_in_words_where_a_run_cannot_have_left_them)
{
  enum {
    DISCS = 6,
    HEAD = sizeof(uint64_t),
    ENTRY = 8 + sizeof(struct contact_state),
    ROOM = HEAD + DISCS * (DISCS + 7) / 2 * ENTRY
  };
  static const double wrong[] = {NAN, INFINITY, -1};
  static const uint32_t far = DISCS;
  static const uint64_t many = DISCS * (DISCS + 7) / 2 + 1;
  char bytes[ROOM] = {0}, again[ROOM] = {0};
  struct status status;
  gsl_rng *random = random_from(5);
  struct contact_states memory = random_states(random, DISCS), other = {0};
  cr_assert(memory.count > 2 && pass(&memory, DISCS, bytes, ROOM, true, &status), "%s", status.message);
  cr_assert(pass(&other, DISCS, bytes, ROOM, false, &status) && pass(&other, DISCS, again, ROOM, true, &status));
  cr_expect_eq(memcmp(bytes, again, ROOM), 0);
  const struct {
    size_t at, size;
    const void *with;
  } spoilt[] = {{0, sizeof many, &many},
                {HEAD, sizeof far, &far},
                {HEAD + 4, sizeof far, &far},
                {HEAD, ENTRY, bytes + HEAD + ENTRY}, /* a duplicate */
                {HEAD + 8, sizeof(double), &wrong[0]},
                {HEAD + 8, sizeof(double), &wrong[2]},
                {HEAD + 16, sizeof(double), &wrong[1]},
                {HEAD + 24, sizeof(double), &wrong[0]},
                {HEAD + 32, sizeof(double), &wrong[1]}};
  for (size_t k = 0; k < sizeof spoilt / sizeof spoilt[0]; k++) {
    memcpy(again, bytes, ROOM);
    memcpy(again + spoilt[k].at, spoilt[k].with, spoilt[k].size);
    status.message[0] = 0;
    cr_expect(!pass(&other, DISCS, again, ROOM, false, &status) && strstr(status.message, "cannot read memory: "),
              "%zu: %s", k, status.message);
  }
  states_destroy(&memory);
  states_destroy(&other);
  gsl_rng_free(random);
}

Test(contacts, too_stiff_to_be_resolved_are_refused_by_any_number_of_threads)
{
  struct scene pair = scene_box(64, 48, 0.05, SIDES_CLOSED);
  scene_add_disc(&pair, 8, 1.2, 30, 24);
  scene_add_disc(&pair, 8, 1.2, 45, 24);
  pair.contact.stiffness = 1e30;
  expect_refusal(&pair, 1);
  scene_clear(&pair);
  struct scene crowd = scene_crowd(256, 256, 4, 8, 1);
  crowd.contact.stiffness = 1e30;
  expect_refusal(&crowd, 1);
  expect_refusal(&crowd, 4);
  scene_clear(&crowd);
}

Test(contacts, of_a_crowd_are_the_same_bits_for_any_number_of_threads)
{
  enum { STEPS = 25 };
  struct scene crowd = scene_crowd(160, 160, 4, 8, 0.5);
  crowd.contact.stiffness = 30;
  const size_t count = crowd.particles.count, bytes = count * sizeof(double);
  double *state[2] = {malloc(4 * bytes), malloc(4 * bytes)};
  for (int threads = 1; threads <= 3; threads++) {
    omp_set_num_threads(threads);
    struct simulation *simulation = start(&crowd);
    advance(simulation, STEPS);
    const struct discs *d = simulation_discs(simulation);
    double *const arrays[] = {d->x, d->vy, d->omega, d->contact_fx};
    for (size_t k = 0; k < 4; k++) memcpy(state[threads > 1] + k * count, arrays[k], bytes);
    struct simulation_report report;
    simulation_report(simulation, &report);
    cr_expect_gt(report.max_substeps, 1);
    cr_expect(threads == 1 || memcmp(state[0], state[1], 4 * bytes) == 0, "%d threads", threads);
    simulation_destroy(simulation);
  }
  for (int k = 0; k < 2; k++) free(state[k]);
  scene_clear(&crowd);
}

/* Linear springs of equal dry discs need the same number in each step. The energy of springs limits impulses with too few
 * sub-steps alone, which would change the last bits. */
Test(contacts, of_a_fixed_number_of_sub_steps_that_suffices_have_the_bits_of_the_automatic_one)
{
  struct scene crowd = scene_crowd(160, 160, 4, 8, 0.5);
  crowd.particles.gravity[1] *= 0.01;
  scene_dry(&crowd);
  crowd.contact.law = SPRING_LINEAR;
  crowd.contact.stiffness = 30;
  crowd.contact.friction = 0.5;
  const size_t count = crowd.particles.count;
  double *state[2];
  for (int fixed = 0; fixed < 2; fixed++) {
    struct simulation *simulation = start(&crowd);
    advance(simulation, 50);
    const struct discs *d = simulation_discs(simulation);
    const double *const arrays[] = {d->x, d->vy, d->omega, d->contact_torque};
    state[fixed] = malloc(4 * count * sizeof *state[fixed]);
    for (size_t k = 0; k < 4; k++) memcpy(state[fixed] + k * count, arrays[k], count * sizeof(double));
    struct simulation_report report;
    simulation_report(simulation, &report);
    cr_assert_gt(report.max_substeps, 1);
    crowd.contact.substeps = report.max_substeps;
    simulation_destroy(simulation);
  }
  cr_expect(memcmp(state[0], state[1], 4 * count * sizeof(double)) == 0);
  for (int k = 0; k < 2; k++) free(state[k]);
  scene_clear(&crowd);
}

/* Discs that are put where they overlap, at the start or later, hold the energy of that contact, and part by it; no faster
 * than it allows. */
static void expect_parting(bool wall, double stiffness, bool later)
{
  struct scene scene = scene_box(80, 60, 0.01, SIDES_CLOSED);
  const double radius = 8, overlap = 0.5, density = 20, mass = density * M_PI * radius * radius;
  const double x = wall ? radius - overlap : 30.2;
  scene.contact.stiffness = stiffness;
  scene.contact.damping = 0;
  scene_add_disc(&scene, radius, density, later ? x + 6 : x, 30.1);
  if (!wall) scene_add_disc(&scene, radius, density, later ? 60 : x + 2 * radius - overlap, 30.1);
  struct simulation *simulation = start(&scene);
  const struct discs *d = simulation_discs(simulation);
  struct status status;
  advance(simulation, later ? 3 : 0);
  d->x[0] = x;
  if (!wall) d->x[1] = x + 2 * radius - overlap;
  if (later) cr_assert(simulation_changed(simulation, &status), "%s", status.message);
  /* force alpha k c delta^1.5 at small overlap; each disc of a pair moves by half of the overlap */
  const double c = 4. / 3 * sqrt(2 * (wall ? radius : radius / 2)), force = 0.3 * stiffness * c;
  const double energy = 0.4 * force * pow(overlap, 2.5), most = sqrt(2 * (wall ? energy : energy / 2) / mass);
  double fastest = 0;
  for (int step = 0; step < 400; step++) {
    advance(simulation, 1);
    fastest = fmax(fastest, fabs(d->vx[0]));
  }
  cr_expect(fastest > 0.7 * most && fastest < 1.05 * most, "wall %d, stiffness %g, later %d: %g of %g", wall, stiffness,
            later, fastest, most);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

Test(contacts, of_discs_placed_with_an_overlap_separate_them_with_the_stored_energy)
{
  for (int k = 0; k < 8; k++) expect_parting(k & 1, k & 2 ? 20 : 2, k & 4);
}
