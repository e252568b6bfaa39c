#include "spectral.h"

#include "base/memory.h"

#include <complex.h>
#include <fftw3.h>
#include <math.h>
#include <stdlib.h>

enum { REALS = 3, STAGES = 4 };

struct spectral {
  int n;       /* points a side */
  size_t half; /* coefficients: n rows of n/2 + 1 */
  double viscosity;
  double complex *w;  /* vorticity */
  double complex *at; /* vorticity at a Runge-Kutta stage */
  double complex *rate[STAGES];
  double complex *work;
  double *real[REALS];
  fftw_plan to_real[REALS];   /* from work */
  fftw_plan from_real[REALS]; /* to work */
};

static double wave_x(const struct spectral *s, size_t at)
{
  return 2 * M_PI * (double)(at % ((size_t)s->n / 2 + 1));
}

static double wave_y(const struct spectral *s, size_t at)
{
  const int row = (int)(at / ((size_t)s->n / 2 + 1));
  return 2 * M_PI * (row <= s->n / 2 ? row : row - s->n);
}

static bool is_kept(const struct spectral *s, size_t at)
{
  const double largest = 2 * M_PI * s->n / 3.0;
  return wave_x(s, at) < largest && fabs(wave_y(s, at)) < largest;
}

void spectral_destroy(struct spectral *s)
{
  if (!s) return;
  for (int k = 0; k < REALS; k++) {
    if (s->to_real[k]) fftw_destroy_plan(s->to_real[k]);
    if (s->from_real[k]) fftw_destroy_plan(s->from_real[k]);
    free(s->real[k]);
  }
  for (int k = 0; k < STAGES; k++) free(s->rate[k]);
  free(s->w);
  free(s->at);
  free(s->work);
  free(s);
}

static bool allocate(struct spectral *s, struct status *status)
{
  static const char what[] = "the spectral solver";
  const size_t points = (size_t)s->n * (size_t)s->n;
  bool ok = (s->w = memory_allocate(s->half, sizeof *s->w, what, status)) &&
            (s->at = memory_allocate(s->half, sizeof *s->at, what, status)) &&
            (s->work = memory_allocate(s->half, sizeof *s->work, what, status));
  for (int k = 0; ok && k < STAGES; k++) ok = (s->rate[k] = memory_allocate(s->half, sizeof *s->w, what, status));
  for (int k = 0; ok && k < REALS; k++) ok = (s->real[k] = memory_allocate(points, sizeof(double), what, status));
  return ok;
}

bool spectral_create(struct spectral **spectral, int n, double viscosity, struct status *status)
{
  struct spectral *s = *spectral = memory_allocate(1, sizeof *s, "the spectral solver", status);
  if (!s) return false;
  s->n = n;
  s->half = (size_t)n * ((size_t)n / 2 + 1);
  s->viscosity = viscosity;
  bool ok = allocate(s, status);
  for (int k = 0; ok && k < REALS; k++) {
    s->to_real[k] = fftw_plan_dft_c2r_2d(n, n, s->work, s->real[k], FFTW_ESTIMATE);
    s->from_real[k] = fftw_plan_dft_r2c_2d(n, n, s->real[k], s->work, FFTW_ESTIMATE);
    ok = (s->to_real[k] && s->from_real[k]) || status_fail(status, DELBM_FAILED, "FFTW cannot transform %d^2", n);
  }
  if (ok) return true;
  spectral_destroy(s);
  *spectral = NULL;
  return false;
}

/* Coefficients of real[k], without the wave numbers that alias in products. */
static void transform(struct spectral *s, int k)
{
  fftw_execute(s->from_real[k]);
  const double scale = 1 / ((double)s->n * s->n);
  for (size_t i = 0; i < s->half; i++) s->work[i] = is_kept(s, i) ? s->work[i] * scale : 0;
}

void spectral_start(struct spectral *s, double (*vorticity)(double x, double y))
{
  for (int y = 0; y < s->n; y++)
    for (int x = 0; x < s->n; x++)
      s->real[0][(size_t)y * (size_t)s->n + (size_t)x] = vorticity((double)x / s->n, (double)y / s->n);
  transform(s, 0);
  for (size_t i = 0; i < s->half; i++) s->w[i] = s->work[i];
  s->w[0] = 0;
}

/* Coefficient of a quantity that is linear in the vorticity. */
static double complex coefficient(const struct spectral *s, enum spectral_quantity quantity, double complex w,
                                  size_t at)
{
  const double kx = wave_x(s, at), ky = wave_y(s, at), k2 = kx * kx + ky * ky;
  if (!(k2 > 0)) return 0;
  const double complex ux = I * ky * w / k2, uy = -I * kx * w / k2;
  switch (quantity) {
  case SPECTRAL_UX:
    return ux;
  case SPECTRAL_UY:
    return uy;
  case SPECTRAL_UX_X:
    return I * kx * ux;
  case SPECTRAL_UX_Y:
    return I * ky * ux;
  default:
    return I * kx * uy;
  }
}

static void to_points(struct spectral *s, enum spectral_quantity quantity, const double complex *w, int k)
{
  for (size_t i = 0; i < s->half; i++) s->work[i] = coefficient(s, quantity, w[i], i);
  fftw_execute(s->to_real[k]);
}

