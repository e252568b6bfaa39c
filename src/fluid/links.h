/* The links of the sides: received population, sent population, source and c (boundary.c). */
#ifndef DELBM_FLUID_LINKS_H
#define DELBM_FLUID_LINKS_H

#include "fluid/populations.h"

struct side_rule;

enum { SIDE_LINKS = 3 }; /* per cell of a side */

/* One link, for all cells of a side. */
struct side_link {
  int i, m;  /* received and sent population */
  int along; /* component of e_i along the side */
  int shift; /* target less source, along the side */
};

struct boundary {
  const struct side *side; /* [SIDE_COUNT] */
  const struct side_rule *rule[SIDE_COUNT];
  int size[2];
  bool ring[2];       /* [axis]: periodic */
  double outlet_rate; /* h */
  struct side_link link[SIDE_COUNT][SIDE_LINKS];
  double *c[SIDE_COUNT][SIDE_LINKS]; /* [side][link][source along the side] */
  void *state[SIDE_COUNT];           /* [side]: of the rule, by cell along the side; NULL: none */
};

/* Number of cells along a side, and the position of cell k. */
static inline int boundary_length(const struct boundary *b, enum side_name side)
{
  return b->size[!side_axis(side)];
}

static inline void boundary_cell(const struct boundary *b, enum side_name side, int k, int cell[2])
{
  const int axis = side_axis(side);
  cell[axis] = side_is_high(side) ? b->size[axis] - 1 : 0;
  cell[!axis] = k;
}

#endif
