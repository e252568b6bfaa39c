#include "sim/stages.h"

#include "contact/law.h"
#include "solid/lens.h"

#include <math.h>

const char *stage_name(enum stage stage)
{
  static const char *const names[STAGE_COUNT] = {"occupation", "contact", "exchange", "sweep", "boundary", "output"};
  return names[stage];
}

int plan_substeps(const struct scene *scene, double stiffness, double damping, double inverse_mass)
{
  if (scene->contact.substeps > 0) return scene->contact.substeps;
  const double half_period = M_PI / sqrt(fmax(stiffness * inverse_mass, 1e-300)); /* of the undamped contact */
  const double for_spring = scene->contact.steps_per_contact / half_period;
  const double for_damper = 2 * damping * inverse_mass; /* explicit damping overshoots from 2 on */
  return (int)fmin(fmax(1, ceil(fmax(for_spring, for_damper))), 1e9);
}

int plan_largest_substeps(const struct scene *scene)
{
  double least_mass = INFINITY, radius = 0;
  const struct contact_law law = contact_law_of(scene);
  for (size_t i = 0; i < scene->particles.count; i++) {
    const struct disc_spec *disc = &scene->particles.discs[i];
    if (disc->motion != DISC_FREE) continue;
    least_mass = fmin(least_mass, disc->density * M_PI * disc->radius * disc->radius);
    radius = fmax(radius, disc->radius);
  }
  if (!(least_mass < INFINITY)) return 1;
  const double chord = lens_of_wall(radius, radius - 1).chord;
  return plan_substeps(scene, law.stiffness * chord, contact_damping(&law, 2 / least_mass), 2 / least_mass);
}

struct stages stages_of(const struct scene *scene)
{
  size_t moving = 0, free = 0;
  for (size_t i = 0; i < scene->particles.count; i++) {
    moving += scene->particles.discs[i].motion != DISC_FIXED;
    free += scene->particles.discs[i].motion == DISC_FREE;
  }
  struct stages stages = {.exchange = scene->particles.count > 0,
                          .pairs = scene->particles.count > 1 && free > 0,
                          .walls = free > 0 && !(scene_is_periodic(scene, 0) && scene_is_periodic(scene, 1)),
                          .force = scene->fluid.force[0] != 0 || scene->fluid.force[1] != 0 || scene->fluid.zero_flux};
  stages.occupation = !stages.exchange ? OCCUPATION_NEVER : moving ? OCCUPATION_EVERY_STEP : OCCUPATION_ONCE;
  stages.substeps = (stages.pairs || stages.walls) && plan_largest_substeps(scene) > 1;
  stages.reach = stages.pairs && stages.substeps;
  return stages;
}
