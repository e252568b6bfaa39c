/* Zero volume flux in closed boxes: a uniform force z, per unit volume, that keeps the mean momentum of the fluid along the
 * axes that walls close at zero.
 *
 * z is constant over intervals of n steps, which begin at multiples of n, so that only one step in n needs a sum over the box
 * and the others may be blocked in time. Let q_k be the mean momentum of a cell at the end of interval k. If momentum responds to the
 * force r-fold (r = 1 in fluid alone, more with light discs), and all other forces add a in a step,
 *   q_k - q_{k-1} = n (r z_k + a),
 * and the force of the next interval is
 *   z_{k+1} = z_k - ((q_k - q_{k-1})/4 + q_k/16)/n - (l_k - l_{k-1}),  z_0 = -l_0.
 * l is the part of a that is known: body forces on the fluid, and weight and mean contact force of free discs, so that a steady load
 * is balanced from the start and z vanishes where discs have come to rest on a side. Of what is left, the first term is a quarter of
 * the force that cancels the acceleration that was seen; the second removes the momentum that there is. The roots of
 *   L^2 - (2 - 5 r/16) L + 1 - r/4 = 0
 * are the factors of an interval: 0.87 in magnitude at r = 1, below 1 for r < 6.4. So the gain is below half of its limit where
 * momentum responds three times as strongly as in fluid alone. A steady a leaves no momentum.
 *
 * n is 16, or less: in small boxes half of the time that sound takes across them, since in a longer interval the pressure of the
 * walls answers the force before its effect is seen; and with heavy loads as many steps as a load takes to accelerate the fluid by 0.01
 * cells/step, since one that begins or ends is opposed an interval late. */
#ifndef DELBM_SIM_ZERO_FLUX_H
#define DELBM_SIM_ZERO_FLUX_H

#include "model/scene.h"

struct zero_flux {
  bool closed[2];          /* axes */
  int interval;            /* n; 0: the scene lets the fluid have a mean momentum */
  int phase;               /* steps of the interval that are done */
  double mean_momentum[2]; /* q at the end of the last interval */
  double load[2];          /* l at the end of the last interval */
};

struct zero_flux zero_flux_create(const struct scene *scene);

/* Sets the force of the first interval, given l. */
void zero_flux_start(struct zero_flux *z, const double load[2], double uniform[2]);

/* Sets the force of the next interval, given q and l at the end of this one. */
void zero_flux_update(struct zero_flux *z, const double mean[2], const double load[2], double uniform[2]);

/* Steps until the force changes, or `steps` if that is less or the scene has none. */
int64_t zero_flux_steps_left(const struct zero_flux *z, int64_t steps);

#endif
