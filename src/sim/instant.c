#include "sim/instant.h"

#include "contact/census.h"

#include <math.h>

/* Without the fluid that fills a disc: this fluid is counted as fluid (exchange.h). */
static double kinetic_energy_of_discs(const struct discs *d)
{
  double sum = 0;
  for (size_t i = 0; i < d->count; i++)
    sum += (d->mass[i] - d->fluid_mass[i]) * (d->vx[i] * d->vx[i] + d->vy[i] * d->vy[i]) / 2 +
           (d->inertia[i] - d->fluid_inertia[i]) * (d->omega[i] * d->omega[i]) / 2;
  return sum;
}

static void take_fluid(const struct instant_fluid *fluid, struct instant *instant)
{
  const struct populations *p = fluid->populations;
  const struct fluid_totals totals = diagnostics_totals(p, fluid->force);
  instant->kinetic_fluid = totals.kinetic;
  instant->excess_mass = totals.excess_mass;
  instant->max_mach = sqrt(diagnostics_worst(p, fluid->scan).speed2) * sqrt(3);
  fluid_mean_velocity(&totals, (double)p->nx * p->ny, fluid->force, instant->mean_velocity);
}

bool instant_take(const struct scene *scene, const struct instant_fluid *fluid, const struct discs *discs,
                  struct instant *instant, struct status *status)
{
  struct contact_census census;
  if (!contact_census(scene, discs, &census, status)) return false;
  *instant = (struct instant){.kinetic_discs = kinetic_energy_of_discs(discs),
                              .contacts = (double)census.contacts,
                              .max_overlap = census.max_overlap};
  if (fluid) take_fluid(fluid, instant);
  return true;
}
