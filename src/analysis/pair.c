#include "analysis/pair.h"

#include <math.h>

struct work {
  const struct scene *scene;
  const struct history *history;
  size_t trailing, leading;
};

bool pair_applies(const struct scene *scene)
{
  if (scene->fluid.none || scene->particles.count != 2 || !(scene->particles.gravity[1] < 0)) return false;
  const struct disc_spec *disc = scene->particles.discs;
  return disc[0].motion == DISC_FREE && disc[1].motion == DISC_FREE && disc[0].position[1] != disc[1].position[1];
}

static double value(const struct work *w, size_t snapshot, size_t disc, enum history_column column)
{
  return history_at(w->history, snapshot, disc, column);
}

/* Trailing above leading. */
static double height(const struct work *w, size_t n)
{
  return value(w, n, w->trailing, HISTORY_Y) - value(w, n, w->leading, HISTORY_Y);
}

static double aside(const struct work *w, size_t n)
{
  return fabs(value(w, n, w->trailing, HISTORY_X) - value(w, n, w->leading, HISTORY_X));
}

static double gap(const struct work *w, size_t n)
{
  const struct disc_spec *disc = w->scene->particles.discs;
  return hypot(aside(w, n), height(w, n)) - disc[0].radius - disc[1].radius;
}

/* Excess of the trailing disc's speed of fall, less the tolerance pair_even. */
static double approach_speed(const struct work *w, size_t n)
{
  const double trailing = value(w, n, w->trailing, HISTORY_VY);
  return value(w, n, w->leading, HISTORY_VY) - trailing - pair_even * fabs(trailing);
}

/* A time in snapshots: the first after `from` at which a quantity is no longer positive. NAN: never. */
static double crossing(const struct work *w, double (*quantity)(const struct work *, size_t), size_t from)
{
  for (size_t n = from; n < w->history->snapshots; n++) {
    const double here = quantity(w, n);
    if (here > 0) continue;
    if (n == from) return (double)n;
    const double before = quantity(w, n - 1);
    return (double)n - (before > 0 ? here / (here - before) : 0);
  }
  return NAN;
}

/* A column of a disc at a time in snapshots. */
static double between(const struct work *w, double at, size_t disc, enum history_column column)
{
  if (isnan(at)) return NAN;
  const size_t n = (size_t)at;
  const double share = at - (double)n, here = value(w, n, disc, column);
  return share > 0 ? here + share * (value(w, n + 1, disc, column) - here) : here;
}

static double step_at(const struct work *w, double at)
{
  if (isnan(at)) return NAN;
  const size_t n = (size_t)at;
  const double share = at - (double)n, here = (double)w->history->step[n];
  return share > 0 ? here + share * ((double)w->history->step[n + 1] - here) : here;
}

/* Snapshot in [from, end) where sign times a column of a disc is largest. */
static size_t extreme(const struct work *w, size_t from, size_t end, size_t disc, enum history_column column,
                      double sign)
{
  size_t best = from;
  for (size_t n = from; n < end; n++)
    if (sign * value(w, n, disc, column) > sign * value(w, best, disc, column)) best = n;
  return best;
}

static double wall_distance(const struct work *w, size_t n)
{
  const double x = value(w, n, w->leading, HISTORY_X);
  return fmin(x, w->scene->domain.size[0] - x);
}

/* Events after the kiss, from snapshot `kiss` on. */
static void after_kiss(struct pair *p, const struct work *w, size_t kiss)
{
  const struct history *h = w->history;
  const size_t left = extreme(w, kiss, h->snapshots, w->leading, HISTORY_VX, -1);
  const size_t right = extreme(w, kiss, h->snapshots, w->leading, HISTORY_VX, 1);
  const double to_left = -value(w, left, w->leading, HISTORY_VX), to_right = value(w, right, w->leading, HISTORY_VX);
  const size_t thrown = to_left > to_right ? left : right;
  p->throw_time = (double)h->step[thrown];
  p->throw_speed = value(w, thrown, w->leading, HISTORY_VX);
  size_t nearest = thrown;
  for (size_t n = thrown; n < h->snapshots; n++)
    if (wall_distance(w, n) < wall_distance(w, nearest)) nearest = n;
  p->wall_time = (double)h->step[nearest];
  p->wall_distance = wall_distance(w, nearest);
  /* without the final rest on the bottom */
  const size_t slow = extreme(w, thrown, nearest + 1, w->leading, HISTORY_VY, 1);
  p->slow_time = (double)h->step[slow];
  p->slow_speed = value(w, slow, w->leading, HISTORY_VY);
}

struct pair pair_analyse(const struct scene *scene, const struct history *history)
{
  const struct disc_spec *disc = scene->particles.discs;
  const size_t trailing = disc[0].position[1] > disc[1].position[1] ? 0 : 1;
  const struct work w = {scene, history, trailing, 1 - trailing};
  struct pair p = {.throw_time = NAN,
                   .throw_speed = NAN,
                   .slow_time = NAN,
                   .slow_speed = NAN,
                   .wall_time = NAN,
                   .wall_distance = NAN};
  const double kiss = crossing(&w, gap, 0), tumble = crossing(&w, height, 0);
  const size_t before = isnan(kiss) ? history->snapshots : (size_t)kiss + 1;
  const size_t draft = extreme(&w, 0, before, trailing, HISTORY_VY, -1);
  p.draft_time = (double)history->step[draft];
  p.draft_speed = value(&w, draft, trailing, HISTORY_VY);
  p.kiss_time = step_at(&w, kiss);
  p.offset = fabs(between(&w, kiss, trailing, HISTORY_X) - between(&w, kiss, 1 - trailing, HISTORY_X));
  p.even_time = step_at(&w, crossing(&w, approach_speed, draft));
  p.tumble_time = step_at(&w, tumble);
  p.tumble_height = between(&w, tumble, trailing, HISTORY_Y);
  if (!isnan(kiss)) after_kiss(&p, &w, (size_t)kiss);
  return p;
}
