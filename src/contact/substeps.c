#include "contact/substeps.h"

#include "contact/law.h"

#include <math.h>

/* The number that resolves contacts with these rates. */
static int resolving(const struct scene *scene, const struct contact_rates *rates)
{
  const double half_period = M_PI / sqrt(fmax(rates->spring, 1e-300)); /* of the undamped contact */
  const double for_spring = scene->contact.steps_per_contact / half_period;
  /* Bound of damping * compliance * h: overshoot from 1 on; restitution within 1 % of the case's needs a smaller one. */
  const double resolved = scene->contact.restitution > 0 ? 0.15 : 0.5;
  const double for_damper = rates->damper / resolved;
  return (int)fmin(fmax(1, ceil(fmax(for_spring, for_damper))), 1e9);
}

int substeps_needed(const struct scene *scene, const struct contact_rates *rates)
{
  if (!rates->any) return 1;
  return scene->contact.substeps > 0 ? scene->contact.substeps : resolving(scene, rates);
}

struct contact_rates substeps_rates(const struct contact_law *law, double stiffness, double compliance)
{
  const double slip = law->friction > 0 ? 3 * law->tangential_ratio : 0; /* c_t = 3 c_n for discs */
  const double turn = 6 * law->rolling_friction * law->rolling_friction; /* k_r c_r over k_n c_n, at most */
  return (struct contact_rates){.any = true,
                                .spring = stiffness * compliance * fmax(1, fmax(slip, turn)),
                                .damper = contact_damping(law, compliance, stiffness) * compliance};
}

static struct contact_rates larger(struct contact_rates a, const struct contact_law *law, double radius, double other,
                                   double compliance)
{
  const double stiffness = contact_spring_at(law, (const double[2]){radius, other}, 1).stiffness;
  const struct contact_rates b = substeps_rates(law, stiffness, compliance);
  return (struct contact_rates){true, fmax(a.spring, b.spring), fmax(a.damper, b.damper)};
}

int substeps_automatic(const struct scene *scene)
{
  double min_mass = INFINITY, max_radius = 0;
  const struct contact_law law = contact_law_of(scene);
  const struct disc_spec *discs = scene->particles.discs;
  for (size_t i = 0; i < scene->particles.count; i++) {
    max_radius = fmax(max_radius, discs[i].radius);
    if (discs[i].motion == DISC_FREE) min_mass = fmin(min_mass, discs[i].density * disc_spec_area(&discs[i]));
  }
  struct contact_rates rates = {0};
  for (size_t i = 0; i < scene->particles.count; i++) {
    const double mass = discs[i].density * disc_spec_area(&discs[i]);
    if (discs[i].motion != DISC_FREE) continue;
    rates = larger(rates, &law, discs[i].radius, max_radius, 1 / mass + 1 / min_mass);
    rates = larger(rates, &law, discs[i].radius, INFINITY, 1 / mass);
  }
  return rates.any ? resolving(scene, &rates) : 1;
}

int substeps_by_lens(const struct scene *scene)
{
  return scene->contact.substeps > 0 ? scene->contact.substeps : substeps_automatic(scene);
}

int substeps_max(const struct scene *scene)
{
  return scene->contact.area == AREA_CELLS ? 1 : substeps_by_lens(scene);
}
