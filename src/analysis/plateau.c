#include "analysis/plateau.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

enum { PLACES = 512 };

struct search {
  const double *way;
  const double *sum; /* [count + 1] of the speeds before */
  size_t count;
};

static double mean_of(const struct search *s, size_t first, size_t end)
{
  return (s->sum[end] - s->sum[first]) / (double)(end - first);
}

/* Means of the thirds of values first .. end - 1. */
static void thirds_of(const struct search *s, size_t first, size_t end, double third[3])
{
  const size_t length = end - first;
  for (size_t k = 0; k < 3; k++) third[k] = mean_of(s, first + k * length / 3, first + (k + 1) * length / 3);
}

static bool is_level(const struct search *s, size_t first, size_t end)
{
  double third[3];
  thirds_of(s, first, end, third);
  const double high = fmax(third[0], fmax(third[1], third[2])), low = fmin(third[0], fmin(third[1], third[2]));
  return high - low <= plateau_tolerance * fabs(mean_of(s, first, end));
}

static bool is_long(const struct search *s, size_t first, size_t end, double min_way)
{
  return end >= first + 3 && s->way[end - 1] - s->way[first] >= min_way;
}

/* Latest start of a stretch to the end that is long enough; `count` if there is none. */
static size_t last_long(const struct search *s, double min_way)
{
  size_t first = s->count;
  while (first > 0 && !is_long(s, first - 1, s->count, min_way)) first--;
  return first > 0 ? first - 1 : s->count;
}

static struct plateau stretch(const struct search *s, enum plateau_kind kind, size_t first, size_t end)
{
  double third[3];
  thirds_of(s, first, end, third);
  return (struct plateau){kind, first, end - first, (third[2] - third[0]) / mean_of(s, first, end)};
}

static struct plateau find(const struct search *s, double min_way)
{
  const size_t places = s->count < PLACES ? s->count : PLACES;
  for (size_t last = places; last > 0; last--)
    for (size_t from = 0; from < last; from++) {
      const size_t first = from * s->count / places, end = last * s->count / places;
      if (is_long(s, first, end, min_way) && is_level(s, first, end)) return stretch(s, PLATEAU_FOUND, first, end);
    }
  const size_t first = last_long(s, min_way);
  if (first == s->count) return (struct plateau){.kind = PLATEAU_SHORT, .count = s->count};
  return stretch(s, PLATEAU_CHANGING, first, s->count);
}

bool plateau_find(const double *way, const double *speed, size_t count, double min_way, struct plateau *plateau,
                  struct status *status)
{
  double *sum = memory_allocate(count + 1, sizeof *sum, "the search for a plateau", status);
  if (!sum) return false;
  sum[0] = 0;
  for (size_t k = 0; k < count; k++) sum[k + 1] = sum[k] + speed[k];
  *plateau = find(&(struct search){way, sum, count}, min_way);
  free(sum);
  return true;
}
