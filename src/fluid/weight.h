/* The weight B of a cell with occupation fraction eps, with t = tau - 1/2 = 3 viscosity:
 *
 *   owen, unified (19):  B = eps t/((1 - eps) + t)
 *   midpoint:            B = min(eps t/((1 - eps) + t eps), 1/(1 + d)), so that (1 - B)/B = max((1 - eps)/(t eps), d)
 *
 * In midpoint the drag coefficient of a cell for the mean of its velocities before and after collision, 2 B/(1 - B),
 * is proportional to viscosity, as stresses are (sweep_kernel.c). At small viscosity the two weights agree.
 *
 * Damping d. At B = 1 a cell reflects its momentum about the velocity of the solid: the amplification factor of the
 * difference is -1, so that an oscillation between cells of B = 1 never decays. With the upper bound of B the factor
 * of all moments of such a cell is -(1 - d)/(1 + d).
 *
 * A cell of weight B is a porous medium (Brinkman) of permeability viscosity (1 - B)/(2 B), so that
 *   d = 2 permeability/viscosity
 * is a constant permeability of solids, 0.001 cells^2: slow flow is then independent of viscosity also with damping
 * (trt), and the drag of a square array of R = 5 changes by 0.04 % at a solid fraction of 0.2 and by 0.6 % at 0.5.
 * (A constant d = 0.1 changes the drag at 0.5 by 5 % at viscosity 1/6 and by 30 % at 1.) The bound of d, 0.5, is
 * reached below viscosity 0.004: at d > 1 the velocity difference between fluid and disc decays the slower the
 * larger d.
 *
 * The rim of a spinning disc drives the fluid inside, at second order in its speed, which needs d of about 4 rim^2
 * at any viscosity (the minimum at Mach 0.14 and 0.5 is a third of this: map "fixed disc that spins").
 *
 * Cells between surfaces. Fluid enclosed where a disc overlaps another disc or a side cannot leave through
 * neighbouring cells: it would bear the load in place of the contact, or be accelerated without limit by surfaces in
 * relative motion. In cells of two discs, or beside a side, d is at least 0.5. With 0.05 the fluid leaves within
 * about 10,000 steps (R = 10), and surfaces in relative motion drive it at three times their speed; with 0.5 its
 * speed is at most the speed of the surfaces in the map "fixed disc under a lid". Without this rule the tests
 * contacts/of_discs_that_are_put_into_each_other_... and rest/discs_that_start_in_a_wall_or_in_each_other_... fail. */
#ifndef DELBM_FLUID_WEIGHT_H
#define DELBM_FLUID_WEIGHT_H

#include "model/scene.h"

/* B = min(eps t/((1 - eps) + t (rest + part eps)), max). */
struct weight_law {
  double t, rest, part, max;
};

/* d in the cells of a disc of rim speed `rim`. The forms of the paper are as printed, without damping. */
static inline double weight_damping(enum coupling_form form, double viscosity, double rim)
{
  const double permeability = 0.001, largest = 0.5, steady = 2 * permeability / viscosity;
  if (form != FORM_MIDPOINT) return 0;
  return (steady < largest ? steady : largest) + 4 * rim * rim;
}

/* Minimum of d in cells between surfaces. */
static inline double weight_damping_between(enum coupling_form form)
{
  return form == FORM_MIDPOINT ? 0.5 : 0;
}

static inline struct weight_law weight_law(enum coupling_form form, double viscosity, double damping)
{
  const bool midpoint = form == FORM_MIDPOINT;
  return (struct weight_law){3 * viscosity, midpoint ? 0 : 1, midpoint ? 1 : 0, 1 / (1 + damping)};
}

static inline double weight_of(struct weight_law law, double eps)
{
  const double weight = eps * law.t / ((1 - eps) + law.t * (law.rest + law.part * eps));
  return weight < law.max ? weight : law.max;
}

#endif
