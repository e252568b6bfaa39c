#include "sim/plan.h"

#include "contact/law.h"
#include "contact/lens.h"

#include <math.h>

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

struct plan plan_of(const struct scene *scene)
{
  size_t moving = 0, free = 0;
  for (size_t i = 0; i < scene->particles.count; i++) {
    moving += scene->particles.discs[i].motion != DISC_FIXED;
    free += scene->particles.discs[i].motion == DISC_FREE;
  }
  struct plan plan = {.exchange = scene->particles.count > 0,
                      .pairs = scene->particles.count > 1 && free > 0,
                      .walls = free > 0 && !(scene_is_periodic(scene, 0) && scene_is_periodic(scene, 1)),
                      .force = scene->fluid.force[0] != 0 || scene->fluid.force[1] != 0 || scene->fluid.zero_flux};
  plan.occupation = !plan.exchange ? OCCUPATION_NEVER : moving ? OCCUPATION_EVERY_STEP : OCCUPATION_ONCE;
  plan.substeps = (plan.pairs || plan.walls) && plan_largest_substeps(scene) > 1;
  plan.reach = plan.pairs && plan.substeps;
  return plan;
}
