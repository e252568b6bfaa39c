/* Spring forces of the contact laws (law.h), one contact at a time; inlined into the vector loops of contact_kernel.c. */
#ifndef DELBM_CONTACT_LAW_SPRING_H
#define DELBM_CONTACT_LAW_SPRING_H

#include <math.h>

/* In the order of the choices of the key contact.law. */
enum contact_spring_law { SPRING_OVERLAP, SPRING_HERTZ, SPRING_LINEAR };

/* Spring force; `area` is used by SPRING_OVERLAP alone. `depth` >= 0. */
static inline double spring_force(enum contact_spring_law law, double strength, double depth, double area)
{
  return strength * (law == SPRING_OVERLAP ? area : law == SPRING_HERTZ ? depth * sqrt(depth) : depth);
}

/* Its derivative by the overlap. */
static inline double spring_stiffness(enum contact_spring_law law, double strength, double depth, double chord)
{
  return strength * (law == SPRING_OVERLAP ? chord : law == SPRING_HERTZ ? 1.5 * sqrt(depth) : 1);
}

/* The force as strength delta^p in the limit of small overlap: the exponent p, and the force. `reduced_radius` is R*. */
static inline double spring_exponent(enum contact_spring_law law)
{
  return law == SPRING_LINEAR ? 1 : 1.5;
}

static inline double spring_small_force(enum contact_spring_law law, double strength, double depth,
                                        double reduced_radius)
{
  return spring_force(law, strength, depth, 4. / 3 * sqrt(2 * reduced_radius * depth) * depth);
}

/* Upper bound of this derivative from the overlap alone. The chord is at most 2 sqrt(2 R*
 * delta). */
static inline double spring_max_stiffness(enum contact_spring_law law, double strength, double depth,
                                          double reduced_radius)
{
  return spring_stiffness(law, strength, depth, 2 * sqrt(2 * reduced_radius * depth));
}

#endif
