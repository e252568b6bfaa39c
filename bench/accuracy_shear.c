/* The double shear layer of Minion & Brown (1997) at Re 10^4, against the pseudo-spectral solver: layers of 1/80 of
 * the box that roll up. A scheme that does not resolve them produces spurious vortices. */
#include "accuracy.h"

#include "base/memory.h"
#include "spectral.h"

#include <math.h>
#include <stdlib.h>

static const double reynolds = 1e4, duration = 1; /* box 1, speed 1 */

static double shear_vorticity(double x, double y)
{
  const double steep = 80, sway = 0.05, at = y < 0.5 ? y - 0.25 : 0.75 - y;
  const double layer = steep / pow(cosh(steep * at), 2);
  return 2 * M_PI * sway * cos(2 * M_PI * (x + 0.25)) + (y < 0.5 ? -layer : layer);
}

/* The reference at start and end. */
struct reference {
  struct spectral *start, *end;
};

static void destroy_reference(void *context)
{
  struct reference *reference = context;
  spectral_destroy(reference->start);
  spectral_destroy(reference->end);
  free(reference);
}

static void *create_reference(bool quick, struct status *status)
{
  const int points = quick ? 256 : 384, steps = quick ? 400 : 600;
  struct reference *reference = memory_allocate(1, sizeof *reference, "the reference", status);
  if (!reference) return NULL;
  bool ok = spectral_create(&reference->start, points, 1 / reynolds, status) &&
            spectral_create(&reference->end, points, 1 / reynolds, status);
  if (ok) {
    spectral_start(reference->start, shear_vorticity);
    spectral_start(reference->end, shear_vorticity);
    ok = spectral_advance(reference->end, duration / steps, steps, status);
  }
  if (ok) return reference;
  destroy_reference(reference);
  return NULL;
}

/* The reference at the centres of n x n cells. */
struct samples {
  int n;
  double speed; /* cells/step for a speed of 1 in the reference */
  double *values[SPECTRAL_PRESSURE + 1];
};

static void free_samples(struct samples *samples)
{
  for (int k = 0; k <= SPECTRAL_PRESSURE; k++) free(samples->values[k]);
}

static bool take_samples(struct samples *samples, struct spectral *spectral, enum spectral_quantity last,
                         struct status *status)
{
  const size_t cells = (size_t)samples->n * (size_t)samples->n;
  for (int k = 0; k <= (int)last; k++) {
    samples->values[k] = memory_allocate(cells, sizeof(double), "the reference", status);
    if (!samples->values[k] || !spectral_sample(spectral, k, samples->n, samples->values[k], status)) return false;
  }
  return true;
}

static struct flow_state sample_at(const void *context, int x, int y)
{
  const struct samples *s = context;
  const size_t at = (size_t)y * (size_t)s->n + (size_t)x;
  const double slope = s->speed / s->n, ux_x = slope * s->values[SPECTRAL_UX_X][at];
  return (struct flow_state){
      .density = 1 + 3 * s->speed * s->speed * s->values[SPECTRAL_PRESSURE][at],
      .velocity = {s->speed * s->values[SPECTRAL_UX][at], s->speed * s->values[SPECTRAL_UY][at]},
      .gradient = {{ux_x, slope * s->values[SPECTRAL_UX_Y][at]}, {slope * s->values[SPECTRAL_UY_X][at], -ux_x}}};
}

/* The speed is proportional to the cell size, as in taylor-green. */
static bool run_shear(void *context, const struct accuracy_choice *choice, int n, struct accuracy_outcome *outcome,
                      struct status *status)
{
  const struct reference *reference = context;
  struct samples start = {n, 6.4 / n, {NULL}}, end = start;
  struct scene scene = accuracy_scene(choice, n, n, start.speed * n / reynolds, SIDES_PERIODIC);
  struct simulation *simulation = NULL;
  bool ok = take_samples(&start, reference->start, SPECTRAL_PRESSURE, status) &&
            take_samples(&end, reference->end, SPECTRAL_UY, status) && simulation_create(&simulation, &scene, status);
  for (int k = 0; ok && k < n * n; k++) {
    end.values[SPECTRAL_UX][k] *= start.speed;
    end.values[SPECTRAL_UY][k] *= start.speed;
  }
  if (ok) simulation_start(simulation, sample_at, &start);
  ok = ok && accuracy_advance(simulation, llround(duration * n / start.speed), outcome, status) &&
       accuracy_field_error(simulation, end.values, &outcome->error, status);
  simulation_destroy(simulation);
  free_samples(&start);
  free_samples(&end);
  scene_clear(&scene);
  return ok;
}

const struct accuracy_case accuracy_shear_layer = {
    .name = "shear-layer",
    .error = "velocity against the spectral solver after one box length at Re 10^4, relative, mean square",
    .axis = "cells a side",
    .resolution = {32, 64, 128, 256},
    .quick = 3,
    .bound = 0.25,
    .run = run_shear,
    .prepare = create_reference,
    .finish = destroy_reference};
