/* Motion: the end of the exchange of each disc (exchange.h), and the disc's new place: x' = x + V', or in sub-steps the one
 * that they reach. */
#ifndef DELBM_SIM_MOTION_H
#define DELBM_SIM_MOTION_H

#include "contact/contacts.h"

/* Called by all threads of a parallel region or outside of one; each disc is one thread's own. Fails when a disc's speed
 * is not finite or above Mach 0.6, or when a free disc has left the box. */
bool stage_motion(const struct contacts *contacts, struct exchange *exchange, struct discs *discs, int64_t step,
                  struct team *team);

#endif
