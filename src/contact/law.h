/* Contact law: the impulse of a contact over a time h, from kinematics and state.
 *
 * Normal force (10): F = max(0, F_s + eta v), F_s the spring force, v the approach speed; the impulse is limited by
 * the stored energy (state.h). eta = 2 eta_0 sqrt(k_n m_eff), 1/m_eff = 1/m_a + 1/m_b. (10) prints 1/m_eff under the
 * root, which has not the unit of a damping coefficient (contact.damping_form: printed).
 *
 * A new law: a function of type contact_spring, a row of the table in law.c, a choice of the key contact.law. */
#ifndef DELBM_CONTACT_LAW_H
#define DELBM_CONTACT_LAW_H

#include "contact/geometry.h"
#include "contact/state.h"

struct contact_law;

/* Spring force and its derivative by the overlap. */
struct spring {
  double force, stiffness;
};
typedef struct spring contact_spring(const struct contact_law *law, const struct kinematics *kinematics);

struct contact_law {
  contact_spring *force_of;
  double alpha_k_n;
  double k_n;     /* contact.stiffness of the case */
  double damping; /* eta_0 */
  enum contact_damping form;
};

/* Impulse on b along n and t (geometry.h); on a the opposite. */
struct contact_impulse {
  double normal, tangential;
};

struct contact_law contact_law_of(const struct scene *scene);

/* eta for 1/m_eff = `inverse_mass`; 0 for two bodies of infinite mass. */
double contact_damping(const struct contact_law *law, double inverse_mass);

/* Impulse over the time h; updates the state. */
struct contact_impulse contact_law_impulse(const struct contact_law *law, struct contact_state *state,
                                           const struct kinematics *kinematics, double h);

/* The spring of two bodies (radius[1] infinite: a side) at an overlap, with the exact lens area. */
struct spring contact_spring_at(const struct contact_law *law, const double radius[2], double overlap);

/* Energy of this spring: integral of the force over the overlap. */
double contact_energy(const struct contact_law *law, const double radius[2], double overlap);

#endif
