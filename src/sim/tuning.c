#include "sim/tuning.h"

#include <math.h>
#include <stdio.h>

/* In the order of trial. Two rounds: in the first block of a depth the cache may be cold. */
static const struct blocking candidates[] = {{1, 0}, {4, 0}, {8, 0}, {16, 0}, {32, 0}, {16, 1024}, {16, 512}};
enum { CANDIDATES = sizeof candidates / sizeof candidates[0], ROUNDS = 2 };

static bool is_possible(const struct tuning *t, const struct blocking *blocking)
{
  return blocking->depth <= t->max_depth && blocking->width < t->max_width;
}

/* Advances to the next possible trial. */
static void skip_impossible(struct tuning *t)
{
  while (t->trial < CANDIDATES * ROUNDS && !is_possible(t, &candidates[t->trial % CANDIDATES])) t->trial++;
  t->decided = t->trial >= CANDIDATES * ROUNDS;
}

void tuning_start(struct tuning *t, const struct scene *scene, int threads)
{
  *t = (struct tuning){.best = {.depth = 1}, .decided = true, .best_time = INFINITY};
  if (scene->fluid.none) return;
  const int interval = zero_flux_create(scene).interval;
  if (scene->particles.count > 0) { /* no trials: the free rows change with the discs */
    t->best.depth = scene->run.plan.depth > 0 ? scene->run.plan.depth : BLOCKED_DEPTH;
    if (interval > 0 && t->best.depth > interval) t->best.depth = interval;
    return;
  }
  t->max_width = scene->domain.size[0];
  t->max_depth = blocked_max_depth(scene->domain.size[1], threads);
  if (interval > 0 && t->max_depth > interval) t->max_depth = interval;
  if (scene->run.plan.depth == 0) {
    skip_impossible(t);
    return;
  }
  t->best = (struct blocking){.depth = scene->run.plan.depth, .width = scene->run.plan.width};
  if (t->best.depth > t->max_depth) t->best.depth = t->max_depth > 1 ? t->max_depth : 1;
}

struct blocking tuning_next(const struct tuning *t, int64_t steps)
{
  if (t->decided) return t->best;
  const struct blocking candidate = candidates[t->trial % CANDIDATES];
  return candidate.depth <= steps ? candidate : t->best;
}

void tuning_note(struct tuning *t, const struct blocking *blocking, double seconds_per_step)
{
  if (t->decided) return;
  const struct blocking candidate = candidates[t->trial % CANDIDATES];
  if (blocking->depth != candidate.depth || blocking->width != candidate.width) return;
  if (seconds_per_step < t->best_time) {
    t->best_time = seconds_per_step;
    t->best = candidate;
  }
  t->trial++;
  skip_impossible(t);
}

void tuning_text(const struct tuning *t, char text[TUNING_TEXT])
{
  if (t->best.depth <= 1)
    snprintf(text, TUNING_TEXT, "off");
  else if (t->best.width == 0)
    snprintf(text, TUNING_TEXT, "%d", t->best.depth);
  else
    snprintf(text, TUNING_TEXT, "%dx%d", t->best.depth, t->best.width);
}
