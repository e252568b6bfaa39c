/* Contact law: parameters of the forces between two bodies.
 *
 * Spring force F_s of an overlap delta, R* = R_a R_b/(R_a + R_b) (a side: R_a), A the area and c the chord of the lens:
 *   overlap  alpha k_n A                               (10)
 *   hertz    alpha k_n (4/3) sqrt(2 R*) delta^(3/2)    (9), the limit of (10) for small overlap
 *   linear   alpha k_n c_1 delta                       (8), c_1 the chord at an overlap of 1 % of the smaller radius
 * alpha is given, or f(beta) of (11), beta the ratio of the radii.
 *
 * Normal force F_n = max(0, F_s + eta v), v the approach speed; the impulse is limited by the stored energy (state.h).
 * With 1/m_eff = 1/m_a + 1/m_b, eta is
 *   2 eta_0 sqrt(k_n m_eff)              contact.damping; (10) prints 1/m_eff under the root, which has not the unit of a
 *                                        damping coefficient (contact.damping_form: printed)
 *   2 eta_0 sqrt(m_eff dF_s/d delta)     contact.restitution: the restitution is independent of the speed of impact
 *
 * Friction and rolling friction: contact_kernel.c.
 *
 * A new law: a case in each function of law_spring.h, a row of the table in law.c, a choice of the key contact.law. */
#ifndef DELBM_CONTACT_LAW_H
#define DELBM_CONTACT_LAW_H

#include "contact/law_spring.h"
#include "model/scene.h"

struct contact_law {
  enum contact_spring_law spring;
  double k_n;     /* contact.stiffness of the case */
  double alpha;   /* 0: of the radii */
  double damping; /* eta_0 */
  bool by_rate;   /* eta from dF_s/d delta, by contact.restitution */
  enum contact_damping form;
  double friction;         /* Coulomb's coefficient */
  double tangential_ratio; /* tangential stiffness over dF_s/d delta */
  double rolling_friction; /* largest rolling torque over R* F_n */
};

struct contact_law contact_law_of(const struct scene *scene);

/* Factor of the spring force for two bodies (radius[1] infinite: a side), to be used in law_spring.h. */
double contact_strength(const struct contact_law *law, const double radius[2]);

/* eta for 1/m_eff = `inverse_mass` where dF_s/d delta = `stiffness`; 0 for two bodies of infinite mass. */
double contact_damping(const struct contact_law *law, double inverse_mass, double stiffness);

/* Spring force and its derivative by the overlap. */
struct spring {
  double force, stiffness;
};

/* The spring of two bodies at an overlap, with the exact lens area. */
struct spring contact_spring_at(const struct contact_law *law, const double radius[2], double overlap);

/* Energy of this spring: integral of the force over the overlap. */
double contact_energy(const struct contact_law *law, const double radius[2], double overlap);

#endif
