/* Cover: what the discs do to a row of cells, painted into row buffers just before the row is swept (populations'
 * precision). One buffer each for B and the two components of the sum over owners of w_p B v_p: a row of three, in
 * cache, instead of three planes in memory. Outside of runs they are zero, before and after. */
#ifndef DELBM_COUPLING_COVER_H
#define DELBM_COUPLING_COVER_H

#include "coupling/exchange.h"

/* Row buffers of one thread. */
struct cover {
  struct row_cover row;
  const struct sweep_kernel *kernel;
  size_t value_size;
};

bool cover_create(struct cover *cover, int nx, const struct sweep_kernel *kernel, struct status *status);
void cover_destroy(struct cover *cover);

/* Adds the given runs, at least one; cover_clear with the same runs makes the buffers zero again. */
void cover_paint(struct cover *cover, const struct run *runs, size_t count, const double *share,
                 const struct surface_velocity *surface);
void cover_clear(struct cover *cover, const struct run *runs, size_t count);

#endif
