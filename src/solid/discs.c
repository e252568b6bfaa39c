#include "solid/discs.h"

#include "base/memory.h"
#include "solid/solid_kernel.h"

#include <stdlib.h>

enum { DOUBLE_ARRAYS = 18 };

/* Assigns the arrays to parts of one block, each aligned to a cache line. */
static void carve(struct discs *d, char *block, size_t stride)
{
  double **const arrays[DOUBLE_ARRAYS] = {&d->radius,
                                          &d->mass,
                                          &d->fluid_mass,
                                          &d->inertia,
                                          &d->fluid_inertia,
                                          &d->buoyant_mass,
                                          &d->x,
                                          &d->y,
                                          &d->angle,
                                          &d->vx,
                                          &d->vy,
                                          &d->omega,
                                          &d->contact_fx,
                                          &d->contact_fy,
                                          &d->fx,
                                          &d->fy,
                                          &d->torque,
                                          &d->contact_torque};
  for (size_t k = 0; k < DOUBLE_ARRAYS; k++) *arrays[k] = (double *)(void *)(block + k * stride);
  d->motion = (uint8_t *)(block + DOUBLE_ARRAYS * stride);
}

static void set_disc(struct discs *d, size_t i, const struct shape_kind *kind, const struct disc_spec *spec,
                     double hydraulic_radius)
{
  const struct shape shape = {.kind = kind, .radius = spec->radius};
  const struct shape hydraulic = {.kind = kind, .radius = hydraulic_radius};
  const double displaced_mass = kind->area(&shape);
  d->shape[i] = shape;
  d->hydraulic[i] = hydraulic;
  d->radius[i] = spec->radius;
  d->mass[i] = spec->density * displaced_mass;
  d->inertia[i] = d->mass[i] * kind->gyration2(&shape);
  d->fluid_mass[i] = kind->area(&hydraulic);
  d->fluid_inertia[i] = d->fluid_mass[i] * kind->gyration2(&hydraulic);
  d->buoyant_mass[i] = d->mass[i] - displaced_mass;
  d->motion[i] = (uint8_t)spec->motion;
  d->x[i] = spec->position[0];
  d->y[i] = spec->position[1];
  d->angle[i] = spec->angle;
  d->vx[i] = spec->velocity[0];
  d->vy[i] = spec->velocity[1];
  d->omega[i] = spec->spin;
  d->moving += spec->motion != DISC_FIXED;
  d->free += spec->motion == DISC_FREE;
}

/* Without fluid. */
static void displace_nothing(struct discs *d)
{
  for (size_t i = 0; i < d->count; i++) {
    d->fluid_mass[i] = d->fluid_inertia[i] = 0;
    d->buoyant_mass[i] = d->mass[i];
  }
}

bool discs_create(struct discs *discs, const struct scene *scene, struct status *status)
{
  const size_t count = scene->particles.count;
  *discs = (struct discs){.count = count};
  if (count == 0) return true;
  const struct solid_kernel *kernel = solid_kernel_find(scene->fluid.kernel);
  const size_t stride = (count * sizeof(double) + CACHE_LINE - 1) / CACHE_LINE * CACHE_LINE;
  discs->block = memory_allocate(DOUBLE_ARRAYS + 1, stride, "the discs", status);
  discs->shape = memory_allocate(count, sizeof *discs->shape, "the discs", status);
  discs->hydraulic = memory_allocate(count, sizeof *discs->hydraulic, "the discs", status);
  if (!discs->block || !discs->shape || !discs->hydraulic) {
    discs_destroy(discs);
    return false;
  }
  carve(discs, discs->block, stride);
  for (size_t i = 0; i < count; i++) {
    const struct disc_spec *spec = &scene->particles.discs[i];
    set_disc(discs, i, &kernel->disc, spec, scene_hydraulic_radius(scene, spec));
  }
  if (scene->fluid.none) displace_nothing(discs);
  return true;
}

void discs_destroy(struct discs *discs)
{
  free(discs->block);
  free(discs->shape);
  free(discs->hydraulic);
  *discs = (struct discs){0};
}

bool discs_store(struct discs *d, struct store *store, struct status *status)
{
  double *const arrays[] = {d->x,  d->y,  d->angle,  d->vx,         d->vy,         d->omega,
                            d->fx, d->fy, d->torque, d->contact_fx, d->contact_fy, d->contact_torque};
  if (!store_mark(store, "discs", status)) return false;
  for (size_t k = 0; k < sizeof arrays / sizeof arrays[0]; k++)
    if (!store_bytes(store, arrays[k], d->count * sizeof(double), status)) return false;
  return true;
}
