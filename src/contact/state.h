/* State of a contact: the energy E stored in its spring.
 *
 * A spring whose force is a smooth function of the overlap returns its stored energy. A spring whose force jumps, as
 * with area by cells, or with too few sub-steps, might return more. So E is counted and limits the impulse J.
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
};

/* Adds the work of the last impulse to E; `approach_speed` is after the impulse. */
static inline void state_count_work(struct contact_state *state, double approach_speed)
{
  const double mean = 0.5 * (state->approach_speed + approach_speed);
  const double damped = fmax(0, (state->impulse - state->spring_impulse) * mean);
  state->stored = fmax(0, state->stored + state->impulse * mean - damped);
  state->impulse = state->spring_impulse = 0;
}

/* Upper limit of J; `mean_speed` is w, `damper` J_d. */
static inline double state_max_impulse(const struct contact_state *state, double mean_speed, double compliance,
                                       double damper)
{
  const double s = damper * compliance;
  const double speed = sqrt((mean_speed * mean_speed + 2 * compliance * state->stored) / (1 + s * s));
  return fmax(0, mean_speed + speed) / compliance;
}

/* b >= contact_sides: a contact with the side b - contact_sides. */
static const uint32_t contact_sides = UINT32_MAX - 3;

/* States of active contacts between two steps, in the order of the contact list: pairs, then sides, by (a, b). */
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
