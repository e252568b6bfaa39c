/* Vorticity by central differences, one-sided at sides that are not periodic. */
#ifndef DELBM_FLUID_VORTICITY_H
#define DELBM_FLUID_VORTICITY_H

#include <stdbool.h>

/* The two indices, of `count` along an axis, for the difference quotient at an index, and their distance. */
struct stencil {
  int low, high, distance;
};

static inline struct stencil stencil_at(int place, int count, bool periodic)
{
  if (periodic) return (struct stencil){place > 0 ? place - 1 : count - 1, place < count - 1 ? place + 1 : 0, 2};
  const int low = place > 0 ? place - 1 : place, high = place < count - 1 ? place + 1 : place;
  return (struct stencil){low, high, high - low};
}

static inline double stencil_slope(const struct stencil *stencil, double low, double high)
{
  return stencil->distance > 0 ? (high - low) / stencil->distance : 0;
}

#endif
