/* Cover: what the discs do to a row of cells, painted into row buffers just before the row is swept (populations'
 * precision). One buffer each for B and the two components of the sum over owners of w_p B v_p: a row of three, in
 * cache, instead of three planes in memory. */
#ifndef DELBM_COUPLING_COVER_H
#define DELBM_COUPLING_COVER_H

#include "coupling/exchange.h"

/* Row buffers of one thread. */
struct cover {
  struct row_cover row;
};

bool cover_create(struct cover *cover, int nx, const struct sweep_kernel *kernel, struct status *status);
void cover_destroy(struct cover *cover);

#endif
