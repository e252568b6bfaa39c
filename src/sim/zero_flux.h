/* Zero volume flux in closed boxes: a uniform force z per unit volume that keeps the mean momentum of the fluid at
 * zero along the axes closed by walls.
 *
 * z is constant over intervals of n steps, which begin at multiples of n, so that only one step in n needs a sum
 * over the box and the others may be blocked in time. q_k: mean momentum of a cell at the end of interval k. If
 * momentum responds to the force r-fold (r = 1 in fluid alone, more with light discs) and other forces add a per
 * step,
 *   q_k - q_{k-1} = n (r z_k + a),
 * and the force of the next interval is
 *   z_{k+1} = z_k - ((q_k - q_{k-1})/4 + q_k/16)/n - (l_k - l_{k-1}),  z_0 = -l_0.
 * l is the known part of a: body force on the fluid, weight and mean contact force of free discs, so that a steady
 * load is balanced from the start and z vanishes once discs are at rest on a side. The first term of the rest
 * cancels a quarter of the acceleration in the last interval, the second removes momentum. The roots of
 *   L^2 - (2 - 5 r/16) L + 1 - r/4 = 0
 * are the amplification factors per interval: 0.87 in magnitude at r = 1, below 1 for r < 64/9. So at r = 3 the gain
 * is below half of its limit. For constant a the momentum converges to zero.
 *
 * n is 16, or less: in small boxes half of the time of sound across the box, since over a longer interval the
 * pressure of the walls responds before the effect of the force is measured; with large loads the time in which the
 * load accelerates the fluid by 0.01 cells/step, since the start or end of a load is balanced one interval late. */
#ifndef DELBM_SIM_ZERO_FLUX_H
#define DELBM_SIM_ZERO_FLUX_H

#include "model/scene.h"

struct zero_flux {
  bool closed[2];          /* axes */
  int interval;            /* n; 0: no zero flux */
  int phase;               /* completed steps of the interval */
  double mean_momentum[2]; /* q at the end of the last interval */
  double load[2];          /* l at the end of the last interval */
};

struct zero_flux zero_flux_create(const struct scene *scene);

/* Sets the force of the first interval from l. */
void zero_flux_start(struct zero_flux *z, const double load[2], double uniform[2]);

/* Sets the force of the next interval from q and l at the end of the last interval. */
void zero_flux_update(struct zero_flux *z, const double mean[2], const double load[2], double uniform[2]);

/* Steps to the end of the interval, at most `steps`; `steps` without zero flux. */
int64_t zero_flux_steps_left(const struct zero_flux *z, int64_t steps);

#endif
