/* Painting of a band of rows (occupation.c), and its scratch memory. Each thread has one draft for all bands that it
 * paints, so that the draft stays in cache. */
#ifndef DELBM_SOLID_BAND_H
#define DELBM_SOLID_BAND_H

#include "solid/solid_kernel.h"
#include "solid/tables.h"

struct run_draft {
  size_t cell; /* index of the first cell in eps[] */
  size_t slot; /* index in run_index[] (tables.h) */
};

struct band_draft {
  struct run_draft *runs; /* [run of the band] */
  double *eps;            /* occupation fractions, disc by disc */
  size_t run_capacity, eps_capacity;
};

/* Row `at` of a periodic box of n rows, -n <= at < 2 n. */
static inline int band_wrap(int at, int n)
{
  return at < 0 ? at + n : at >= n ? at - n : at;
}

/* Builds the runs of the band, and the owner weights of their cells as if each cell had one owner. Fails if memory runs
 * out. */
bool band_paint(struct occupation *occupation, int index, const struct discs *discs, struct band_draft *draft,
                struct status *status);

/* Corrects the owner weights of cells with several owners. */
void band_share(struct occupation *occupation, int index, const struct band_draft *draft);

#endif
