/* The weight B of a cell's occupation fraction eps, with t = tau - 1/2 = 3 viscosity:
 *
 *   owen, unified (19):  B = eps t/((1 - eps) + t)
 *   midpoint:            B = eps t/((1 - eps) + t eps), so that B/(1 - B) = t eps/(1 - eps)
 *
 * In the second the drag of a cell on the mean of its velocities before and after collision, 2 B/(1 - B), is in
 * proportion to viscosity, as stresses are (see sweep_kernel.c). The two agree where viscosity is small. */
#ifndef DELBM_SOLID_WEIGHT_H
#define DELBM_SOLID_WEIGHT_H

#include "scene/scene.h"

/* B = eps t/((1 - eps) + t (rest + (1 - rest) eps)), with rest 1 or 0. */
struct weight_law {
  double three_nu, rest;
};

static inline struct weight_law weight_law(const struct scene *scene)
{
  return (struct weight_law){3 * scene->fluid.viscosity, scene->coupling.form == FORM_MIDPOINT ? 0 : 1};
}

static inline double weight_of(struct weight_law law, double eps)
{
  const double t = law.three_nu;
  return eps * t / ((1 - eps) + t * (law.rest + (1 - law.rest) * eps));
}

/* The occupation fraction of a cell with weight B, that of all its owners' shares together. */
static inline double weight_fraction(struct weight_law law, double weight)
{
  const double t = law.three_nu;
  return weight * (1 + t * law.rest) / (t + weight * (1 - t * (1 - law.rest)));
}

#endif
