/* Damping ratio for a coefficient of restitution e, in the law m x'' = -(k x^p + 2 eta_0 sqrt(m d(k x^p)/dx) x'), x the
 * overlap: p = 1 for a linear spring, 3/2 for Hertz's law and for small overlap areas. The contact ends at zero force.
 *
 * In z, with z^2/2 the stored energy over m, and in the time tau with dz/dtau = x', the law is linear for every p:
 *   v' = -z - 2 zeta v,  zeta = eta_0 sqrt(2 p/(p + 1)),
 * so that e depends on neither k, m nor speed (cf. Antypov & Elliott 2011, Europhys. Lett. 94, 50004). The force, in
 * proportion to z + 2 zeta v, is zero at tau = 2 acos(zeta)/sqrt(1 - zeta^2), where the speed is exp(-zeta tau)
 * (p = 1: Schwager & Poeschel 2007, Granular Matter 9, 465):
 *   e = exp(-2 zeta acos(zeta)/sqrt(1 - zeta^2)).
 * e falls from 1 at zeta = 0 to exp(-2) = 0.135 at zeta = 1. */
#ifndef DELBM_CONTACT_RESTITUTION_H
#define DELBM_CONTACT_RESTITUTION_H

/* Range of e; the damping ratio at the lower end is 0.92 for p = 1. */
static const double restitution_min = 0.15, restitution_max = 1;

/* eta_0 for e within this range and p = `exponent`. */
double restitution_damping(double restitution, double exponent);

#endif
