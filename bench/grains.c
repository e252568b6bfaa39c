/* How steep is a heap of dry discs, how far does a column of discs run out, and what does fluid change?
 *
 * Angle of repose: of the free surface of the heap that a released column of 500 discs, as high as half its width, leaves on a plane
 * ground. The slope is a least-squares fit to the whole free surface. The ground has the friction of the discs: without friction
 * there is no heap.
 *
 * Run-out: Staron & Hinch, J. Fluid Mech. 545 (2005) 1, have for discs on a plane, with a restitution of 0.5,
 * (x - x_0)/x_0 = 2.5 a for a = H_0/x_0 below 2, about 3.25 a^0.7 above. x is the front of the mass of discs that touch: discs
 * that have left it roll on alone. */
#include "bench.h"
#include "column.h"

#include <gsl/gsl_fit.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>

enum { ASPECTS = 7, KNEE = 3, SEEDS = 5, COLUMN_SEEDS = 3 };
/* H_0/x_0 wanted; the one at KNEE belongs to both laws. */
static const double aspects[ASPECTS] = {0.5, 0.8, 1.3, 2, 3.5, 6, 10};

/* Members of a list in JSON. */
static void separate(const struct bench_report *report, bool first)
{
  if (report->json) fprintf(report->json, "%s\n", first ? "" : ",");
}

struct angle {
  double mean, deviation;
};

static bool angle_of(double friction, double rolling, const struct bench_report *report, struct angle *angle,
                     struct status *status)
{
  const int seeds = report->quick ? 2 : SEEDS;
  double slope[SEEDS], apart = 0;
  for (int k = 0; k < seeds; k++) {
    struct column c = {.discs = report->quick ? 100 : 500,
                       .aspect = 1,
                       .friction = friction,
                       .rolling_friction = rolling,
                       .restitution = 0.5,
                       .seed = (uint64_t)k + 1};
    if (!column_run(&c, status)) return false;
    slope[k] = c.slope;
    apart += (double)c.apart / seeds;
  }
  *angle = (struct angle){gsl_stats_mean(slope, 1, (size_t)seeds), gsl_stats_sd(slope, 1, (size_t)seeds)};
  printf("%9g %9g %9.2f %9.2f %9.0f\n", friction, rolling, angle->mean, angle->deviation, apart);
  fflush(stdout);
  if (report->json)
    fprintf(report->json, "{\"friction\": %g, \"rolling_friction\": %g, \"angle\": %.4g, \"deviation\": %.3g}",
            friction, rolling, angle->mean, angle->deviation);
  return true;
}

static bool report_angles(const struct bench_report *report, struct status *status)
{
  static const double frictions[] = {0, 0.2, 0.4, 0.8}, rollings[] = {0, 0.1};
  printf("angle of repose of %d dry discs, degrees, %d seeds; discs apart from the heap\n", report->quick ? 100 : 500,
         report->quick ? 2 : SEEDS);
  printf("%9s %9s %9s %9s %9s\n", "friction", "rolling", "mean", "deviation", "apart");
  if (report->json) fprintf(report->json, "\"repose\": [");
  for (int r = 0; r < (report->quick ? 1 : 2); r++) {
    struct angle before = {-INFINITY, 0};
    for (int f = 0; f < 4; f += report->quick ? 3 : 1) {
      struct angle angle;
      separate(report, r == 0 && f == 0);
      if (!angle_of(frictions[f], rollings[r], report, &angle, status)) return false;
      if (f == 0 && !(fabs(angle.mean) < 2))
        return status_fail(status, DELBM_FAILED, "bench grains: a heap of %g degrees without friction", angle.mean);
      if (!(angle.mean > before.mean))
        return status_fail(status, DELBM_FAILED,
                           "bench grains: a friction of %g lowers the angle of repose from %g to %g", frictions[f],
                           before.mean, angle.mean);
      before = angle;
    }
  }
  if (report->json) fprintf(report->json, "],\n");
  return true;
}

/* Columns of one kind; number of seeds. */
static const struct kind {
  const char *name;
  double friction;
  bool rough;
  int seeds;
} kinds[] = {
    {"friction 0.5", 0.5, false, COLUMN_SEEDS}, {"friction 1", 1, false, 1}, {"friction 0.5, rough", 0.5, true, 1}};

