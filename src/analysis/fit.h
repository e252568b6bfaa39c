/* Fits and spectra of a series, by GSL and FFTW. */
#ifndef DELBM_ANALYSIS_FIT_H
#define DELBM_ANALYSIS_FIT_H

#include "base/status.h"

#include <stddef.h>

/* y = intercept + slope x by least squares; r2 is the fraction of the variance of y that the line explains. All NAN
 * for fewer than two points. */
struct line {
  double slope, intercept, r2;
};
struct line fit_line(const double *x, const double *y, size_t count);

/* Mean and standard deviation (of the population, not a sample: divided by count). */
struct spread {
  double mean, deviation;
};
struct spread fit_spread(const double *y, size_t count);

/* The strongest oscillation of a series about its mean, at equal intervals of 1. frequency is in cycles an interval, to
 * a small part of 1/count (a parabola through the logarithms of the three largest lines under a Hann window); amplitude
 * is half of peak to peak. Both are zero for a series that is constant or has fewer than 8 values. */
struct oscillation {
  double frequency, amplitude;
};
bool fit_oscillation(const double *y, size_t count, struct oscillation *oscillation, struct status *status);

#endif
