/* The kinds of sides, a row of a table each: what a new one needs (boundary.h has the contract). */
#ifndef DELBM_FLUID_SIDE_RULES_H
#define DELBM_FLUID_SIDE_RULES_H

#include "fluid/links.h"

struct side_rule {
  double a;
  /* Which components of the fluid's velocity the side imposes, the normal one and the one along it. m is the population
   * whose velocity has these reversed: the opposite of i with both (wall, inlet), its mirror image with the first alone, i
   * itself with neither (outlet). At corners, where an imposed component is that of struct side. */
  bool imposes[2];
  bool joins;   /* the sources are the cells of the other side of the axis (periodic) */
  size_t state; /* bytes of each cell's state, zero at the start; 0: none */

  /* Sets c of cells k0 .. k1 - 1, from the velocity or from their state. NULL: c is 0. */
  void (*fill)(struct boundary *boundary, enum side_name side, int k0, int k1);
  /* The step of the states of cells k0 .. k1 - 1, which have just sent, and `reset` their start with populations (of parity 0)
   * that have been written and not yet collided; fill comes after either. NULL: c is constant. */
  void (*step)(struct boundary *boundary, const struct populations *populations, enum side_name side, int k0, int k1);
  void (*reset)(struct boundary *boundary, const struct populations *populations, enum side_name side);
  /* c/w_i at the link out of a corner, where neither side imposes one of its components. */
  double (*corner)(const struct boundary *boundary, enum side_name side, int k);
};

const struct side_rule *side_rule_of(enum side_type type);

#endif
