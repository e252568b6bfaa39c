/* The overlap area of two discs against the distance by which they overlap: in closed form for several ratios of
 * radii, with the factor f of A* = f delta*^(3/2) fitted (the paper's Fig. 2 and (11)); and by occupied cells, mean
 * and spread over places on the grid, beside the closed form (its Fig. 5). */
#include "bench.h"
#include "contact/cells_area.h"
#include "scenes.h"
#include "solid/lens.h"

#include <gsl/gsl_fit.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>

enum { POINTS = 50 };
static const double radius = 10; /* of the areas by cells */

/* Fits over 0 < delta* <= largest: A* = factor delta*^(3/2); A* ~ delta*^exponent. */
struct fit {
  double factor, exponent;
};

/* A* for the ratio of radii `beta`: area over pi/(1/R_i^2 + 1/R_j^2), as in (11). */
static double dimensionless_area(double beta, double delta)
{
  const double area = lens_of_discs(1, beta, 1 + beta - delta * beta / (1 + beta)).area;
  return area * (1 + beta * beta) / (M_PI * beta * beta);
}

static struct fit fit_power(double beta, double largest)
{
  double x[POINTS], y[POINTS], lx[POINTS], ly[POINTS], error, sum, c0, c00, c01, c11;
  struct fit fit;
  for (int k = 0; k < POINTS; k++) {
    const double delta = largest * (k + 1) / POINTS, area = dimensionless_area(beta, delta);
    x[k] = pow(delta, 1.5), y[k] = area;
    lx[k] = log(delta), ly[k] = log(area);
  }
  gsl_fit_mul(x, 1, y, 1, POINTS, &fit.factor, &error, &sum);
  gsl_fit_linear(lx, 1, ly, 1, POINTS, &c0, &fit.exponent, &c00, &c01, &c11, &sum);
  return fit;
}

/* Checks that the area is the integral of the chord over the distance, and the fitted factor against the limit of
 * small overlap. */
static bool verify_ratio(double beta, const struct fit *fit, double limit, struct status *status)
{
  enum { PARTS = 2000 };
  const double overlap = 0.5;
  double sum = 0;
  for (int k = 0; k < PARTS; k++) sum += lens_of_discs(1, beta, 1 + beta - overlap * (k + 0.5) / PARTS).chord / PARTS;
  const double area = lens_of_discs(1, beta, 1 + beta - overlap).area, error = sum * overlap / area - 1;
  if (!(fabs(error) < 1e-4))
    return status_fail(status, DELBM_FAILED, "bench overlap: beta %g: the area is %g off the integral of the chord",
                       beta, error);
  return (fabs(fit->factor / limit - 1) < 0.02 && fabs(fit->exponent - 1.5) < 0.01) ||
         status_fail(status, DELBM_FAILED, "bench overlap: beta %g: A* = %g delta*^%g, expected %g and 1.5", beta,
                     fit->factor, fit->exponent, limit);
}

static bool report_ratios(const struct bench_report *report, struct status *status)
{
  static const double ratios[] = {1, 1.5, 2, 3, 5, 10};
  enum { RATIOS = sizeof ratios / sizeof ratios[0] };
  printf("A* = A (R_i^2 + R_j^2)/(pi R_i^2 R_j^2) against delta* = delta (R_i + R_j)/(R_i R_j), by beta = R_j/R_i\n");
  printf("%8s", "delta*");
  for (int b = 0; b < RATIOS; b++) printf(" %12g", ratios[b]);
  printf("\n");
  for (int k = 1; k <= 20; k++) {
    printf("%8.3f", 0.05 * k);
    for (int b = 0; b < RATIOS; b++) printf(" %12.6g", dimensionless_area(ratios[b], 0.05 * k));
    printf("\n");
  }
  printf("\n\nfitted to 0 < delta* <= 0.1, and f(beta) = 4 sqrt(2)/(3 pi) (1 + beta^2)/(1 + beta)^2 of the limit\n");
  printf("%8s %12s %12s %12s\n", "beta", "factor", "f(beta)", "exponent");
  if (report->json) fprintf(report->json, "\"ratios\": [");
  for (int b = 0; b < RATIOS; b++) {
    const double beta = ratios[b], limit = 4 * M_SQRT2 / (3 * M_PI) * (1 + beta * beta) / ((1 + beta) * (1 + beta));
    const struct fit fit = fit_power(beta, 0.1);
    printf("%8g %12.6f %12.6f %12.5f\n", beta, fit.factor, limit, fit.exponent);
    if (report->json)
      fprintf(report->json, "%s{\"beta\": %g, \"factor\": %.17g, \"limit\": %.17g, \"exponent\": %.17g}", b ? ", " : "",
              beta, fit.factor, limit, fit.exponent);
    if (!verify_ratio(beta, &fit, limit, status)) return false;
  }
  if (report->json) fprintf(report->json, "]");
  return true;
}

