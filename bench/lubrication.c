/* How much of the force between close surfaces does the lattice resolve, and how accurate is the force with sub-grid
 * lubrication? */
#include "bench.h"
#include "film.h"
#include "places.h"

#include <math.h>
#include <stdlib.h>

static const double gaps[] = {2, 1, 0.7, 0.5, 0.3, 0.2, 0.1, 0.05};
enum { GAPS = sizeof gaps / sizeof gaps[0], AT = 3 };

/* Angles of the line of centres, and places on the grid. */
static const double at[AT][3] = {{0, 0.5, 0.25}, {0.2, 0.3, 0.1}, {0.6, 0.6, 0.2}};

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

static struct film film_at(const struct pair *pair, int place, double gap, double cutoff)
{
  return (struct film){.radius = {pair->radius[0], pair->radius[1]},
                       .gap = gap,
                       .angle = at[place][0],
                       .offset = {at[place][1], at[place][2]},
                       .viscosity = 1.0 / 6,
                       .cutoff = cutoff};
}

/* A motion of a pair, at `count` places. */
struct row {
  const struct pair *pair;
  enum film_motion motion;
  int count;
  double excess[AT]; /* film_far */
};

static bool start_row(struct row *row, const struct pair *pair, enum film_motion motion, int count,
                      struct status *status)
{
  *row = (struct row){.pair = pair, .motion = motion, .count = count};
  for (int k = 0; k < count; k++) {
    const struct film far = film_at(pair, k, 4, 0);
    if (!film_far(&far, motion, &row->excess[k], status)) return false;
  }
  return true;
}

/* Error over the places, in per cent. */
static bool errors(const struct row *row, double gap, double cutoff, struct deviations *all, struct status *status)
{
  *all = (struct deviations){0};
  for (int k = 0; k < row->count; k++) {
    const struct film film = film_at(row->pair, k, gap, cutoff);
    double error;
    if (!film_error(&film, row->motion, row->excess[k], &error, status)) return false;
    deviations_add(all, 100 * error, 1.0 / row->count);
  }
  return true;
}

static bool report_gap(const struct bench_report *report, const struct row *row, double gap, bool first,
                       struct status *status)
{
  const char *pair = row->pair->name, *motion = motions[row->motion];
  struct deviations without, with;
  if (!errors(row, gap, 0, &without, status) || !errors(row, gap, 2, &with, status)) return false;
  printf("%-16s %-12s %5.2f %+9.1f %6.1f %+9.1f %6.1f\n", pair, motion, gap, without.mean, without.worst, with.mean,
         with.worst);
  fflush(stdout);
  if (report->json)
    fprintf(report->json,
            "%s\n{\"pair\": \"%s\", \"motion\": \"%s\", \"gap\": %g, \"percent_off_without\": [%.4g, %.4g], "
            "\"percent_off\": [%.4g, %.4g]}",
            first ? "" : ",", pair, motion, gap, without.mean, without.worst, with.mean, with.worst);
  return fabs(with.mean) < 10 ||
         status_fail(status, DELBM_FAILED, "bench lubrication: %s, %s at a gap of %g: %g %% off", pair, motion, gap,
                     with.mean);
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
      struct row row;
      if ((wall && m == FILM_ENTRAINMENT) || (unequal && m != FILM_APPROACH)) continue;
      if (!start_row(&row, &pairs[p], m, report->quick ? 1 : AT, status)) return false;
      for (int g = report->quick ? 3 : 0; g < GAPS; g += report->quick ? 3 : 1) {
        if (gaps[g] < 0.01 * fmin(pairs[p].radius[0], pairs[p].radius[1])) continue; /* below the least gap */
        if (!report_gap(report, &row, gaps[g], first, status)) return false;
        first = false;
      }
    }
  if (report->json) fprintf(report->json, "]");
  return true;
}
