#include "sim/zero_flux.h"

#include <math.h>

static const double acceleration_gain = 1.0 / 4, momentum_gain = 1.0 / 16;

/* Maximum change of the fluid velocity in one interval by the start or end of a load, cells/step. */
static const double max_change = 0.01;

/* Upper bound of the load along an axis per cell: body force and weight of free discs. */
static double max_load(const struct scene *scene, int axis)
{
  double buoyant_mass = 0;
  for (size_t i = 0; i < scene->particles.count; i++) {
    const struct disc_spec *disc = &scene->particles.discs[i];
    if (disc->motion == DISC_FREE) buoyant_mass += fabs(disc->density - 1) * disc_spec_area(disc);
  }
  return fabs(scene->fluid.force[axis]) +
         buoyant_mass * fabs(scene->particles.gravity[axis]) / (double)scene_cells(scene);
}

struct zero_flux zero_flux_create(const struct scene *scene)
{
  struct zero_flux z = {.closed = {scene_is_closed(scene, 0), scene_is_closed(scene, 1)}};
  if (!scene->fluid.zero_flux) return z;
  double interval = 16;
  for (int axis = 0; axis < 2; axis++) {
    if (!z.closed[axis]) continue;
    interval = fmin(interval, sqrt(3) / 2 * scene->domain.size[axis]);
    interval = fmin(interval, max_change / max_load(scene, axis));
  }
  z.interval = interval > 1 ? (int)interval : 1;
  return z;
}

void zero_flux_start(struct zero_flux *z, const double load[2], double uniform[2])
{
  for (int axis = 0; axis < 2; axis++) {
    z->load[axis] = load[axis];
    uniform[axis] = z->closed[axis] ? -load[axis] : 0;
  }
}

void zero_flux_update(struct zero_flux *z, const double mean[2], const double load[2], double uniform[2])
{
  for (int axis = 0; axis < 2; axis++) {
    const double feedback = acceleration_gain * (mean[axis] - z->mean_momentum[axis]) + momentum_gain * mean[axis];
    if (z->closed[axis]) uniform[axis] -= feedback / z->interval + (load[axis] - z->load[axis]);
    z->mean_momentum[axis] = mean[axis];
    z->load[axis] = load[axis];
  }
}

int64_t zero_flux_steps_left(const struct zero_flux *z, int64_t steps)
{
  const int64_t left = z->interval > 0 ? z->interval - z->phase : steps;
  return left < steps ? left : steps;
}
