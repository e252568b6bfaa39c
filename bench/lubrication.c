/* How much of the force between close surfaces does the lattice resolve, and how accurate is the force with sub-grid
 * lubrication? */
#include "bench.h"
#include "film.h"
#include "places.h"

#include <math.h>
#include <stdlib.h>

static const double gaps[] = {2, 1, 0.7, 0.5, 0.3, 0.2, 0.1, 0.05};
enum { GAPS = sizeof gaps / sizeof gaps[0], AT = 5 };

/* Angles of the line of centres, and places on the grid. */
static const double at[AT][3] = {
    {0, 0.5, 0.25}, {0.2, 0.3, 0.1}, {0.4, 0.1, 0.4}, {0.6, 0.6, 0.2}, {M_PI / 4, 0.3, 0.8}};

static const struct pair {
  double radius[2];
  const char *name;
} pairs[] = {{{5, INFINITY}, "R = 5, wall"},
             {{5, 5}, "R = 5, R = 5"},
             {{10, INFINITY}, "R = 10, wall"},
             {{10, 10}, "R = 10, R = 10"},
             {{5, 10}, "R = 5, R = 10"}};

static const char *const motions[] = {
    [FILM_APPROACH] = "approach", [FILM_SLIDE] = "slide", [FILM_SPIN] = "spin", [FILM_ENTRAINMENT] = "entrainment"};

/* Error over the places, in per cent. */
static bool errors(const struct pair *pair, enum film_motion motion, double gap, double cutoff, int count,
                   struct deviations *all, struct status *status)
{
  *all = (struct deviations){0};
  for (int k = 0; k < count; k++) {
    struct film film = {.radius = {pair->radius[0], pair->radius[1]},
                        .gap = gap,
                        .angle = at[k][0],
                        .offset = {at[k][1], at[k][2]},
                        .viscosity = 1.0 / 6,
                        .cutoff = cutoff};
    double error;
    if (!film_error(&film, motion, &error, status)) return false;
    deviations_add(all, 100 * error, 1.0 / count);
  }
  return true;
}

static bool report_gap(const struct bench_report *report, const struct pair *pair, enum film_motion motion, double gap,
                       bool first, struct status *status)
{
  const int count = report->quick ? 1 : AT;
  struct deviations without, with;
  if (!errors(pair, motion, gap, 0, count, &without, status) || !errors(pair, motion, gap, 2, count, &with, status))
    return false;
  printf("%-16s %-12s %5.2f %+9.1f %6.1f %+9.1f %6.1f\n", pair->name, motions[motion], gap, without.mean, without.worst,
         with.mean, with.worst);
  fflush(stdout);
  if (report->json)
    fprintf(report->json,
            "%s\n{\"pair\": \"%s\", \"motion\": \"%s\", \"gap\": %g, \"percent_off_without\": [%.4g, %.4g], "
            "\"percent_off\": [%.4g, %.4g]}",
            first ? "" : ",", pair->name, motions[motion], gap, without.mean, without.worst, with.mean, with.worst);
  return fabs(with.mean) < 10 ||
         status_fail(status, DELBM_FAILED, "bench lubrication: %s, %s at a gap of %g: %g %% off", pair->name,
                     motions[motion], gap, with.mean);
}

bool bench_lubrication(const struct bench_report *report, struct status *status)
{
  const size_t count = report->quick ? 2 : sizeof pairs / sizeof pairs[0];
  bool first = true;
  printf("force over the exact force in Stokes flow, viscosity 1/6: per cent off, mean and largest over places\n");
  printf("%-16s %-12s %5s %9s %6s %9s %6s\n", "pair", "motion", "gap", "without", "worst", "with", "worst");
  if (report->json) fprintf(report->json, "\"rows\": [");
  for (size_t p = 0; p < count; p++)
    for (int m = 0; m < FILM_MOTIONS; m++) {
      const bool wall = isinf(pairs[p].radius[1]), unequal = !wall && pairs[p].radius[0] != pairs[p].radius[1];
      if ((wall && m == FILM_ENTRAINMENT) || (unequal && m != FILM_APPROACH)) continue;
      for (int g = report->quick ? 3 : 0; g < GAPS; g += report->quick ? 3 : 1) {
        if (gaps[g] < 0.01 * fmin(pairs[p].radius[0], pairs[p].radius[1])) continue; /* below the least gap */
        if (!report_gap(report, &pairs[p], m, gaps[g], first, status)) return false;
        first = false;
      }
    }
  if (report->json) fprintf(report->json, "]");
  return true;
}
