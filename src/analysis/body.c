#include "analysis/body.h"

#include "analysis/plateau.h"
#include "base/memory.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Unit vector along the stream, or along gravity, and the unit vector a quarter turn counter-clockwise from it. */
struct frame {
  double along[2], across[2];
};

struct window {
  size_t first, count; /* snapshots */
};

struct work {
  const struct scene *scene;
  const struct history *history;
  struct frame frame;
  double radius; /* mean */
  struct window window;
  double *way, *speed; /* [snapshots] through the fluid, along gravity; `way` serves as scratch too */
};

static bool all_held_alike(const struct scene *scene)
{
  const struct disc_spec *disc = scene->particles.discs;
  for (size_t i = 0; i < scene->particles.count; i++)
    if (disc[i].motion == DISC_FREE || disc[i].motion != disc[0].motion || disc[i].velocity[0] != disc[0].velocity[0] ||
        disc[i].velocity[1] != disc[0].velocity[1])
      return false;
  return scene->particles.count > 0;
}

static bool is_moving(const double vector[2])
{
  return vector[0] != 0 || vector[1] != 0;
}

/* True where fluid is driven past fixed or driven discs. */
static bool has_stream(const struct scene *scene)
{
  const struct disc_spec *disc = &scene->particles.discs[0];
  bool driven = is_moving(scene->fluid.force) || (disc->motion == DISC_DRIVEN && is_moving(disc->velocity));
  for (int k = 0; k < SIDE_COUNT; k++) driven |= is_moving(scene->domain.side[k].velocity);
  return driven;
}

bool body_applies(const struct scene *scene)
{
  if (scene->fluid.none) return false;
  if (all_held_alike(scene)) return has_stream(scene);
  const double *gravity = scene->particles.gravity;
  return scene->particles.count == 1 && (gravity[0] == 0) != (gravity[1] == 0) &&
         scene->particles.discs[0].density != 1;
}

static struct frame frame_along(const double to[2])
{
  const double length = hypot(to[0], to[1]);
  return (struct frame){{to[0] / length, to[1] / length}, {-to[1] / length, to[0] / length}};
}

/* Along gravity, or against it for a light disc, which rises. */
static struct frame frame_of_fall(const struct scene *scene)
{
  const double sense = scene->particles.discs[0].density > 1 ? 1 : -1, *gravity = scene->particles.gravity;
  return frame_along((double[2]){sense * gravity[0], sense * gravity[1]});
}

static double along(const double direction[2], const double vector[2])
{
  return direction[0] * vector[0] + direction[1] * vector[1];
}

/* Mean over the discs of the component of a pair of columns along a direction. */
static double component_at(const struct history *h, size_t snapshot, enum history_column x, const double direction[2])
{
  double sum = 0;
  for (size_t i = 0; i < h->discs; i++)
    sum += direction[0] * history_at(h, snapshot, i, x) +
           direction[1] * history_at(h, snapshot, i, (enum history_column)(x + 1));
  return sum / (double)h->discs;
}

static double mean_at(const struct history *h, size_t snapshot, enum history_column column)
{
  double sum = 0;
  for (size_t i = 0; i < h->discs; i++) sum += history_at(h, snapshot, i, column);
  return sum / (double)h->discs;
}

/* The mean over the discs of a component over the window, times a factor. */
static void component(const struct work *w, enum history_column x, const double direction[2], double factor, double *to)
{
  for (size_t k = 0; k < w->window.count; k++)
    to[k] = factor * component_at(w->history, w->window.first + k, x, direction);
}

/* `series` has one value for each snapshot of the window. */
static bool add_shedding(struct body *b, const struct work *w, const double *series, double unit, struct status *status)
{
  struct oscillation found;
  const size_t first = w->window.first, count = w->window.count;
  if (!(b->reynolds > body_steady_below) || count < 2) return true;
  if (!fit_oscillation(series, count, &found, status)) return false;
  const double interval = (double)(w->history->step[first + count - 1] - w->history->step[first]) / (double)(count - 1);
  if (found.frequency * (double)count < body_min_cycles || found.amplitude < 1e-3 * unit) return true;
  b->strouhal = 2 * w->radius * found.frequency / (interval * b->speed.mean);
  b->swing = found.amplitude / unit;
  b->growth = fit_spread(series + count - count / 3, count / 3).deviation / fit_spread(series, count / 3).deviation;
  return true;
}

static void set_window(struct body *b, struct work *w, size_t first, size_t count)
{
  w->window = (struct window){first, count};
  b->first = w->history->step[first];
  b->last = w->history->step[first + count - 1];
}

static void set_speed(struct body *b, const struct work *w, struct spread speed)
{
  b->speed = speed;
  b->reynolds = 2 * speed.mean * w->radius / w->scene->fluid.viscosity;
}

static void set_spin(struct body *b, const struct work *w)
{
  double sum = 0;
  for (size_t k = 0; k < w->window.count; k++) sum += mean_at(w->history, w->window.first + k, HISTORY_OMEGA);
  b->spin = sum / (double)w->window.count * w->radius / b->speed.mean;
}

