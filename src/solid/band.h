/* A band of rows while it is painted (occupation.h): what is needed of it only then, and its two passes. Each thread has a
 * draft, which the bands that it paints use one after another, so that it stays in cache. */
#ifndef DELBM_SOLID_BAND_H
#define DELBM_SOLID_BAND_H

#include "solid/occupation.h"
#include "solid/solid_kernel.h"

/* What a run is besides its cells: those that make discs candidates, the run's own widened by the reach; where its eps
 * begin; and where place[] keeps its number in the band. */
struct candidate {
  int32_t reach_first, reach_end;
  size_t cell, place;
};

struct band_draft {
  struct candidate *candidates; /* of each run of the band */
  double *eps;                  /* of all cells, disc by disc */
  size_t candidate_capacity, eps_capacity;
};

/* Row `at` of `n`, from up to n rows beyond either side of a periodic box. */
static inline int band_wrap(int at, int n)
{
  return at < 0 ? at + n : at >= n ? at - n : at;
}

/* The runs of the band's rows, and the shares of their cells as if each had one owner. Fails if memory runs out. */
bool band_paint(struct occupation *occupation, int index, const struct discs *discs, struct band_draft *draft,
                struct status *status);

/* The shares of cells with several owners, and the pairs that meet in the band. Fails if memory runs out. */
bool band_share(struct occupation *occupation, int index, const struct discs *discs, const struct band_draft *draft,
                struct status *status);

#endif
