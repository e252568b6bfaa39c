#include "api/handle.h"
#include "sim/sample.h"

#include <math.h>

static bool has_fluid(const struct delbm_simulation *s, struct status *status)
{
  return !s->scene.fluid.none || status_fail(status, DELBM_USAGE, "no fields: the case has fluid: none");
}

static bool read_occupation(const struct delbm_simulation *s, double *values, struct status *status)
{
  const int *size = s->scene.domain.size;
  const struct sample_grid all = {.count = {size[0], size[1]}, .stride = 1};
  return simulation_sample(s->simulation, &all, &(struct sample){.occupation = values}, status);
}

static bool read_field(struct delbm_simulation *s, enum delbm_field field, double *values, struct status *status)
{
  switch (field) {
  case DELBM_DENSITY:
    simulation_fields(s->simulation, values, NULL, NULL);
    return true;
  case DELBM_VELOCITY_X:
    simulation_fields(s->simulation, NULL, values, NULL);
    return true;
  case DELBM_VELOCITY_Y:
    simulation_fields(s->simulation, NULL, NULL, values);
    return true;
  case DELBM_OCCUPATION:
    return read_occupation(s, values, status);
  }
  return status_fail(status, DELBM_USAGE, "no field %d", (int)field);
}

enum delbm_code delbm_read_field(struct delbm_simulation *s, enum delbm_field field, double *values,
                                 struct delbm_status *out)
{
  struct api_call call;
  const bool good =
      api_enter(&call, s, out) && has_fluid(s, &call.status) && read_field(s, field, values, &call.status);
  return api_leave(&call, good);
}

static bool allows_fluid(const struct delbm_simulation *s, const double *rho, const double *ux, const double *uy,
                         struct status *status)
{
  const int nx = s->scene.domain.size[0];
  for (int64_t k = 0; k < scene_cells(&s->scene); k++)
    if (!(rho[k] > 0 && isfinite(rho[k]) && hypot(ux[k], uy[k]) <= scene_max_speed))
      return status_fail(status, DELBM_USAGE, "cell (%d, %d): density %g, velocity (%g, %g)", (int)(k % nx),
                         (int)(k / nx), rho[k], ux[k], uy[k]);
  return true;
}

static bool write_fluid(struct delbm_simulation *s, const double *density, const double *velocity_x,
                        const double *velocity_y, struct status *status)
{
  if (!simulation_usable(s->simulation, status) || !allows_fluid(s, density, velocity_x, velocity_y, status))
    return false;
  simulation_set_fluid(s->simulation, density, velocity_x, velocity_y);
  s->lost = !simulation_changed(s->simulation, status);
  return !s->lost;
}

enum delbm_code delbm_write_fluid(struct delbm_simulation *s, const double *density, const double *velocity_x,
                                  const double *velocity_y, struct delbm_status *out)
{
  struct api_call call;
  const bool good = api_enter(&call, s, out) && has_fluid(s, &call.status) &&
                    write_fluid(s, density, velocity_x, velocity_y, &call.status);
  return api_leave(&call, good);
}
