/* The fluid: lattice identities, and every kernel against the reference on random states and all boundaries. */
#include "fluid/boundary.h"
#include "lattice/moments.h"
#include "reference.h"

#include <criterion/criterion.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>

Test(lattice, weights_are_isotropic_to_fourth_order)
{
  double w = 0, xx = 0, xy = 0, xxyy = 0, xxxx = 0;
  for (int i = 0; i < Q; i++) {
    const double x = d2q9_ex[i], y = d2q9_ey[i];
    w += d2q9_weight[i];
    xx += d2q9_weight[i] * x * x;
    xy += d2q9_weight[i] * x * y;
    xxyy += d2q9_weight[i] * x * x * y * y;
    xxxx += d2q9_weight[i] * x * x * x * x;
  }
  cr_assert_float_eq(w, 1, 1e-15);
  cr_assert_float_eq(xx, 1. / 3, 1e-15);
  cr_assert_float_eq(xy, 0, 1e-15);
  cr_assert_float_eq(xxyy, 1. / 9, 1e-15);
  cr_assert_float_eq(xxxx, 1. / 3, 1e-15);
}

Test(lattice, opposites_are_opposite_and_pair_up)
{
  for (int i = 0; i < Q; i++) {
    const int o = d2q9_opposite[i];
    cr_assert_eq(d2q9_ex[o], -d2q9_ex[i]);
    cr_assert_eq(d2q9_ey[o], -d2q9_ey[i]);
    cr_assert_eq(d2q9_opposite[o], i);
    cr_assert_float_eq(d2q9_weight[o], d2q9_weight[i], 0);
  }
}

Test(lattice, moment_rows_are_orthogonal)
{
  for (int k = 0; k < Q; k++)
    for (int l = 0; l < Q; l++) {
      double dot = 0;
      for (int i = 0; i < Q; i++) dot += moments_matrix[k][i] * moments_matrix[l][i];
      cr_assert_float_eq(dot, k == l ? moments_norm[k] : 0, 0);
    }
}

Test(lattice, equilibrium_moments_agree_with_the_quadratic_equilibrium)
{
  const double rho = 1.07, u[2] = {0.08, -0.05}, u2 = u[0] * u[0] + u[1] * u[1];
  double f[Q], m[Q], expected[Q];
  for (int i = 0; i < Q; i++) {
    const double eu = d2q9_ex[i] * u[0] + d2q9_ey[i] * u[1];
    f[i] = d2q9_weight[i] * rho * (1 + 3 * eu + 4.5 * eu * eu - 1.5 * u2);
  }
  moments_from_populations(f, m);
  moments_equilibrium(rho, rho * u[0], rho * u[1], expected);
  for (int k = 0; k < Q; k++) cr_assert_float_eq(m[k], expected[k], 1e-15, "moment %d", k);
}

/* One comparison: a kernel, a form, a force, and four sides. */
struct setting {
  const struct sweep_kernel *kernel;
  int form; /* -1: fluid alone */
  bool adaptive;
  enum sweep_terms terms;
  struct side side[SIDE_COUNT];
};

enum { NX = 37, NY = 11, CELLS = NX * NY, STEPS = 5 };

struct cover {
  double b[CELLS], bvx[CELLS], bvy[CELLS];
};

static void random_cover(struct cover *cover, gsl_rng *random)
{
  for (int k = 0; k < CELLS; k++) {
    const double b = gsl_rng_uniform(random) < 0.5 ? 0 : gsl_rng_uniform(random) < 0.5 ? 1 : gsl_rng_uniform(random);
    cover->b[k] = b;
    cover->bvx[k] = b * 0.1 * (gsl_rng_uniform(random) - 0.5);
    cover->bvy[k] = b * 0.1 * (gsl_rng_uniform(random) - 0.5);
  }
}

/* The same random state in both, rounded to the precision of the fast kernel. */
static void random_state(struct populations *p, struct reference *r, gsl_rng *random)
{
  for (int k = 0; k < CELLS; k++)
    for (int i = 0; i < Q; i++) {
      const size_t slot = populations_source(p, i, k % NX, k / NX);
      populations_set(p, slot, 0.05 * d2q9_weight[i] * (gsl_rng_uniform(random) - 0.5));
      r->f[k * Q + i] = d2q9_weight[i] + populations_get(p, slot);
    }
}

static void cover_row(const struct cover *cover, int y, enum precision precision, void *buffers[3])
{
  const double *from[3] = {cover->b, cover->bvx, cover->bvy};
  for (int k = 0; k < 3; k++)
    for (int x = 0; x < NX; x++) {
      if (precision == PRECISION_DOUBLE)
        ((double *)buffers[k])[x] = from[k][y * NX + x];
      else
        ((float *)buffers[k])[x] = (float)from[k][y * NX + x];
    }
}

