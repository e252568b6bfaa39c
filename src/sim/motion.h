/* Motion: what ends the exchange. Each disc's new velocity from its response and the impulse of its contacts, the forces
 * that made it, and its new place: x' = x + V', or where sub-steps have brought it. */
#ifndef DELBM_SIM_MOTION_H
#define DELBM_SIM_MOTION_H

#include "sim/contacts.h"

/* Called by all threads of a parallel region or outside of one; each disc is one thread's own. Fails when a disc's speed
 * is not finite or above Mach 0.6, or when a free disc has left the box. */
bool stage_motion(const struct contacts *contacts, struct exchange *exchange, struct discs *discs, int64_t step,
                  struct team *team);

#endif
