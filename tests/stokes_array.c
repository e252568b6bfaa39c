#include "stokes_array.h"

#include <gsl/gsl_multifit.h>
#include <math.h>

enum { TERMS = 16, UNKNOWNS = 2 * TERMS + 1, POINTS = 48, MAX_EDGES = 3, FIELDS = 5 };

/* Stream function, velocity, Laplacian of the stream function, and its harmonic conjugate, the pressure. */
struct flow {
  double field[FIELDS];
};

struct cell {
  int edges;
  double shift[MAX_EDGES][2]; /* lattice vector normal to the edge */
  double length;              /* of an edge; lattice vectors have length 1 */
  double area;
};

static struct cell cell_of(enum stokes_lattice lattice)
{
  const double h = sqrt(3) / 2;
  if (lattice == STOKES_SQUARE) return (struct cell){2, {{1, 0}, {0, 1}}, 1, 1};
  return (struct cell){3, {{1, 0}, {0.5, h}, {-0.5, h}}, 1 / sqrt(3), h};
}

/* Radial parts at s = r/a of function `k` of order n: f(1) = f'(1) = 0. f, f', and the Laplacian c_in s^n + c_out s^-n. */
struct radial {
  double f, slope, in, out;
};

static struct radial radial_of(int n, int k, double s)
{
  const double log_s = log(s), up = pow(s, n), down = 1 / up;
  if (n == 1 && k == 0) return (struct radial){s - 1 / s - 2 * s * log_s, 1 + down * down - 2 * (log_s + 1), 0, -4};
  if (n == 1)
    return (struct radial){s * s * s - 1 / s - 4 * s * log_s, 3 * s * s + 1 / (s * s) - 4 * (log_s + 1), 8, -8};
  const double lead = k == 0 ? up : up * s * s, power = k == 0 ? n : n + 2;
  const double b = k == 0 ? n - 1 : n, c = -b - 1;
  return (struct radial){lead + b * down + c * down * s * s,
                         (power * lead - n * b * down + (2 - n) * c * down * s * s) / s, k == 0 ? 0 : 4.0 * (n + 1),
                         c * (4 - 4 * n)};
}

/* Function `index` of the series at a point, for discs of radius a; flow along x is symmetric, so that n is odd. */
static struct flow flow_of(int index, double a, const double at[2])
{
  const int n = 2 * (index / 2) + 1;
  const double r = hypot(at[0], at[1]), s = r / a, cosine = at[0] / r, sine = at[1] / r, angle = atan2(at[1], at[0]);
  const double wave = sin(n * angle), along = cos(n * angle), up = pow(s, n);
  const struct radial q = radial_of(n, index % 2, s);
  const double by_r = q.slope / a * wave, by_angle = n * q.f / r * along;
  return (struct flow){{q.f * wave, by_r * sine + by_angle * cosine, by_angle * sine - by_r * cosine,
                        (q.in * up + q.out / up) * wave / (a * a), (q.in * up - q.out / up) * along / (a * a)}};
}

/* Rows of the equations of a pair of points on opposite edges: all fields are periodic, but for the mean flow U (last
 * unknown) in the stream function, and a pressure gradient of 1. */
static void add_equations(gsl_matrix *left, gsl_vector *right, size_t row, double a, const double from[2],
                          const double shift[2])
{
  const double to[2] = {from[0] + shift[0], from[1] + shift[1]};
  for (int k = 0; k < UNKNOWNS - 1; k++) {
    const struct flow low = flow_of(k, a, from), high = flow_of(k, a, to);
    const double scale = pow(a, k / 2 * 2 + 1);
    for (size_t f = 0; f < FIELDS; f++)
      gsl_matrix_set(left, row + f, (size_t)k, scale * (high.field[f] - low.field[f]));
  }
  gsl_matrix_set(left, row, UNKNOWNS - 1, -shift[1]);
  gsl_vector_set(right, row + FIELDS - 1, -shift[0]);
}

double stokes_array_drag(enum stokes_lattice lattice, double solid_fraction)
{
  const struct cell cell = cell_of(lattice);
  const double a = sqrt(solid_fraction * cell.area / M_PI);
  const size_t rows = (size_t)cell.edges * POINTS * FIELDS;
  gsl_matrix *left = gsl_matrix_calloc(rows, UNKNOWNS), *covariance = gsl_matrix_alloc(UNKNOWNS, UNKNOWNS);
  gsl_vector *right = gsl_vector_calloc(rows), *solution = gsl_vector_alloc(UNKNOWNS);
  gsl_multifit_linear_workspace *work = gsl_multifit_linear_alloc(rows, UNKNOWNS);
  double residual;
  for (int e = 0; e < cell.edges; e++)
    for (int k = 0; k < POINTS; k++) {
      const double *v = cell.shift[e], t = ((k + 0.5) / POINTS - 0.5) * cell.length;
      const double from[2] = {-v[0] / 2 - t * v[1], -v[1] / 2 + t * v[0]};
      add_equations(left, right, FIELDS * ((size_t)e * POINTS + (size_t)k), a, from, v);
    }
  gsl_multifit_linear(left, right, solution, covariance, &residual, work);
  const double speed = gsl_vector_get(solution, UNKNOWNS - 1);
  gsl_multifit_linear_free(work);
  gsl_vector_free(solution);
  gsl_vector_free(right);
  gsl_matrix_free(covariance);
  gsl_matrix_free(left);
  return cell.area / speed;
}

double stokes_array_touching(enum stokes_lattice lattice)
{
  return M_PI / 4 / cell_of(lattice).area;
}
