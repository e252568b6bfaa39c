/* The weight B of a cell's occupation fraction eps, with t = tau - 1/2 = 3 viscosity:
 *
 *   owen, unified (19):  B = eps t/((1 - eps) + t)
 *   midpoint:            B = eps t/((1 - eps) + t eps (1 + give)), so that (1 - B)/B = (1 - eps)/(t eps) + give
 *
 * In the second the drag of a cell on the mean of its velocities before and after collision, 2 B/(1 - B), is in
 * proportion to viscosity, as stresses are (see sweep_kernel.c). The two agree where viscosity is small.
 *
 * Give. Where B = 1 populations are only exchanged with those opposite, and nothing damps what goes to and fro between
 * two cells. Where a disc moves, or a force on the fluid changes from step to step, such modes are driven: by the rim
 * of a disc that spins in its place until they grow by themselves, by all that shakes a pile of discs until, some ten
 * thousand steps later, fluid inside moves faster than sound. So a disc that moves is not wholly solid inside, and the
 * less so the faster its rim. A fixed one that does not spin is: its forces in slow flow then do not depend on
 * viscosity. And where a disc meets another or a wall, fluid caught between them could never leave, and would carry for
 * ever what weighs on it in place of the contact; or, if their surfaces pass each other, be driven ever faster. So the cells
 * that both cover, or next to the wall, give. */
#ifndef DELBM_SOLID_WEIGHT_H
#define DELBM_SOLID_WEIGHT_H

#include "scene/scene.h"

/* B = eps t/((1 - eps) + t (rest + part eps)). */
struct weight_law {
  double t, rest, part;
};

/* The give of a disc. A third of either part still damps what was seen to need it: a pile of 150 discs, and a rim at Mach
 * 0.14 (map "fixed disc that spins"). */
static inline double weight_give(enum coupling_form form, enum disc_motion motion, double radius, double omega)
{
  const double rim = radius * omega, moving = motion == DISC_FIXED ? 0 : 0.02, spinning = 4 * rim * rim;
  if (form != FORM_MIDPOINT) return 0;
  return spinning > moving ? spinning : moving;
}

/* That of cells between a disc and what it meets. With 0.05 fluid caught there left within some 10,000 steps (R = 10), and
 * surfaces that pass each other drove it at three times their speed; with this it is no faster than they in the map "fixed
 * disc under a lid". */
static inline double weight_give_between(enum coupling_form form)
{
  return form == FORM_MIDPOINT ? 0.5 : 0;
}

static inline struct weight_law weight_law(enum coupling_form form, double viscosity, double give)
{
  const bool midpoint = form == FORM_MIDPOINT;
  return (struct weight_law){3 * viscosity, midpoint ? 0 : 1, midpoint ? 1 + give : 0};
}

static inline double weight_of(struct weight_law law, double eps)
{
  return eps * law.t / ((1 - eps) + law.t * (law.rest + law.part * eps));
}

/* The occupation fraction of a cell with weight B, that of all its owners' shares together. */
static inline double weight_fraction(struct weight_law law, double weight)
{
  return weight * (1 + law.t * law.rest) / (law.t + weight * (1 - law.t * law.part));
}

#endif