static void fast_step(struct populations *p, struct boundary *boundary, const struct setting *s,
                      const struct sweep_constants *c, const struct cover *cover, bool backwards, double momentum[2])
{
  _Alignas(64) double b[3][NX + 8];
  void *buffers[3] = {b[0], b[1], b[2]};
  for (int k = 0; k < NY; k++) {
    const int y = backwards ? NY - 1 - k : k;
    void *a[Q];
    double sum[2] = {0, 0};
    populations_cells(p, 0, y, a);
    cover_row(cover, y, p->precision, buffers);
    const struct solid_row row = {b[0], b[1], b[2]};
    sweep_row *kernel =
        s->form < 0 ? s->kernel->fluid[s->adaptive][s->terms] : s->kernel->discs[s->form][s->adaptive][s->terms];
    kernel(a, NX, c, s->form < 0 ? NULL : &row, sum);
    boundary_after(boundary, p, y, 0, NX);
    momentum[0] += sum[0];
    momentum[1] += sum[1];
  }
  p->parity ^= 1;
}

static double largest_difference(const struct populations *p, const struct reference *r)
{
  double largest = 0;
  for (int k = 0; k < CELLS; k++) {
    double g[Q];
    populations_cell(p, k % NX, k / NX, g);
    for (int i = 0; i < Q; i++) largest = fmax(largest, fabs(g[i] + d2q9_weight[i] - r->f[k * Q + i]));
  }
  return largest;
}

/* Adds half of the momentum and of the mass of all populations, as the sweep's sums count them. */
static void add_half(const double *f, double momentum[2], double *mass)
{
  for (int k = 0; k < CELLS; k++)
    for (int i = 0; i < Q; i++) {
      momentum[0] += 0.5 * d2q9_ex[i] * f[k * Q + i];
      momentum[1] += 0.5 * d2q9_ey[i] * f[k * Q + i];
      *mass += 0.5 * f[k * Q + i];
    }
}

static double run_setting(const struct setting *s, unsigned long seed)
{
  gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(random, seed);
  struct status status;
  struct populations p;
  struct boundary boundary;
  struct reference r;
  static struct cover cover;
  const bool periodic_y = s->side[SIDE_BOTTOM].type == SIDE_PERIODIC;
  cr_assert(populations_create(&p, NX, NY, periodic_y, s->kernel->precision, &status));
  cr_assert(boundary_create(&boundary, s->side, NX, NY, &status));
  cr_assert(reference_create(&r, NX, NY, &status));
  random_cover(&cover, random);
  random_state(&p, &r, random);
  boundary_reset(&boundary, &p);
  struct sweep_constants c = {.rates = {.s_nu = 1.7, .s_e = 1.4, .s_q = 1.2}};
  /* the speeds of the random state are about this viscosity of 0.006, where the rate changes most */
  if (s->adaptive) c.rates = (struct rates){.s_nu = 1.93, .s_e = 1.4, .s_q = 0.6, .s_q_fast = 1.2};
  if (s->terms != SWEEP_NO_FORCE) {
    c.force[0] = 1e-3, c.force[1] = -2e-3;
    c.uniform[0] = -1e-4, c.uniform[1] = 3e-4;
  }
  struct reference_cover whole = {.form = s->form > 0 ? (enum coupling_form)s->form : FORM_UNIFIED};
  if (s->form >= 0) whole.b = cover.b, whole.bvx = cover.bvx, whole.bvy = cover.bvy;
  double largest = 0;
  for (int step = 0; step < STEPS; step++) {
    double momentum[2] = {0, 0}, expected[2] = {0, 0}, mass = 0;
    fast_step(&p, &boundary, s, &c, &cover, step % 2, momentum);
    add_half(r.f, expected, &mass);
    reference_step(&r, s->side, &c, &whole);
    add_half(r.collided, expected, &mass);
    for (int d = 0; d < 2; d++) expected[d] += (mass * c.force[d] + CELLS * c.uniform[d]) / 2;
    largest = fmax(largest, largest_difference(&p, &r));
    if (s->terms == SWEEP_FORCE_AND_SUM)
      for (int d = 0; d < 2; d++) largest = fmax(largest, fabs(momentum[d] - expected[d]) / CELLS);
  }
  boundary_destroy(&boundary);
  populations_destroy(&p);
  reference_destroy(&r);
  gsl_rng_free(random);
  return largest;
}

