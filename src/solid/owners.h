/* What is known of the owners of a cell, those discs that cover a part of it: how much they give, and how fast their
 * surfaces pass each other and the sides that the cell lies next to. Together these give the law of its weight. */
#ifndef DELBM_SOLID_OWNERS_H
#define DELBM_SOLID_OWNERS_H

#include "solid/occupation.h"

#include <math.h>

struct owners {
  int count;
  double give;
  double low[2], high[2]; /* of their velocities at the cell */
  double side_slip;       /* the fastest past a side; negative: next to none */
};

static inline struct owners owners_none(void)
{
  return (struct owners){.low = {INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY}, .side_slip = -1};
}

/* Adds the disc whose run covers cell (x, y). */
static inline void owners_add(struct owners *owners, const struct occupation *o, const struct run *run, int x, int y)
{
  const uint32_t i = run->disc;
  const double u[2] = {o->vx[i] - o->omega[i] * run->ry, o->vy[i] + o->omega[i] * (run->rx + (x - run->x))};
  const bool beside[SIDE_COUNT] = {x == 0, x == o->size[0] - 1, y == 0, y == o->size[1] - 1};
  owners->count++;
  owners->give = fmax(owners->give, o->give[i]);
  for (int axis = 0; axis < 2; axis++) {
    owners->low[axis] = fmin(owners->low[axis], u[axis]);
    owners->high[axis] = fmax(owners->high[axis], u[axis]);
  }
  for (enum side_name side = 0; side < SIDE_COUNT; side++) {
    if (!beside[side] || o->periodic[side >= SIDE_BOTTOM]) continue;
    const double *v = o->side_velocity[side];
    owners->side_slip = fmax(owners->side_slip, hypot(u[0] - v[0], u[1] - v[1]));
  }
}

static inline struct weight_law owners_law(const struct owners *owners, const struct occupation *o)
{
  double give = owners->give;
  if (owners->count > 1 || owners->side_slip >= 0) {
    const double apart = hypot(owners->high[0] - owners->low[0], owners->high[1] - owners->low[1]);
    give = fmax(give, weight_give_between(o->form, fmax(apart, owners->side_slip)));
  }
  return weight_law(o->form, o->viscosity, give);
}

#endif
