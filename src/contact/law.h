/* The normal contact force (10): proportional to the overlap area, damped, never attractive. */
#ifndef DELBM_CONTACT_LAW_H
#define DELBM_CONTACT_LAW_H

#include "model/scene.h"

#include <math.h>

struct contact_law {
  double stiffness; /* alpha k_n: force per overlap area */
  double k;         /* k_n */
  double damping;   /* eta_0 */
  enum contact_damping form;
};

static inline struct contact_law contact_law_of(const struct scene *scene)
{
  return (struct contact_law){.stiffness = scene->contact.alpha * scene->contact.stiffness,
                              .k = scene->contact.stiffness,
                              .damping = scene->contact.damping,
                              .form = scene->contact.damping_form};
}

/* eta, for two bodies of inverse masses that sum to `inverse_mass` = 1/m_i + 1/m_j (zero for one that cannot give way).
 * */
static inline double contact_damping(const struct contact_law *law, double inverse_mass)
{
  if (inverse_mass <= 0) return 0;
  /* as printed, the mass stands upside down under the root: not a damping coefficient, offered for comparison */
  const double under_root = law->form == DAMPING_CRITICAL ? law->k / inverse_mass : law->k * inverse_mass;
  return 2 * law->damping * sqrt(under_root);
}

/* Force that pushes the two apart, for overlap `area`, approach velocity `closing` and `damping` eta. */
static inline double contact_force(const struct contact_law *law, double area, double closing, double damping)
{
  if (area <= 0) return 0;
  return fmax(0, law->stiffness * area + damping * closing);
}

#endif
