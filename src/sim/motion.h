/* Motion: exchange_finish of each disc (exchange.h), and the new position: x' = x + V', or the position after the
 * sub-steps. */
#ifndef DELBM_SIM_MOTION_H
#define DELBM_SIM_MOTION_H

#include "contact/contacts.h"

/* Called by all threads of a parallel region or outside of one; a disc is moved by one thread. Fails when the speed
 * of a disc is not finite or above Mach 0.6, or when a free disc has left the box. */
bool stage_motion(const struct contacts *contacts, struct exchange *exchange, struct discs *discs, int64_t step,
                  struct team *team);

#endif
