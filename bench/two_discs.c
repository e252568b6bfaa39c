/* Velocity as w = u + i v = f(z) - z conj(f'(z)) + conj(h(z)) (Goursat), f and h analytic outside the discs. With
 * zeta = z - z_k relative to the centre of disc k, a solution is a sum over both discs of
 *   stokeslet:  -F/(8 pi mu) (2 ln|zeta|) + conj(F)/(8 pi mu) zeta/conj(zeta), F the force on the fluid, -F for disc b;
 *   f = c zeta^-n:  c zeta^-n + n conj(c) zeta conj(zeta)^-(n+1),  n >= 1;
 *   h:              d conj(zeta)^-n,  n >= 1; d imaginary at n = 1: rotlet of torque 4 pi mu |d|; real: source, excluded.
 * With n along the real axis, approach has real coefficients, slide and spin imaginary ones. The velocity on both
 * circles determines them, and a common velocity U for which the pair is free of force, in the least squares. Terms of
 * a disc decay with n as exp(-n s_k), s_k the bipolar coordinate of its surface. */
#include "two_discs.h"

#include <complex.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdlib.h>

struct basis {
  double centre[2], radius[2];
  double complex unit; /* 1 for approach, i for slide and spin */
  int order;           /* largest n */
};

/* Columns: F, U, then for each disc c_1 .. c_order and d_1 .. d_order. */
static int column(const struct basis *b, int disc, bool of_h, int n)
{
  return 2 + (2 * disc + of_h) * b->order + n - 1;
}

static int columns_of(const struct basis *b)
{
  return 2 + 4 * b->order;
}

/* Contributions of all terms to the velocity at z. */
static void fill_row(const struct basis *b, double complex z, double complex *row)
{
  row[0] = 0;
  row[1] = -b->unit; /* on the left of w - U = V */
  for (int k = 0; k < 2; k++) {
    const double complex zeta = (z - b->centre[k]) / b->radius[k];
    const double complex force = (k ? -1 : 1) * b->unit / (8 * M_PI);
    row[0] += -2 * force * log(cabs(zeta) * b->radius[k]) + conj(force) * zeta / conj(zeta);
    double complex power = 1;
    for (int n = 1; n <= b->order; n++) {
      power /= zeta;
      row[column(b, k, false, n)] = b->unit * power + n * conj(b->unit) * zeta * conj(power / zeta);
      /* the source in place of which a column of zeros would be singular is a stronger pole, past the last */
      const bool source = n == 1 && cimag(b->unit) == 0;
      row[column(b, k, true, n)] = b->unit * conj(source ? cpow(zeta, -(b->order + 1)) : power);
    }
  }
}

/* Velocity of the surface of disc k at z, without U. */
static double complex surface_velocity(const struct basis *b, const struct two_discs *d, int k, double complex z)
{
  const double complex translation = k == 0 ? d->approach + I * d->slide : 0;
  return translation + I * d->spin[k] * (z - b->centre[k]);
}

/* Two equations a point, on the upper half circles. */
static void fill(const struct basis *b, const struct two_discs *d, int points, double complex *row, gsl_matrix *matrix,
                 gsl_vector *right)
{
  for (int k = 0; k < 2; k++)
    for (int p = 0; p < points; p++) {
      const double angle = M_PI * (p + 0.5) / points;
      const double complex z = b->centre[k] + b->radius[k] * cexp(I * angle), v = surface_velocity(b, d, k, z);
      const size_t at = 2 * (size_t)(k * points + p);
      fill_row(b, z, row);
      gsl_vector_set(right, at, creal(v));
      gsl_vector_set(right, at + 1, cimag(v));
      for (int c = 0; c < columns_of(b); c++) {
        gsl_matrix_set(matrix, at, (size_t)c, creal(row[c]));
        gsl_matrix_set(matrix, at + 1, (size_t)c, cimag(row[c]));
      }
    }
}

static bool solve(const struct basis *b, const struct two_discs *d, gsl_vector **solution)
{
  const int points = 2 * b->order + 10;
  const size_t rows = 4 * (size_t)points, columns = (size_t)columns_of(b);
  gsl_matrix *matrix = gsl_matrix_alloc(rows, columns);
  gsl_vector *right = gsl_vector_alloc(rows), *residual = gsl_vector_alloc(rows), *tau = gsl_vector_alloc(columns);
  double complex *row = calloc(columns, sizeof *row);
  *solution = gsl_vector_alloc(columns);
  bool ok = matrix && right && residual && tau && row && *solution;
  if (ok) {
    fill(b, d, points, row, matrix, right);
    ok = gsl_linalg_QR_decomp(matrix, tau) == GSL_SUCCESS &&
         gsl_linalg_QR_lssolve(matrix, tau, right, *solution, residual) == GSL_SUCCESS;
  }
  if (matrix) gsl_matrix_free(matrix);
  if (right) gsl_vector_free(right);
  if (residual) gsl_vector_free(residual);
  if (tau) gsl_vector_free(tau);
  free(row);
  return ok;
}

static struct basis basis_of(const struct two_discs *d, bool approach)
{
  const double ra = d->radius[0], rb = d->radius[1], distance = ra + rb + d->gap;
  const double offset = (distance * distance + (ra - rb) * (ra + rb)) / (2 * distance); /* of the radical axis from a */
  const double s = fmin(acosh(offset / ra), acosh((distance - offset) / rb));
  return (struct basis){.centre = {0, distance},
                        .radius = {ra, rb},
                        .unit = approach ? 1 : I,
                        .order = (int)fmin(200, fmax(12, ceil(12 / s)))};
}

bool two_discs_force(const struct two_discs *d, struct two_discs_force *force)
{
  *force = (struct two_discs_force){0};
  for (int approach = 0; approach < 2; approach++) {
    const struct basis b = basis_of(d, approach);
    const struct two_discs part = {.radius = {d->radius[0], d->radius[1]},
                                   .gap = d->gap,
                                   .approach = approach ? d->approach : 0,
                                   .slide = approach ? 0 : d->slide,
                                   .spin = {approach ? 0 : d->spin[0], approach ? 0 : d->spin[1]}};
    gsl_vector *x;
    const bool ok = solve(&b, &part, &x);
    if (ok && approach) force->normal = gsl_vector_get(x, 0);
    if (ok && !approach) {
      force->tangential = gsl_vector_get(x, 0);
      for (int k = 0; k < 2; k++)
        force->torque[k] = 4 * M_PI * b.radius[k] * gsl_vector_get(x, (size_t)column(&b, k, true, 1));
    }
    if (x) gsl_vector_free(x);
    if (!ok) return false;
  }
  return true;
}