/* Ranges of a for the exponents: up to 2, from 2 on, and from the first above 2 on. */
enum { LOW, HIGH, ABOVE, FITS };
static const double published[FITS] = {1, 0.7, 0.7};

/* Exponents of the run-out over columns `stride` apart. Without a second one above 2, ABOVE is NAN. */
static void fit(const double *a, const double *run_out, size_t stride, double exponent[FITS])
{
  const size_t first[FITS] = {0, KNEE, KNEE + stride}, last[FITS] = {KNEE, ASPECTS - 1, ASPECTS - 1};
  double x[ASPECTS], y[ASPECTS], c0, cov00, cov01, cov11, sum;
  for (size_t k = 0; k < ASPECTS; k += stride) x[k] = log(a[k]), y[k] = log(run_out[k]);
  for (int f = 0; f < FITS; f++) {
    const size_t k = first[f], count = (last[f] - k) / stride + 1;
    exponent[f] = NAN;
    if (count > 1) gsl_fit_linear(x + k, stride, y + k, stride, count, &c0, &exponent[f], &cov00, &cov01, &cov11, &sum);
  }
}

static bool report_column(const struct kind *kind, double aspect, int seed, bool first,
                          const struct bench_report *report, struct column *c, struct status *status)
{
  *c = (struct column){.discs = report->quick ? 200 : 1000,
                       .aspect = aspect,
                       .friction = kind->friction,
                       .restitution = 0.5,
                       .rough = kind->rough,
                       .seed = (uint64_t)seed + 1};
  if (!column_run(c, status)) return false;
  const double a = c->height / c->width, law = a < 2 ? 2.5 * a : 3.25 * pow(a, 0.7);
  printf("%-20s %4d %6.2f %8.2f %9.2f %8.2f %6.1f %6zu %8.3f\n", kind->name, seed + 1, a, c->run_out, c->run_out / law,
         c->final_height, c->time, c->apart, c->max_overlap);
  fflush(stdout);
  separate(report, first);
  if (report->json)
    fprintf(report->json,
            "{\"column\": \"%s\", \"seed\": %d, \"aspect\": %.4g, \"run_out\": %.4g, \"final_height\": %.4g, \"time\": "
            "%.3g, \"apart\": %zu, \"max_overlap\": %.3g}",
            kind->name, seed + 1, a, c->run_out, c->final_height, c->time, c->apart, c->max_overlap);
  return true;
}

/* Columns that are there for comparison have three aspect ratios. */
static int kind_stride(const struct kind *kind, const struct bench_report *report)
{
  return report->quick || kind != kinds ? KNEE : 1;
}

static bool report_kind(const struct kind *kind, bool first, double exponents[COLUMN_SEEDS][FITS],
                        const struct bench_report *report, struct status *status)
{
  const int stride = kind_stride(kind, report);
  for (int s = 0; s < (report->quick ? 1 : kind->seeds); s++) {
    double a[ASPECTS], run_out[ASPECTS];
    for (int k = 0; k < ASPECTS; k += stride) {
      struct column c;
      if (!report_column(kind, aspects[k], s, first && s == 0 && k == 0, report, &c, status)) return false;
      a[k] = c.height / c.width;
      run_out[k] = c.run_out;
    }
    fit(a, run_out, (size_t)stride, exponents[s]);
  }
  return true;
}

/* Mean over the seeds of one fit, and the seed farthest from the published value. */
struct exponent {
  double mean, worst;
};

static struct exponent exponent_of(double exponents[COLUMN_SEEDS][FITS], size_t seeds, int f)
{
  struct exponent e = {gsl_stats_mean(&exponents[0][f], FITS, seeds), exponents[0][f]};
  for (size_t s = 1; s < seeds; s++)
    if (fabs(exponents[s][f] - published[f]) > fabs(e.worst - published[f])) e.worst = exponents[s][f];
  return e;
}

