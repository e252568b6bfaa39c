#include "contact/substeps.h"

#include "contact/law.h"

#include <math.h>

int substeps_needed(const struct scene *scene, const struct contact_rates *rates)
{
  if (!rates->any) return 1;
  if (scene->contact.substeps > 0) return scene->contact.substeps;
  const double half_period = M_PI / sqrt(fmax(rates->spring, 1e-300)); /* of the undamped contact */
  const double for_spring = scene->contact.steps_per_contact / half_period;
  /* Bound of damping * compliance * h: overshoot from 1 on; restitution within 1 % of the case's needs a smaller one. */
  const double resolved = scene->contact.restitution > 0 ? 0.15 : 0.5;
  const double for_damper = rates->damper / resolved;
  return (int)fmin(fmax(1, ceil(fmax(for_spring, for_damper))), 1e9);
}

struct contact_rates substeps_rates(const struct contact_law *law, double stiffness, double compliance)
{
  const double slip = law->friction > 0 ? 3 * law->tangential_ratio : 0; /* c_t = 3 c_n for discs */
  const double turn = 6 * law->rolling_friction * law->rolling_friction; /* k_r c_r over k_n c_n, at most */
  return (struct contact_rates){.any = true,
                                .spring = stiffness * compliance * fmax(1, fmax(slip, turn)),
                                .damper = contact_damping(law, compliance, stiffness) * compliance};
}

int substeps_by_lens(const struct scene *scene)
{
  double min_mass = INFINITY, radius = 0;
  const struct contact_law law = contact_law_of(scene);
  for (size_t i = 0; i < scene->particles.count; i++) {
    const struct disc_spec *disc = &scene->particles.discs[i];
    if (disc->motion != DISC_FREE) continue;
    min_mass = fmin(min_mass, disc->density * disc_spec_area(disc));
    radius = fmax(radius, disc->radius);
  }
  if (!(min_mass < INFINITY)) return 1;
  const double stiffness = contact_spring_at(&law, (const double[2]){radius, INFINITY}, 1).stiffness;
  const struct contact_rates rates = substeps_rates(&law, stiffness, 2 / min_mass);
  return substeps_needed(scene, &rates);
}

int substeps_max(const struct scene *scene)
{
  return scene->contact.area == AREA_CELLS ? 1 : substeps_by_lens(scene);
}
