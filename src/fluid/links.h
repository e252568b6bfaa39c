/* The links of the sides: which population is received of which, from where, and with which c (boundary.h). */
#ifndef DELBM_FLUID_LINKS_H
#define DELBM_FLUID_LINKS_H

#include "fluid/populations.h"

struct side_rule;

enum { SIDE_LINKS = 3 }; /* populations that enter through a side, of each of its cells */

/* One of them, for all cells of a side. */
struct side_link {
  int i, m;  /* what is received of what is sent */
  int along; /* component of e_i along the side */
  int shift; /* from source to target, along the side */
};

struct boundary {
  const struct side *side; /* [SIDE_COUNT] */
  const struct side_rule *rule[SIDE_COUNT];
  int size[2];
  bool ring[2]; /* whether the sides of each axis are joined */
  double hold;  /* h, of outlets */
  struct side_link link[SIDE_COUNT][SIDE_LINKS];
  double *c[SIDE_COUNT][SIDE_LINKS]; /* of each link, by the cell along the side that is its source */
  void *state[SIDE_COUNT];           /* of the rule, by cell along the side; NULL: none */
};

/* Cells along a side, and cell k of them. */
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
