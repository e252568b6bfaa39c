#include "analysis/body.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

/* Unit vector along the stream, or along gravity, and the one a quarter turn counter-clockwise from it. */
struct frame {
  double along[2], across[2];
};

struct window {
  size_t first, count; /* snapshots */
};

/* Velocity of the fluid far away relative to a held disc: that of the first inlet, less the disc's own. */
static void stream_of(const struct scene *scene, double stream[2])
{
  const struct disc_spec *disc = &scene->particles.discs[0];
  const bool driven = disc->motion == DISC_DRIVEN;
  for (int axis = 0; axis < 2; axis++) stream[axis] = driven ? -disc->velocity[axis] : 0;
  for (int k = 0; k < SIDE_COUNT; k++) {
    const struct side *side = &scene->domain.side[k];
    if (side->type != SIDE_INLET) continue;
    for (int axis = 0; axis < 2; axis++) stream[axis] += side->velocity[axis];
    return;
  }
}

bool body_applies(const struct scene *scene)
{
  if (scene->particles.count != 1) return false;
  const double *gravity = scene->particles.gravity;
  const struct disc_spec *disc = &scene->particles.discs[0];
  if (disc->motion == DISC_FREE) return (gravity[0] == 0) != (gravity[1] == 0) && disc->density != 1;
  double stream[2];
  stream_of(scene, stream);
  return hypot(stream[0], stream[1]) > 0;
}

static struct frame frame_of(const struct scene *scene, bool held)
{
  double to[2];
  if (held) {
    stream_of(scene, to);
  } else {
    const double sense = scene->particles.discs[0].density > 1 ? 1 : -1; /* a light disc rises */
    for (int axis = 0; axis < 2; axis++) to[axis] = sense * scene->particles.gravity[axis];
  }
  const double length = hypot(to[0], to[1]);
  return (struct frame){{to[0] / length, to[1] / length}, {-to[1] / length, to[0] / length}};
}

/* Distance from the disc to the side ahead of it; infinite where the axis is periodic. */
static double room_ahead(const struct scene *scene, const struct history *h, size_t snapshot, const struct frame *frame)
{
  const int axis = frame->along[0] == 0;
  if (scene_is_periodic(scene, axis)) return INFINITY;
  const double at = history_at(h, snapshot, 0, axis == 0 ? HISTORY_X : HISTORY_Y);
  return frame->along[axis] < 0 ? at : scene->domain.size[axis] - at;
}

static struct window window_of(const struct scene *scene, const struct history *h, const struct frame *frame, bool held)
{
  if (held) {
    const size_t first = h->snapshots - (h->snapshots + 3) / 4;
    return (struct window){first, h->snapshots - first};
  }
  size_t end = 0;
  const double near = 20 * scene->particles.discs[0].radius;
  while (end < h->snapshots && room_ahead(scene, h, end, frame) > near) end++;
  return (struct window){end / 2, end - end / 2};
}

/* The component of a pair of columns along a direction, over the window. */
static void component(const struct history *h, const struct window *w, enum history_column x, const double direction[2],
                      double factor, double *to)
{
  for (size_t k = 0; k < w->count; k++)
    to[k] = factor * (direction[0] * history_at(h, w->first + k, 0, x) +
                      direction[1] * history_at(h, w->first + k, 0, (enum history_column)(x + 1)));
}

static bool add_shedding(struct body *b, const struct window *w, double radius, const double *series, double unit,
                         struct status *status)
{
  struct oscillation found;
  b->strouhal = b->swing = NAN;
  if (!(b->reynolds > body_steady_below) || w->count < 2) return true;
  if (!fit_oscillation(series, w->count, &found, status)) return false;
  const double interval = (double)(b->last - b->first) / (double)(w->count - 1);
  if (found.frequency * (double)w->count < 2 || found.amplitude < 1e-3 * unit) return true;
  b->strouhal = 2 * radius * found.frequency / (interval * b->speed.mean);
  b->swing = found.amplitude / unit;
  return true;
}

static bool analyse_free(struct body *b, const struct scene *scene, const struct history *h, const struct window *w,
                         double *series, struct status *status)
{
  const struct frame frame = frame_of(scene, false);
  const struct disc_spec *disc = &scene->particles.discs[0];
  const double gravity = hypot(scene->particles.gravity[0], scene->particles.gravity[1]);
  component(h, w, HISTORY_VX, frame.along, 1, series);
  b->speed = fit_spread(series, w->count);
  const double weight = disc->radius * gravity * fabs(disc->density - 1), speed2 = b->speed.mean * b->speed.mean;
  b->reynolds = 2 * b->speed.mean * disc->radius / scene->fluid.viscosity;
  b->drag = M_PI * weight / speed2;
  b->drag_printed = 8.0 / 3 * weight / speed2;
  b->drag_spread = b->lift.mean = b->lift.deviation = b->torque.mean = b->torque.deviation = NAN;
  component(h, w, HISTORY_VX, frame.across, 1, series);
  return add_shedding(b, w, disc->radius, series, b->speed.mean, status);
}

static bool analyse_held(struct body *b, const struct scene *scene, const struct history *h, const struct window *w,
                         double *series, struct status *status)
{
  const struct frame frame = frame_of(scene, true);
  const double radius = scene->particles.discs[0].radius;
  double stream[2];
  stream_of(scene, stream);
  b->speed = (struct spread){hypot(stream[0], stream[1]), 0};
  b->reynolds = 2 * b->speed.mean * radius / scene->fluid.viscosity;
  const double unit = b->speed.mean * b->speed.mean * radius;
  component(h, w, HISTORY_FX, frame.along, 1 / unit, series);
  const struct spread drag = fit_spread(series, w->count);
  b->drag = drag.mean;
  b->drag_spread = drag.deviation;
  b->drag_printed = NAN;
  for (size_t k = 0; k < w->count; k++) series[k] = history_at(h, w->first + k, 0, HISTORY_TORQUE) / (unit * radius);
  b->torque = fit_spread(series, w->count);
  component(h, w, HISTORY_FX, frame.across, 1 / unit, series);
  b->lift = fit_spread(series, w->count);
  return add_shedding(b, w, radius, series, 1, status);
}

bool body_analyse(struct body *b, const struct scene *scene, const struct history *h, struct status *status)
{
  *b = (struct body){.held = scene->particles.discs[0].motion != DISC_FREE};
  const struct frame frame = frame_of(scene, b->held);
  const struct window w = window_of(scene, h, &frame, b->held);
  if (w.count == 0) return status_fail(status, DELBM_INVALID, "the disc starts within ten diameters of the side ahead");
  double *series = memory_allocate(w.count, sizeof *series, "the series of a disc", status);
  if (!series) return false;
  b->first = h->step[w.first];
  b->last = h->step[w.first + w.count - 1];
  bool ok = b->held ? analyse_held(b, scene, h, &w, series, status) : analyse_free(b, scene, h, &w, series, status);
  for (size_t k = 0; k < w.count; k++) series[k] = history_at(h, w.first + k, 0, HISTORY_OMEGA);
  b->spin = fit_spread(series, w.count).mean * scene->particles.discs[0].radius / b->speed.mean;
  free(series);
  return ok;
}
