/* Discs as the calls of the library see them. */
#ifndef DELBM_API_DISCS_H
#define DELBM_API_DISCS_H

#include "api/handle.h"

/* Fails unless first .. first + count - 1 are discs. */
bool api_has_discs(const struct delbm_simulation *simulation, size_t first, size_t count, struct status *status);

/* Fails unless the disc may have this velocity and spin. */
bool api_allows_motion(const struct delbm_simulation *simulation, size_t disc, const double velocity[2], double spin,
                       struct status *status);

/* The disc as it is now. */
struct delbm_disc_state api_disc_state(const struct discs *discs, size_t disc);

#endif