/* Distance from the disc to the side that it approaches; infinite where it approaches none. */
static double room_ahead(const struct work *w, int axis, size_t snapshot)
{
  const double at = history_at(w->history, snapshot, 0, axis == 0 ? HISTORY_X : HISTORY_Y);
  const double velocity = history_at(w->history, snapshot, 0, axis == 0 ? HISTORY_VX : HISTORY_VY);
  if (scene_is_periodic(w->scene, axis) || velocity == 0) return INFINITY;
  return velocity < 0 ? at : w->scene->domain.size[axis] - at;
}

/* Speed through the fluid at all snapshots; returns the number of snapshots before a side is near. */
static size_t speeds_of(const struct body *b, struct work *w, int axis)
{
  const struct history *h = w->history;
  size_t fall = h->snapshots;
  for (size_t n = 0; n < h->snapshots; n++) {
    w->speed[n] = component_at(h, n, HISTORY_VX, w->frame.along) - along(w->frame.along, b->ambient.velocity);
    if (n < fall && room_ahead(w, axis, n) <= 2 * body_side_ahead * w->radius) fall = n;
  }
  return fall;
}

/* Turns the frame so that the last quarter of the fall has a positive speed. True if the disc then moves with its
 * weight. */
static bool turn_frame(struct work *w, size_t fall)
{
  const size_t first = fall - (fall + 3) / 4;
  if (fall == 0 || fit_spread(w->speed + first, fall - first).mean >= 0) return true;
  for (size_t n = 0; n < w->history->snapshots; n++) w->speed[n] = -w->speed[n];
  for (int axis = 0; axis < 2; axis++) {
    w->frame.along[axis] = -w->frame.along[axis];
    w->frame.across[axis] = -w->frame.across[axis];
  }
  return false;
}

static void add_ways(const struct work *w)
{
  const int64_t *step = w->history->step;
  w->way[0] = 0;
  for (size_t n = 1; n < w->history->snapshots; n++)
    w->way[n] = w->way[n - 1] + 0.5 * (w->speed[n] + w->speed[n - 1]) * (double)(step[n] - step[n - 1]);
}

static void find_fastest(struct body *b, const struct work *w)
{
  if (b->relative == AMBIENT_MEAN) return;
  for (size_t n = 0; n < w->history->snapshots; n++) {
    if (w->speed[n] <= b->fastest) continue;
    b->fastest = w->speed[n];
    b->fastest_step = w->history->step[n];
  }
}

/* The reason why there is no terminal speed. */
static void note_absence(struct body *b, const struct work *w, const struct plateau *p, size_t fall)
{
  const double diameters = fall > 0 ? w->way[fall - 1] / (2 * w->radius) : 0, percent = 100 * p->drift;
  const size_t size = sizeof b->note;
  if (p->kind == PLATEAU_SHORT && diameters >= body_min_way)
    snprintf(b->note, size, "no terminal speed: fewer than three rows of the fall; output.every is too long");
  else if (p->kind == PLATEAU_SHORT)
    snprintf(b->note, size,
             "no terminal speed: %.2g diameters of fall before the run ends or a side is near; %g are needed",
             diameters, body_min_way);
  else if (fabs(percent) <= 100 * plateau_tolerance)
    snprintf(b->note, size, "no terminal speed: the speed fluctuates too much over the last %g diameters",
             body_min_way);
  else
    snprintf(b->note, size, "no terminal speed: still %s, by %.2g %% over the last %g diameters",
             percent > 0 ? "accelerating" : "slowing down", fabs(percent), body_min_way);
}

/* A speed that changes for good after the plateau. */
static void note_change(struct body *b, const struct work *w, const struct plateau *p, size_t fall)
{
  const size_t end = p->first + p->count;
  size_t rest = fall;
  while (rest > end && w->way[fall - 1] - w->way[rest - 1] < 2 * w->radius * body_min_way) rest--;
  if (rest <= end) return;
  const double after = fit_spread(w->speed + rest, fall - rest).mean / b->speed.mean - 1;
  snprintf(b->note, sizeof b->note,
           "the speed changes again after step %" PRId64 ", to %+.2g %% at the end of the fall", b->last, 100 * after);
}

static const char *const unknown_mean =
    "the mean velocity of the fluid is unknown; run.json has it once a run has ended";

static void add_drag_of_weight(struct body *b, const struct work *w)
{
  const struct disc_spec *disc = &w->scene->particles.discs[0];
  const double gravity = hypot(w->scene->particles.gravity[0], w->scene->particles.gravity[1]);
  const double weight = disc->radius * gravity * fabs(disc->density - 1), speed2 = b->speed.mean * b->speed.mean;
  b->drag = M_PI * weight / speed2;
  b->drag_printed = 8.0 / 3 * weight / speed2;
}

