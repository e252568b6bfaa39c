/* Areas by line tables, in plain loops that vectorise; trip counts are whole vectors, so that none ends in a remainder.
 * */
#include "solid/area.h"

#include <math.h>
#include <stdbool.h>

#define PASTE(a, b)  a##_##b
#define NAME(a, b)   PASTE(a, b)
#define KERNEL(part) NAME(part, VARIANT)

enum { VECTOR = 8 };

static inline int whole_vectors(int n)
{
  return (n + VECTOR - 1) / VECTOR * VECTOR;
}

/* (asin(s) - s)/s^3 as a polynomial in z = s^2 <= 1/4: interpolated at Chebyshev points from the series, error 2e-17.
 * */
static inline double arcsine_rest(double z)
{
  double p = 0.028757851367421566;
  p = p * z - 0.014851887071247204;
  p = p * z + 0.017400879442694021;
  p = p * z + 0.0054575067186403581;
  p = p * z + 0.010322814350185779;
  p = p * z + 0.011479177415184906;
  p = p * z + 0.013971212973552933;
  p = p * z + 0.017352392720869973;
  p = p * z + 0.022372172942149889;
  p = p * z + 0.030381944138531247;
  p = p * z + 0.044642857146355429;
  p = p * z + 0.074999999999984329;
  return p * z + 1.0 / 6;
}

/* asin(t/R) for 0 <= t < R; from t = R/2 on by pi/2 - 2 asin(sqrt((1 - t/R)/2)), where R - t loses nothing. */
static void KERNEL(lines)(double radius, double centre, int first, int count, double *restrict t_of,
                          double *restrict h_of, double *restrict area_of)
{
  const double inverse = 1 / radius, r2 = radius * radius, quarter = M_PI / 4 * r2;
  const int n = whole_vectors(count);
#pragma omp simd
  for (int k = 0; k < n; k++) {
    const double t = (double)(first + k) - centre, away = fabs(t);
    const double inside = radius > away ? radius - away : 0;
    const double x = away * inverse;
    const bool low = x <= 0.5;
    const double z = low ? x * x : 0.5 * inside * inverse, s = low ? x : sqrt(z);
    const double rest = s + s * z * arcsine_rest(z < 0.25 ? z : 0.25);
    const double angle = low ? rest : M_PI / 2 - 2 * rest;
    const double h = sqrt(inside * (radius + away));
    const double area = inside > 0 ? 0.5 * (r2 * angle + away * h) : quarter;
    t_of[k] = t;
    h_of[k] = h;
    area_of[k] = t < 0 ? -area : area;
  }
}

static void KERNEL(corners)(double radius, double t_b, double h_b, double area_b, int count, const double *restrict t,
                            const double *restrict area, double *restrict corner)
{
  const double whole = M_PI * radius * radius, above = 0.5 * whole - 2 * area_b; /* of the part y > b */
  const double left =
      t_b < 0 ? above - 0.5 * whole : above; /* with x > a, of a corner outside and left, less -2 D(a) */
  const int n = whole_vectors(count);
#pragma omp simd
  for (int k = 0; k < n; k++) {
    const double within = 0.25 * whole - area[k] - area_b + t[k] * t_b;
    const double right = t_b < 0 ? 0.5 * whole - 2 * area[k] : 0;
    const double leftward = t_b < 0 ? left - 2 * area[k] : left;
    const double outside = t[k] < 0 ? leftward : right;
    corner[k] = fabs(t[k]) < h_b ? within : outside;
  }
}

static void KERNEL(cells)(const double *restrict low, const double *restrict high, int first, int end, int full,
                          int full_end, double *restrict eps)
{
  const int n = whole_vectors(end - first);
#pragma omp simd
  for (int k = 0; k < n; k++) {
    const int c = first + k;
    double area = low[c] - low[c + 1] - (high[c] - high[c + 1]);
    area = area > 0 ? area : 0; /* round-off */
    area = area < 1 ? area : 1;
    eps[k] = c >= full && c < full_end ? 1 : area;
  }
}

static void KERNEL(weights)(const double *restrict eps, int count, double three_nu, double *restrict weight)
{
  const int n = whole_vectors(count);
#pragma omp simd
  for (int k = 0; k < n; k++) weight[k] = eps[k] * three_nu / ((1 - eps[k]) + three_nu);
}

extern const struct area_kernel KERNEL(area_kernel);
const struct area_kernel KERNEL(area_kernel) = {KERNEL(lines), KERNEL(corners), KERNEL(cells), KERNEL(weights)};
