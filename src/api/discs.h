/* Checks and states of discs, for the calls of the library. */
#ifndef DELBM_API_DISCS_H
#define DELBM_API_DISCS_H

#include "api/handle.h"

/* Fails unless first .. first + count - 1 are discs. */
bool api_has_discs(const struct delbm_simulation *simulation, size_t first, size_t count, struct status *status);

/* Fails if velocity and spin exceed the limits of a case. */
bool api_allows_motion(const struct delbm_simulation *simulation, size_t disc, const double velocity[2], double spin,
                       struct status *status);

/* Present state of the disc. */
struct delbm_disc_state api_disc_state(const struct discs *discs, size_t disc);

#endif
