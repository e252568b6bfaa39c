/* Where a speed is constant: the terminal speed of a fall.
 *
 * A stretch is level when the means of its first, middle and last third lie within plateau_tolerance of their common
 * mean of each other. The plateau is the level stretch that ends last (of equal ends the longest) among the
 * stretches of at least a given way. Thirds exclude both a rise with a fall after it and an oscillation of less than
 * a third. */
#ifndef DELBM_ANALYSIS_PLATEAU_H
#define DELBM_ANALYSIS_PLATEAU_H

#include "base/status.h"

#include <stddef.h>

/* Relative difference between the means of the thirds. */
static const double plateau_tolerance = 0.005;

enum plateau_kind {
  PLATEAU_FOUND,
  PLATEAU_SHORT,   /* the whole way is below min_way, or has fewer than three values */
  PLATEAU_CHANGING /* no stretch is level */
};

struct plateau {
  enum plateau_kind kind;
  size_t first, count; /* of the stretch; PLATEAU_CHANGING: of the last stretch that is long enough */
  double drift;        /* mean of the last third less mean of the first, over the mean of all */
};

/* `way[k]` is the distance travelled when the speed is `speed[k]`, ascending where the speed is positive. Stretches
 * begin and end at up to 512 places at equal intervals. Fails for want of memory. */
bool plateau_find(const double *way, const double *speed, size_t count, double min_way, struct plateau *plateau,
                  struct status *status);

#endif
