/* Contact law: the impulse of a contact over a time h, from its kinematics and its state.
 *
 * Normal force (10): F = max(0, F_s + eta v), F_s the spring of the law, v the speed of approach, never attractive, limited by the
 * energy stored (state.h). eta = 2 eta_0 sqrt(k_n m_eff), 1/m_eff = 1/m_a + 1/m_b; (10) prints 1/m_eff under the root, which is not a
 * damping coefficient (contact.damping_form: printed).
 *
 * A new law is a function of type contact_spring, a row of the table in law.c, and its name as a choice of the key contact.law. */
#ifndef DELBM_CONTACT_LAW_H
#define DELBM_CONTACT_LAW_H

#include "contact/geometry.h"
#include "contact/state.h"

struct contact_law;

/* Force of a spring, and its derivative by the overlap. */
struct spring {
  double force, stiffness;
};
typedef struct spring contact_spring(const struct contact_law *law, const struct kinematics *kinematics);

struct contact_law {
  contact_spring *spring;
  double stiffness; /* alpha k_n */
  double k;         /* k_n */
  double damping;   /* eta_0 */
  enum contact_damping form;
};

/* On b; on a the opposite. Tangential: along t (geometry.h). */
struct contact_impulse {
  double normal, tangential;
};

struct contact_law contact_law_of(const struct scene *scene);

/* eta, for two bodies of inverse masses that sum to `inverse_mass`; 0 for two that cannot move. */
double contact_damping(const struct contact_law *law, double inverse_mass);

/* Impulse over the time h. Leaves the state for the next sub-step. */
struct contact_impulse contact_law(const struct contact_law *law, struct contact_state *state,
                                   const struct kinematics *kinematics, double h);

/* The spring of two bodies (b infinite: a side) at this overlap of exact lens area. */
struct spring contact_spring_at(const struct contact_law *law, const double radius[2], double overlap);

/* Energy of that spring at this overlap. */
double contact_energy(const struct contact_law *law, const double radius[2], double overlap);

#endif
