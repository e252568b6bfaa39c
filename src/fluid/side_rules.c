#include "fluid/side_rules.h"

#include <assert.h>

/* Momentum of a wall or of inflow at the reference density. */
static void fill_momentum(struct boundary *b, enum side_name side, int k0, int k1)
{
  for (int j = 0; j < SIDE_LINKS; j++)
    for (int k = k0; k < k1; k++) b->c[side][j][k] = d2q9_wall_momentum(b->link[side][j].i, b->side[side].velocity);
}

/* State of the ghost cell of an outlet (boundary.c). */
struct outlet_cell {
  double drift; /* d */
  double cut;   /* density of the source less density of the ghost cell */
  double last;  /* 3 (e - j) of the source after the last step */
};

struct edge_moments {
  double excess, outwards; /* over the reference density; momentum along the outward normal */
};

/* Moments of cell k, from the populations that it has sent or, with `coming`, before its next collision. */
static struct edge_moments edge_moments(const struct boundary *b, const struct populations *p, enum side_name side,
                                        int k, bool coming)
{
  const int axis = side_axis(side), inwards = side_is_high(side) ? -1 : 1;
  struct edge_moments m = {0};
  int cell[2];
  boundary_cell(b, side, k, cell);
  for (int i = 0; i < Q; i++) {
    const int e[2] = {d2q9_ex[i], d2q9_ey[i]};
    const size_t slot = coming ? populations_source(p, i, cell[0], cell[1]) : populations_sent(p, i, cell[0], cell[1]);
    const double g = populations_get(p, slot);
    m.excess += g;
    m.outwards -= e[axis] * inwards * g;
  }
  return m;
}

static void fill_cut(struct boundary *b, enum side_name side, int k0, int k1)
{
  const struct outlet_cell *ghost = b->state[side];
  for (int j = 0; j < SIDE_LINKS; j++)
    for (int k = k0; k < k1; k++) b->c[side][j][k] = -d2q9_weight[b->link[side][j].i] * ghost[k].cut;
}

static double corner_cut(const struct boundary *b, enum side_name side, int k)
{
  const struct outlet_cell *ghost = b->state[side];
  return -ghost[k].cut;
}

static void reset_outlet(struct boundary *b, const struct populations *p, enum side_name side)
{
  struct outlet_cell *ghost = b->state[side];
  for (int k = 0; k < boundary_length(b, side); k++) {
    const struct edge_moments m = edge_moments(b, p, side, k, true);
    ghost[k] = (struct outlet_cell){.last = 3 * (m.excess - m.outwards)};
  }
}

static void step_outlet(struct boundary *b, const struct populations *p, enum side_name side, int k0, int k1)
{
  const double h = b->outlet_rate;
  for (int k = k0; k < k1; k++) {
    struct outlet_cell *ghost = (struct outlet_cell *)b->state[side] + k;
    const struct edge_moments m = edge_moments(b, p, side, k, false);
    const double now = 3 * (m.excess - m.outwards);
    ghost->drift += h / 6 * (now - ghost->last + ghost->cut - ghost->drift);
    ghost->cut = h * (m.excess - ghost->cut / 2) + ghost->drift;
    ghost->last = now;
  }
}

static const struct side_rule rules[] = {
    [SIDE_WALL] = {.a = 1, .reverses = {true, true}, .imposes = {true, true}, .fill = fill_momentum},
    [SIDE_PERIODIC] = {.a = 1, .joins = true},
    [SIDE_INLET] = {.a = 1, .reverses = {true, true}, .imposes = {true, true}, .fill = fill_momentum},
    [SIDE_OUTLET] = {.a = 1,
                     .state = sizeof(struct outlet_cell),
                     .fill = fill_cut,
                     .step = step_outlet,
                     .reset = reset_outlet,
                     .corner = corner_cut},
    [SIDE_SLIP] = {.a = 1, .reverses = {true, false}, .imposes = {true, false}},
};

const struct side_rule *side_rule_of(enum side_type type)
{
  assert((size_t)type < sizeof rules / sizeof rules[0]);
  return &rules[type];
}
