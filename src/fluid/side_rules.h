/* The kinds of sides, a row of the table in side_rules.c each (equations: boundary.c). */
#ifndef DELBM_FLUID_SIDE_RULES_H
#define DELBM_FLUID_SIDE_RULES_H

#include "fluid/links.h"

struct side_rule {
  double a; /* at all links but those out of corners, where it is 1 */
  /* Components, normal and tangential, that m has reversed: m is the opposite of i with both (wall, inlet), the mirror
   * image of i with the normal one (slip), i with none (outlet). */
  bool reverses[2];
  /* Components of the fluid's velocity that the side imposes at corners, with the velocity of struct side. */
  bool imposes[2];
  bool joins;   /* the sources are cells of the other side of the axis (periodic) */
  size_t state; /* bytes of each cell's state, zero at the start; 0: none */

  /* Sets c of cells k0 .. k1 - 1, from velocity or state. NULL: c is 0. */
  void (*fill)(struct boundary *boundary, enum side_name side, int k0, int k1);
  /* `step` advances the states of cells k0 .. k1 - 1, which have completed a step; `reset` starts all states from
   * populations of parity 0 before their collision. A call of fill is next. NULL: c is constant. */
  void (*step)(struct boundary *boundary, const struct populations *populations, enum side_name side, int k0, int k1);
  void (*reset)(struct boundary *boundary, const struct populations *populations, enum side_name side);
  /* c/w_i of the link out of a corner with a component that neither side imposes. */
  double (*corner)(const struct boundary *boundary, enum side_name side, int k);
};

const struct side_rule *side_rule_of(enum side_type type);

#endif