/* Every kind of side on every side, and every kind of corner. */
static const struct {
  const char *name;
  struct side side[SIDE_COUNT];
} boxes[] = {
    {"periodic", {{SIDE_PERIODIC, {0}}, {SIDE_PERIODIC, {0}}, {SIDE_PERIODIC, {0}}, {SIDE_PERIODIC, {0}}}},
    {"closed", {{SIDE_WALL, {0}}, {SIDE_WALL, {0}}, {SIDE_WALL, {0}}, {SIDE_WALL, {0}}}},
    {"moving walls",
     {{SIDE_WALL, {0, 0.02}}, {SIDE_WALL, {0, -0.03}}, {SIDE_WALL, {0.01, 0}}, {SIDE_WALL, {-0.05, 0}}}},
    {"channel in x", {{SIDE_PERIODIC, {0}}, {SIDE_PERIODIC, {0}}, {SIDE_WALL, {0}}, {SIDE_WALL, {0.1, 0}}}},
    {"channel in y", {{SIDE_WALL, {0, 0.1}}, {SIDE_WALL, {0}}, {SIDE_PERIODIC, {0}}, {SIDE_PERIODIC, {0}}}},
    {"duct", {{SIDE_INLET, {0.05, 0.01}}, {SIDE_OUTLET, {0}}, {SIDE_WALL, {0}}, {SIDE_WALL, {0}}}},
    {"duct, other way", {{SIDE_OUTLET, {0}}, {SIDE_INLET, {-0.05, 0}}, {SIDE_WALL, {0}}, {SIDE_WALL, {0}}}},
    {"free stream", {{SIDE_INLET, {0.05, 0}}, {SIDE_OUTLET, {0}}, {SIDE_PERIODIC, {0}}, {SIDE_PERIODIC, {0}}}},
    {"upward", {{SIDE_PERIODIC, {0}}, {SIDE_PERIODIC, {0}}, {SIDE_INLET, {0, 0.05}}, {SIDE_OUTLET, {0}}}},
    {"downward", {{SIDE_WALL, {0}}, {SIDE_WALL, {0}}, {SIDE_OUTLET, {0}}, {SIDE_INLET, {0, -0.05}}}},
    {"three outlets", {{SIDE_INLET, {0.05, 0}}, {SIDE_OUTLET, {0}}, {SIDE_OUTLET, {0}}, {SIDE_OUTLET, {0}}}},
    {"slip channel in x", {{SIDE_PERIODIC, {0}}, {SIDE_PERIODIC, {0}}, {SIDE_SLIP, {0}}, {SIDE_WALL, {0.1, 0}}}},
    {"slip channel in y", {{SIDE_SLIP, {0}}, {SIDE_SLIP, {0}}, {SIDE_PERIODIC, {0}}, {SIDE_PERIODIC, {0}}}},
    {"slip duct", {{SIDE_INLET, {0.05, 0.01}}, {SIDE_OUTLET, {0}}, {SIDE_SLIP, {0}}, {SIDE_SLIP, {0}}}},
    {"slip ends", {{SIDE_SLIP, {0}}, {SIDE_SLIP, {0}}, {SIDE_OUTLET, {0}}, {SIDE_INLET, {0, -0.05}}}},
    {"slip corners", {{SIDE_SLIP, {0}}, {SIDE_WALL, {0, 0.03}}, {SIDE_SLIP, {0}}, {SIDE_OUTLET, {0}}}},
    {"slip box", {{SIDE_SLIP, {0}}, {SIDE_SLIP, {0}}, {SIDE_SLIP, {0}}, {SIDE_SLIP, {0}}}},
    {"open ends", {{SIDE_OUTLET, {0}}, {SIDE_OUTLET, {0}}, {SIDE_INLET, {0, 0.05}}, {SIDE_OUTLET, {0}}}},
};

Test(sweep, every_kernel_agrees_with_the_reference_in_every_box)
{
  bool runs;
  const struct sweep_kernel *kernel;
  unsigned long seed = 1;
  for (size_t k = 0; (kernel = sweep_kernel_at(k, &runs)); k++) {
    if (!runs) continue;
    const double tolerance = kernel->precision == PRECISION_DOUBLE ? 2e-15 : 1e-6;
    for (size_t b = 0; b < sizeof boxes / sizeof boxes[0]; b++)
      for (int form = -1; form < FORM_COUNT; form++)
        for (int way = 0; way < 2 * SWEEP_TERMS; way++, seed++) {
          struct setting s = {
              .kernel = kernel, .form = form, .adaptive = way / SWEEP_TERMS, .terms = way % SWEEP_TERMS};
          memcpy(s.side, boxes[b].side, sizeof s.side);
          const double difference = run_setting(&s, seed);
          cr_expect(difference < tolerance, "%s, %s, form %d, adaptive %d, terms %d, seed %lu: %g", kernel->name,
                    boxes[b].name, form, s.adaptive, s.terms, seed, difference);
        }
  }
}

Test(sweep, a_kernel_is_found_by_name_or_refused_in_words)
{
  struct status status;
  const struct sweep_kernel *best = sweep_find(NULL, PRECISION_DOUBLE, &status);
  cr_assert(best);
  cr_assert_eq(sweep_find(best->name, PRECISION_DOUBLE, &status), best);
  cr_assert_str_eq(sweep_find("baseline", PRECISION_SINGLE, &status)->name, "baseline-single");
  cr_assert_null(sweep_find("baselin", PRECISION_DOUBLE, &status));
  cr_assert_eq(status.code, DELBM_INVALID);
  cr_assert(strstr(status.message, "baselin"));
}
