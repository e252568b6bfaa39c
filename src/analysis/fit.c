#include "analysis/fit.h"

#include <fftw3.h>
#include <gsl/gsl_fit.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>

struct line fit_line(const double *x, const double *y, size_t count)
{
  struct line line = {NAN, NAN, NAN};
  if (count < 2) return line;
  double c00, c01, c11, residual;
  gsl_fit_linear(x, 1, y, 1, count, &line.intercept, &line.slope, &c00, &c01, &c11, &residual);
  const double total = gsl_stats_tss(y, 1, count);
  line.r2 = total > 0 ? 1 - residual / total : 1;
  return line;
}

struct spread fit_spread(const double *y, size_t count)
{
  if (count == 0) return (struct spread){NAN, NAN};
  const double mean = gsl_stats_mean(y, 1, count);
  return (struct spread){mean, sqrt(gsl_stats_tss_m(y, 1, count, mean) / (double)count)};
}

/* The series about its mean, under a Hann window. */
static void window(const double *y, size_t count, double *to)
{
  const double mean = gsl_stats_mean(y, 1, count);
  for (size_t k = 0; k < count; k++) to[k] = (y[k] - mean) * 0.5 * (1 - cos(2 * M_PI * (double)k / (double)count));
}

static struct oscillation strongest(fftw_complex *line, size_t count)
{
  size_t at = 1;
  const size_t lines = count / 2 + 1;
  for (size_t k = 2; k + 1 < lines; k++)
    if (hypot(line[k][0], line[k][1]) > hypot(line[at][0], line[at][1])) at = k;
  const double here = hypot(line[at][0], line[at][1]);
  if (!(here > 0)) return (struct oscillation){0, 0};
  const double before = log(hypot(line[at - 1][0], line[at - 1][1]) / here);
  const double after = log(hypot(line[at + 1][0], line[at + 1][1]) / here);
  const double bend = before + after;
  double shift = bend < 0 && isfinite(bend) ? 0.5 * (before - after) / bend : 0;
  if (at == 1) shift = fmax(shift, 0); /* the spectral line before it has the residual mean */
  const double peak = here * exp(isfinite(bend) ? -0.25 * (before - after) * shift : 0);
  return (struct oscillation){((double)at + shift) / (double)count, 4 * peak / (double)count};
}

bool fit_oscillation(const double *y, size_t count, struct oscillation *oscillation, struct status *status)
{
  *oscillation = (struct oscillation){0, 0};
  if (count < 8) return true;
  double *series = fftw_alloc_real(count);
  fftw_complex *lines = fftw_alloc_complex(count / 2 + 1);
  fftw_plan plan = series && lines ? fftw_plan_dft_r2c_1d((int)count, series, lines, FFTW_ESTIMATE) : NULL;
  if (plan) {
    window(y, count, series);
    fftw_execute(plan);
    *oscillation = strongest(lines, count);
    fftw_destroy_plan(plan);
  }
  fftw_free(lines);
  fftw_free(series);
  return plan || status_fail(status, DELBM_FAILED, "out of memory: a spectrum");
}
