/* State of a contact between two sub-steps: the energy E stored in its normal spring, and the springs of friction.
 *
 * A spring whose force is a smooth function of the overlap returns its stored energy, over sub-steps as many as its
 * stiffness needs. A spring whose force jumps, as with area by cells, or over too few sub-steps, might return more. There
 * E is counted and limits the impulse J.
 *
 * Energy. An impulse does the work J v, v the mean of the approach speeds before and after the impulse, other forces
 * included; the damper dissipates D, with S the part of J without damping:
 *   E' = max(0, E + J v - D),  D = max(0, (J - S) v).
 * The approach speed after an impulse is known in the next sub-step: the state contains J, S and the approach speed
 * before.
 *
 * Limit. With the compliance c (separation speed per impulse) and w, the mean approach speed over the sub-step
 * without J, v = w - c J/2, and J v >= -E is true for
 *   J <= (w + sqrt((w^2 + 2 c E)/(1 + s^2)))/c,
 * with s = c J_d, J_d the damper's impulse per approach speed. s = 0 is the bound itself. 1 + s^2 is empirical: at s > 1
 * the damper alone would stop the pair within the sub-step, and the separation speed falls as 1/s. */
#ifndef DELBM_CONTACT_STATE_H
#define DELBM_CONTACT_STATE_H

#include "base/store.h"

#include <math.h>

struct contact_state {
  double stored;         /* E */
  double impulse;        /* J of the last sub-step */
  double spring_impulse; /* S */
  double approach_speed; /* before J */
  /* friction (contact_kernel.c) */
  double shear, shear_stiffness;   /* force of the tangential spring, and its stiffness */
  double moment, moment_stiffness; /* torque of the rolling spring, and its stiffness */
};

/* E after the work of the last impulse; `approach_speed` is after the impulse. */
static inline double state_stored(double stored, double impulse, double spring_impulse, double speed_before,
                                  double approach_speed)
{
  const double mean = 0.5 * (speed_before + approach_speed), work = (impulse - spring_impulse) * mean;
  const double left = stored + impulse * mean - (work > 0 ? work : 0);
  return left > 0 ? left : 0;
}

/* Upper limit of J; `mean_speed` is w, `damper` J_d. */
static inline double state_max_impulse(double stored, double mean_speed, double compliance, double damper)
{
  const double s = damper * compliance;
  const double sum = mean_speed + sqrt((mean_speed * mean_speed + 2 * compliance * stored) / (1 + s * s));
  return (sum > 0 ? sum : 0) / compliance;
}

/* b >= contact_sides: a contact with the side b - contact_sides. */
static const uint32_t contact_sides = UINT32_MAX - 3;

static inline bool contact_is_with_side(uint32_t b)
{
  return b >= contact_sides;
}

/* States of active contacts between two steps, in the order of the contact table: pairs, then sides, by (a, b). */
struct contact_states {
  struct saved_state *list;
  size_t count, capacity;
};

void states_destroy(struct contact_states *states);

/* Saves or restores the states; on restoring fails for states that are impossible with `discs` discs. */
bool states_store(struct contact_states *states, size_t discs, struct store *store, struct status *status);

/* Reserves memory for `count` states. */
bool states_reserve(struct contact_states *states, size_t count, struct status *status);

void states_clear(struct contact_states *states);
void states_add(struct contact_states *states, uint32_t a, uint32_t b, const struct contact_state *state);

/* State of contact (a, b), or NULL. *at starts at 0 and is advanced; queries must be in list order. */
const struct contact_state *states_next(const struct contact_states *states, size_t *at, uint32_t a, uint32_t b);

#endif