static bool report_exponents(const struct kind *kind, double exponents[COLUMN_SEEDS][FITS], bool first,
                             const struct bench_report *report, struct status *status)
{
  static const char *const names[FITS] = {"low", "high", "above"};
  /* tall columns of few discs are only a few diameters wide */
  const double bar = report->quick ? 0.3 : 0.1;
  printf("%-20s", kind->name);
  separate(report, first);
  if (report->json) fprintf(report->json, "{\"fit\": \"%s\"", kind->name);
  for (int f = 0; f < FITS; f++) {
    const struct exponent e = exponent_of(exponents, report->quick ? 1 : (size_t)kind->seeds, f);
    if (isnan(e.mean)) continue;
    printf(" %8.2f %8.2f", e.mean, e.worst);
    if (report->json) fprintf(report->json, ", \"%s\": %.3g, \"%s_worst\": %.3g", names[f], e.mean, names[f], e.worst);
    if (kind == kinds && f != HIGH && !(fabs(e.mean - published[f]) <= bar))
      return status_fail(status, DELBM_FAILED, "bench grains: run-out grows as a^%.3g %s 2, not a^%g", e.mean,
                         f == LOW ? "below" : "above", published[f]);
  }
  printf("\n");
  if (report->json) fprintf(report->json, "}");
  return true;
}

static bool report_columns(const struct bench_report *report, struct status *status)
{
  const int count = report->quick ? 1 : (int)(sizeof kinds / sizeof kinds[0]);
  double exponents[3][COLUMN_SEEDS][FITS];
  printf("\ncollapse of columns of %d dry discs; time over sqrt(H_0/g)\n", report->quick ? 200 : 1000);
  printf("%-20s %4s %6s %8s %9s %8s %6s %6s %8s\n", "", "seed", "a", "run-out", "over law", "height", "time", "apart",
         "overlap");
  if (report->json) fprintf(report->json, "\"columns\": [");
  for (int k = 0; k < count; k++)
    if (!report_kind(&kinds[k], k == 0, exponents[k], report, status)) return false;
  printf("\nexponents of the run-out: mean and worst of the seeds\n");
  printf("%-20s %8s %8s %8s %8s %8s %8s\n", "", "a <= 2", "worst", "a >= 2", "worst", "a > 2", "worst");
  if (report->json) fprintf(report->json, "],\n\"exponents\": [");
  for (int k = 0; k < count; k++)
    if (!report_exponents(&kinds[k], exponents[k], k == 0, report, status)) return false;
  if (report->json) fprintf(report->json, "],\n");
  return true;
}

static bool report_medium(double aspect, double viscosity, bool first, const struct bench_report *report,
                          struct column *c, struct status *status)
{
  *c = (struct column){.discs = report->quick ? 40 : 120,
                       .aspect = aspect,
                       .friction = 0.5,
                       .restitution = 0.5,
                       .seed = 1,
                       .viscosity = viscosity};
  if (!column_run(c, status)) return false;
  printf("%9g %6.2f %8.2f %8.2f %6.1f %6.1f %6zu %8.4f\n", viscosity, c->height / c->width, c->run_out, c->final_height,
         c->time, c->end, c->apart, c->max_overlap);
  fflush(stdout);
  separate(report, first);
  if (report->json)
    fprintf(report->json,
            "{\"viscosity\": %g, \"aspect\": %.4g, \"run_out\": %.4g, \"final_height\": %.4g, \"time\": %.3g}",
            viscosity, c->height / c->width, c->run_out, c->final_height, c->time);
  return true;
}

/* Viscosity 0: dry. */
static bool report_fluid(const struct bench_report *report, struct status *status)
{
  static const double wanted[] = {1, 4}, viscosities[] = {0, 0.005, 0.05};
  printf("\nthe same column of %d discs of density 2.5, dry and in fluid, R_h/R = 0.8; times over sqrt(H_0/g')\n",
         report->quick ? 40 : 120);
  printf("%9s %6s %8s %8s %6s %6s %6s %8s\n", "viscosity", "a", "run-out", "height", "time", "rest", "apart",
         "overlap");
  if (report->json) fprintf(report->json, "\"fluid\": [");
  for (int k = 0; k < (report->quick ? 1 : 2); k++) {
    struct column dry = {0};
    for (int v = 0; v < 3; v += report->quick ? 2 : 1) {
      struct column c;
      if (!report_medium(wanted[k], viscosities[v], k == 0 && v == 0, report, &c, status)) return false;
      if (v == 0) dry = c;
      if (v > 0 && !(c.final_height > dry.final_height))
        return status_fail(status, DELBM_FAILED,
                           "bench grains: fluid of viscosity %g lowers the heap from %g to %g x_0", viscosities[v],
                           dry.final_height, c.final_height);
    }
  }
  if (report->json) fprintf(report->json, "]");
  return true;
}

bool bench_grains(const struct bench_report *report, struct status *status)
{
  return report_angles(report, status) && report_columns(report, status) && report_fluid(report, status);
}