/* -div (u w) for the vorticity in s->at. */
static void take_rate(struct spectral *s, double complex *rate)
{
  const size_t points = (size_t)s->n * (size_t)s->n;
  to_points(s, SPECTRAL_UX, s->at, 0);
  to_points(s, SPECTRAL_UY, s->at, 1);
  for (size_t i = 0; i < s->half; i++) s->work[i] = s->at[i];
  fftw_execute(s->to_real[2]);
  for (size_t i = 0; i < points; i++) {
    s->real[0][i] *= s->real[2][i];
    s->real[1][i] *= s->real[2][i];
  }
  transform(s, 0);
  for (size_t i = 0; i < s->half; i++) rate[i] = -I * wave_x(s, i) * s->work[i];
  transform(s, 1);
  for (size_t i = 0; i < s->half; i++) rate[i] -= I * wave_y(s, i) * s->work[i];
}

/* Factor of viscous decay of coefficient `at` over `time`. */
static double decay(const struct spectral *s, size_t at, double time)
{
  const double kx = wave_x(s, at), ky = wave_y(s, at);
  return exp(-s->viscosity * (kx * kx + ky * ky) * time);
}

static void advance_once(struct spectral *s, double h, const double *half_step)
{
  double complex **r = s->rate;
  for (size_t i = 0; i < s->half; i++) s->at[i] = s->w[i];
  take_rate(s, r[0]);
  for (size_t i = 0; i < s->half; i++) s->at[i] = half_step[i] * (s->w[i] + h / 2 * r[0][i]);
  take_rate(s, r[1]);
  for (size_t i = 0; i < s->half; i++) s->at[i] = half_step[i] * s->w[i] + h / 2 * r[1][i];
  take_rate(s, r[2]);
  for (size_t i = 0; i < s->half; i++) s->at[i] = half_step[i] * (half_step[i] * s->w[i] + h * r[2][i]);
  take_rate(s, r[3]);
  for (size_t i = 0; i < s->half; i++) {
    const double e = half_step[i];
    s->w[i] = e * e * (s->w[i] + h / 6 * r[0][i]) + h / 6 * (2 * e * (r[1][i] + r[2][i]) + r[3][i]);
  }
}

bool spectral_advance(struct spectral *s, double step, int steps, struct status *status)
{
  double *half_step = memory_allocate(s->half, sizeof *half_step, "the spectral solver", status);
  if (!half_step) return false;
  for (size_t i = 0; i < s->half; i++) half_step[i] = decay(s, i, step / 2);
  for (int k = 0; k < steps; k++) advance_once(s, step, half_step);
  free(half_step);
  return true;
}

/* Pressure's coefficients into s->at: lap p = -2 (ux_x^2 + ux_y uy_x). */
static void take_pressure(struct spectral *s)
{
  const size_t points = (size_t)s->n * (size_t)s->n;
  for (int k = 0; k < REALS; k++) to_points(s, SPECTRAL_UX_X + k, s->w, k);
  for (size_t i = 0; i < points; i++)
    s->real[0][i] = -2 * (s->real[0][i] * s->real[0][i] + s->real[1][i] * s->real[2][i]);
  transform(s, 0);
  for (size_t i = 0; i < s->half; i++) {
    const double kx = wave_x(s, i), ky = wave_y(s, i), k2 = kx * kx + ky * ky;
    s->at[i] = k2 > 0 ? -s->work[i] / k2 : 0;
  }
}

/* Adds a coefficient of waves (mx, my) to its alias on count^2 points at the centres of cells. */
static void add_wave(fftw_complex *to, int count, int mx, int my, double complex value)
{
  const int x = (mx % count + count) % count, y = (my % count + count) % count;
  value *= cexp(I * M_PI * (mx + my) / count);
  to[(size_t)y * (size_t)count + (size_t)x] += value;
}

bool spectral_sample(struct spectral *s, enum spectral_quantity quantity, int count, double *values,
                     struct status *status)
{
  const size_t points = (size_t)count * (size_t)count;
  fftw_complex *series = memory_allocate(points, sizeof *series, "the spectral solver", status);
  fftw_plan plan = series ? fftw_plan_dft_2d(count, count, series, series, FFTW_BACKWARD, FFTW_ESTIMATE) : NULL;
  if (quantity == SPECTRAL_PRESSURE) take_pressure(s);
  for (size_t i = 0; plan && i < s->half; i++) {
    if (!is_kept(s, i)) continue;
    const int mx = (int)lround(wave_x(s, i) / (2 * M_PI)), my = (int)lround(wave_y(s, i) / (2 * M_PI));
    const double complex value = quantity == SPECTRAL_PRESSURE ? s->at[i] : coefficient(s, quantity, s->w[i], i);
    add_wave(series, count, mx, my, value);
    if (mx > 0)
      add_wave(series, count, -mx, -my, conj(value)); /* only half of the coefficients of a real series are stored */
  }
  if (plan) fftw_execute(plan);
  for (size_t i = 0; plan && i < points; i++) values[i] = creal(series[i]);
  const bool ok = plan || (series && status_fail(status, DELBM_FAILED, "FFTW cannot transform %d^2", count));
  if (plan) fftw_destroy_plan(plan);
  free(series);
  return ok;
}
