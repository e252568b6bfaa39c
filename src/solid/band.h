/* A band of rows while it is painted (occupation.h): what is needed of it only then, and its two passes. Each thread has a
 * draft, which the bands that it paints use one after another, so that it stays in cache. */
#ifndef DELBM_SOLID_BAND_H
#define DELBM_SOLID_BAND_H

#include "solid/occupation.h"
#include "solid/solid_kernel.h"

/* Of a run of the band: the index of its first fraction, and its index in run_index[]. */
struct run_draft {
  size_t cell, slot;
};

struct band_draft {
  struct run_draft *runs; /* of each run of the band */
  double *eps;            /* of all cells, disc by disc */
  size_t run_capacity, eps_capacity;
};

/* Row `at` of `n`, from up to n rows beyond either side of a periodic box. */
static inline int band_wrap(int at, int n)
{
  return at < 0 ? at + n : at >= n ? at - n : at;
}

/* The runs of the band's rows, and the shares of their cells as if each had one owner. Fails if memory runs out. */
bool band_paint(struct occupation *occupation, int index, const struct discs *discs, struct band_draft *draft,
                struct status *status);

/* The shares of cells with several owners. */
void band_share(struct occupation *occupation, int index, const struct band_draft *draft);

#endif