/* Mean and deviation of the area by cells at one overlap, over random places and directions. */
struct by_cells {
  struct scene scene;
  struct discs discs;
  double *scratch;
  gsl_rng *random;
};

static bool by_cells_create(struct by_cells *c, struct status *status)
{
  *c = (struct by_cells){.scene = scene_box(64, 64, 0.05, SIDES_PERIODIC), .random = gsl_rng_alloc(gsl_rng_mt19937)};
  for (int k = 0; k < 2; k++) scene_add_disc(&c->scene, radius, 2, 32, 32);
  if (!discs_create(&c->discs, &c->scene, status)) return false;
  c->scratch = calloc(cells_area_scratch(&c->discs), sizeof *c->scratch);
  return c->scratch || status_fail(status, DELBM_FAILED, "bench overlap: no memory");
}

static void by_cells_destroy(struct by_cells *c)
{
  gsl_rng_free(c->random);
  free(c->scratch);
  discs_destroy(&c->discs);
  scene_clear(&c->scene);
}

static void measure_cells(struct by_cells *c, double overlap, int places, double mean[2])
{
  double sum = 0, squares = 0;
  for (int n = 0; n < places; n++) {
    const double angle = gsl_ran_flat(c->random, 0, 2 * M_PI), d = 2 * radius - overlap;
    c->discs.x[0] = gsl_ran_flat(c->random, 31, 32);
    c->discs.y[0] = gsl_ran_flat(c->random, 31, 32);
    c->discs.x[1] = c->discs.x[0] + d * cos(angle);
    c->discs.y[1] = c->discs.y[0] + d * sin(angle);
    const double area = cells_area(&c->scene, &c->discs, 0, 1, c->scratch);
    sum += area;
    squares += area * area;
  }
  mean[0] = sum / places;
  mean[1] = sqrt(fmax(0, squares / places - mean[0] * mean[0]));
}

static bool report_cells(struct by_cells *c, const struct bench_report *report, struct status *status)
{
  const int places = report->quick ? 100 : 4000;
  printf("\n\ntwo discs of R = %g: area by cells (23)-(24), over %d places, beside the closed form\n", radius, places);
  printf("%8s %12s %12s %12s\n", "overlap", "lens", "cells", "spread");
  if (report->json) fprintf(report->json, ", \"cells\": [");
  for (int k = -4; k <= 20; k++) {
    const double overlap = 0.1 * k, area = lens_of_discs(radius, radius, 2 * radius - overlap).area;
    double mean[2];
    measure_cells(c, overlap, places, mean);
    printf("%8.1f %12.5f %12.5f %12.5f\n", overlap, area, mean[0], mean[1]);
    if (k > 0 && !(mean[0] > area && mean[0] < area + radius / 4))
      return status_fail(status, DELBM_FAILED, "bench overlap: area by cells %g at an overlap of %g, where %g is exact",
                         mean[0], overlap, area);
    if (report->json)
      fprintf(report->json, "%s{\"overlap\": %.17g, \"lens\": %.17g, \"cells\": %.17g, \"spread\": %.17g}",
              k > -4 ? ", " : "", overlap, area, mean[0], mean[1]);
  }
  if (report->json) fprintf(report->json, "]");
  return true;
}

bool bench_overlap(const struct bench_report *report, struct status *status)
{
  struct by_cells cells;
  if (!report_ratios(report, status)) return false;
  const bool ok = by_cells_create(&cells, status) && report_cells(&cells, report, status);
  by_cells_destroy(&cells);
  return ok;
}
