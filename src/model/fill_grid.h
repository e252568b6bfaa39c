/* The square grid of particles.fill. */
#ifndef DELBM_MODEL_FILL_GRID_H
#define DELBM_MODEL_FILL_GRID_H

#include <math.h>

/* Whole grid cells of a region (x0, y0, x1, y1) along an axis; not positive where there is none. */
static inline double fill_grid_cells(const double region[4], double spacing, int axis)
{
  return floor((region[axis + 2] - region[axis]) / spacing);
}

#endif
