/* The account of a contact: the energy that its spring has taken from the motion of its discs and not yet given back. A
 * spring whose force follows from the overlap alone keeps it by itself; one whose area jumps, as that by cells does from
 * step to step, or whose sub-steps are too few, is held to it. So no contact gives back more than it took.
 *
 * The work of an impulse is that over the mean of the speeds before and after, whatever else acted meanwhile: that of one
 * sub-step is known in the next. */
#ifndef DELBM_CONTACT_ACCOUNT_H
#define DELBM_CONTACT_ACCOUNT_H

#include <math.h>
#include <stdbool.h>

struct contact_account {
  double stored;
  double impulse; /* of the last sub-step */
  double spring;  /* its part without damping */
  double closing; /* speed of approach before it */
};

static inline bool account_is_sane(const struct contact_account *account)
{
  return account->stored >= 0 && account->impulse >= 0 && account->spring >= 0 && isfinite(account->stored) &&
         isfinite(account->impulse) && isfinite(account->spring) && isfinite(account->closing);
}

/* Enters the work of the last sub-step, at whose end the discs close at this speed. */
static inline void account_settle(struct contact_account *account, double closing)
{
  const double mean = 0.5 * (account->closing + closing);
  const double damped = fmax(0, (account->impulse - account->spring) * mean);
  account->stored = fmax(0, account->stored + account->impulse * mean - damped);
  account->impulse = account->spring = 0;
}

/* The largest impulse that gives back no more than is stored. `mean`: the mean speed of approach over the sub-step if
 * there were none; `inverse_mass` of the relative motion; `damper`: impulse per speed of approach. One that would stop the
 * discs within less than the sub-step leaves them the less of their speed. */
static inline double account_most(const struct contact_account *account, double mean, double inverse_mass,
                                  double damper)
{
  const double stops = damper * inverse_mass;
  const double speed = sqrt((mean * mean + 2 * inverse_mass * account->stored) / (1 + stops * stops));
  return fmax(0, mean + speed) / inverse_mass;
}

#endif