static bool analyse_free(struct body *b, struct work *w, struct status *status)
{
  w->frame = frame_of_fall(w->scene);
  const int axis = w->frame.along[0] == 0;
  b->relative = b->ambient.kind[axis];
  b->ambient.velocity[!axis] = 0; /* the component across gravity does not enter U */
  if (isnan(b->ambient.velocity[axis])) {
    snprintf(b->note, sizeof b->note, "no speed: %s", unknown_mean);
    return true;
  }
  const size_t fall = speeds_of(b, w, axis);
  const bool with_weight = turn_frame(w, fall);
  add_ways(w);
  find_fastest(b, w);
  struct plateau plateau;
  if (!plateau_find(w->way, w->speed, fall, 2 * w->radius * body_min_way, &plateau, status)) return false;
  if (plateau.kind != PLATEAU_FOUND) {
    note_absence(b, w, &plateau, fall);
    return true;
  }
  set_window(b, w, plateau.first, plateau.count);
  set_speed(b, w, fit_spread(w->speed + plateau.first, plateau.count));
  note_change(b, w, &plateau, fall);
  if (with_weight)
    add_drag_of_weight(b, w);
  else
    snprintf(b->note, sizeof b->note, "no drag coefficient: the disc moves through the fluid against its weight");
  set_spin(b, w);
  w->window = (struct window){fall / 2, fall - fall / 2};
  component(w, HISTORY_VX, w->frame.across, 1, w->way);
  return add_shedding(b, w, w->way, b->speed.mean, status);
}

/* Notes a window that is not steady: mean drags of its halves that differ by more than 1 %. */
static void note_drift(struct body *b, const double *drag, size_t count)
{
  if (count < 2) return;
  const double early = fit_spread(drag, count / 2).mean, late = fit_spread(drag + count / 2, count - count / 2).mean;
  if (fabs(late - early) > 0.01 * fabs(b->drag))
    snprintf(b->note, sizeof b->note,
             "not steady: between the halves of the last quarter of the run the drag changes by %+.2g %%",
             100 * (late - early) / fabs(b->drag));
}

static bool analyse_prescribed(struct body *b, struct work *w, struct status *status)
{
  const struct disc_spec *disc = &w->scene->particles.discs[0];
  double stream[2];
  for (int axis = 0; axis < 2; axis++)
    stream[axis] = b->ambient.velocity[axis] - (disc->motion == DISC_DRIVEN ? disc->velocity[axis] : 0);
  const double speed = hypot(stream[0], stream[1]);
  b->relative = b->ambient.kind[0] == AMBIENT_REST ? b->ambient.kind[1] : b->ambient.kind[0];
  if (!(speed > 0)) {
    snprintf(b->note, sizeof b->note, "no coefficients: %s",
             speed == 0 ? "the fluid has no mean velocity relative to the discs" : unknown_mean);
    return true;
  }
  w->frame = frame_along(stream);
  const size_t all = w->history->snapshots, first = all - (all + 3) / 4;
  set_window(b, w, first, all - first);
  set_speed(b, w, (struct spread){speed, 0});
  const double unit = speed * speed * w->radius;
  double *series = w->way;
  component(w, HISTORY_FX, w->frame.along, 1 / unit, series);
  const struct spread drag = fit_spread(series, w->window.count);
  b->drag = drag.mean;
  b->drag_spread = drag.deviation;
  b->resistance = drag.mean * unit / (w->scene->fluid.viscosity * speed);
  note_drift(b, series, w->window.count);
  for (size_t k = 0; k < w->window.count; k++)
    series[k] = mean_at(w->history, first + k, HISTORY_TORQUE) / (unit * w->radius);
  b->torque = fit_spread(series, w->window.count);
  set_spin(b, w);
  component(w, HISTORY_FX, w->frame.across, 1 / unit, series);
  b->lift = fit_spread(series, w->window.count);
  return add_shedding(b, w, series, 1, status);
}

bool body_analyse(struct body *b, const struct scene *scene, const double mean[2], const struct history *history,
                  struct status *status)
{
  const struct spread unknown = {NAN, NAN};
  *b = (struct body){.prescribed = scene->particles.discs[0].motion != DISC_FREE,
                     .ambient = ambient_of(scene, mean),
                     .first = history->step[0],
                     .last = history->step[history->snapshots - 1],
                     .speed = unknown,
                     .fastest = -INFINITY,
                     .reynolds = NAN,
                     .drag = NAN,
                     .drag_printed = NAN,
                     .drag_spread = NAN,
                     .resistance = NAN,
                     .lift = unknown,
                     .torque = unknown,
                     .spin = NAN,
                     .strouhal = NAN,
                     .swing = NAN,
                     .growth = NAN};
  double *series = memory_allocate(2 * history->snapshots, sizeof *series, "the series of a disc", status);
  if (!series) return false;
  struct work w = {.scene = scene,
                   .history = history,
                   .radius = scene_mean_radius(scene),
                   .way = series,
                   .speed = series + history->snapshots};
  const bool ok = b->prescribed ? analyse_prescribed(b, &w, status) : analyse_free(b, &w, status);
  free(series);
  return ok;
}
