/* State of a contact: the energy E that its spring has stored.
 *
 * A spring whose force follows from the overlap alone returns what it has stored. One whose force jumps, as areas by cells do from
 * step to step, or whose sub-steps are too few, might return more. So the energy is counted and limits the impulses J of the contact.
 *
 * Energy. An impulse does the work J v, v the mean of the speeds of approach before and after it, whatever else acted meanwhile; the
 * damper takes D of it, S being the part of J without damping:
 *   E' = max(0, E + J v - D),  D = max(0, (J - S) v).
 * The speed after an impulse is known in the next sub-step, so the state keeps J, S and the speed before.
 *
 * Limit. Let c be the compliance (speed of parting per impulse) and w the mean speed of approach over the sub-step without J. Then
 * v = w - c J/2, and J v >= -E holds for
 *   J <= (w + sqrt((w^2 + 2 c E)/(1 + s^2)))/c,
 * where s = c J_d, J_d the damper's impulse per speed of approach. s = 0 is the bound itself; for s > 1 the damper alone would stop
 * the pair within the sub-step, and a pair that parts is to keep the less speed. */
#ifndef DELBM_CONTACT_STATE_H
#define DELBM_CONTACT_STATE_H

#include "base/store.h"

#include <math.h>

struct contact_state {
  double stored;         /* E */
  double impulse;        /* J, of the last sub-step */
  double spring;         /* S */
  double approach_speed; /* before it */
};

/* Counts the work of the last impulse, now that the speed of approach after it is known. */
static inline void state_count_work(struct contact_state *state, double approach_speed)
{
  const double mean = 0.5 * (state->approach_speed + approach_speed);
  const double damped = fmax(0, (state->impulse - state->spring) * mean);
  state->stored = fmax(0, state->stored + state->impulse * mean - damped);
  state->impulse = state->spring = 0;
}

/* The largest impulse allowed; `mean_speed` is w, `damper` J_d. */
static inline double state_max_impulse(const struct contact_state *state, double mean_speed, double compliance,
                                       double damper)
{
  const double stops = damper * compliance;
  const double speed = sqrt((mean_speed * mean_speed + 2 * compliance * state->stored) / (1 + stops * stops));
  return fmax(0, mean_speed + speed) / compliance;
}

/* From this b on, a contact is with a side: with side b - contact_sides. */
static const uint32_t contact_sides = UINT32_MAX - 3;

/* The states of active contacts between two steps, in the order of the list of contacts: pairs, then sides, each by a, then b. */
struct contact_states {
  struct saved_state *list;
  size_t count, capacity;
};

void states_destroy(struct contact_states *states);

/* Saves or restores the states; refuses what cannot be the states of so many discs. */
bool states_store(struct contact_states *states, size_t discs, struct store *store, struct status *status);

/* Room for so many states. */
bool states_reserve(struct contact_states *states, size_t count, struct status *status);

void states_clear(struct contact_states *states);
void states_add(struct contact_states *states, uint32_t a, uint32_t b, const struct contact_state *state);

/* State of contact (a, b), or NULL. Advances *at, which begins at 0; queries must come in list order. */
const struct contact_state *states_next(const struct contact_states *states, size_t *at, uint32_t a, uint32_t b);

#endif
