/* The sides of the box, as rules for links.
 *
 * A link is a cell at the edge and a population i that enters the cell from outside. Once a cell has completed a
 * step, each rule computes, from a population sent by the cell, the population that a cell of the edge receives in
 * the next step:
 *   received_i(target) = a sent_m(source) + c[k],   k: number of the source along the side.
 *
 *   wall, inlet  half-way bounce-back: target = source, m the opposite of i, c = 6 w_i e_i.u, the momentum of a wall or
 *                inflow of velocity u at the reference density.
 *   periodic     source: the cell at the other end of the row, m = i, c = 0. In y rows wrap by address alone
 *                (populations.h).
 *   slip         mirror image: target one cell along the side from the source, in the direction of e_i; m is i with its
 *                normal component reversed, c = 0. Normal velocity and shear stress are zero at the side.
 *   outlet       zero gradient: a ghost cell beside the source sends the source's populations, m = i, c = -w_i cut.
 *                The density of the ghost cell is below the density of the source by
 *                  cut = h e + d,   (6/h) dd/dt = 3 d(e_s - j)/dt + cut - d,
 *                e_s the excess of the source over the reference density, e = e_s - cut/2 at the face between both
 *                cells, j the momentum of the source along the outward normal. Transmitted sound changes 3 (e_s - j) by -cut a step; the other changes are pressure
 *                gradient and friction of the flow, estimated by d. The reflection factor of sound is
 *                -((2 - sqrt(3)) s + k)/(s + k), k = h/(3 + sqrt(3)), s = i times the angular frequency, for any d;
 *                the excess of steady flow, with cut = h e alone its pressure gradient over h, decays within some
 *                multiples of 6/h steps.
 *
 * a = 1 in all rules. If m has the component of i along the side, the target is one cell farther along this
 * component than the source. side_rules.c contains the table of the rules.
 *
 * Corners. The diagonal link out of the corner of two sides that are not periodic uses for each component of the
 * velocity the side normal to this component: an inlet imposes its velocity, a wall or slip side 0. An outlet
 * imposes none; the component is then imposed by the other side. m has the imposed components reversed, and c is the
 * momentum at the imposed velocity. So the inflow of inlets is exactly velocity times length, a wall that moves into
 * a corner pushes no fluid through the other wall, and a uniform stream remains uniform. At the corner of two
 * outlets no component is imposed, and the ghost cell has the mean cut of its neighbours. A slip side imposes only
 * the normal component: at its corner with an outlet it reflects the populations of the outlet's ghost cell.
 *
 * Storage. c[side][j] is an array over the cells of the side for each of the three links j of a cell; state[side] is
 * an array over the same cells, of the rule's state (an outlet: d, cut and the last 3 (e_s - j)).
 *
 * Races. Every slot that a rule writes belongs to its link, or to the ghost cell, alone (populations.h), and a link
 * depends only on its source: rows may be updated in any order that streaming allows, by any thread. */
#include "fluid/boundary.h"

#include "base/memory.h"
#include "fluid/side_rules.h"

#include <math.h>
#include <stdlib.h>

/* Populations i that enter through a side. */
static const int inward[SIDE_COUNT][SIDE_LINKS] = {
    [SIDE_LEFT] = {1, 5, 8}, [SIDE_RIGHT] = {3, 6, 7}, [SIDE_BOTTOM] = {2, 5, 6}, [SIDE_TOP] = {4, 7, 8}};

/* The population whose velocity is e_i with the selected components reversed. */
static int reversed(int i, const bool components[2])
{
  const int ex = components[0] ? -d2q9_ex[i] : d2q9_ex[i], ey = components[1] ? -d2q9_ey[i] : d2q9_ey[i];
  int m = 0;
  while (d2q9_ex[m] != ex || d2q9_ey[m] != ey) m++;
  return m;
}

static struct side_link link_of(const struct side_rule *rule, enum side_name side, int j)
{
  const int axis = side_axis(side), i = inward[side][j], e[2] = {d2q9_ex[i], d2q9_ey[i]};
  const bool components[2] = {rule->reverses[axis], rule->reverses[!axis]};
  return (struct side_link){
      .i = i, .m = reversed(i, components), .along = e[!axis], .shift = rule->reverses[1] ? 0 : e[!axis]};
}

static bool create_side(struct boundary *b, enum side_name side, struct status *status)
{
  const struct side_rule *rule = b->rule[side];
  const int n = boundary_length(b, side);
  for (int j = 0; j < SIDE_LINKS; j++) {
    b->link[side][j] = link_of(rule, side, j);
    b->c[side][j] = memory_allocate((size_t)n, sizeof *b->c[side][j], "the links of a side", status);
    if (!b->c[side][j]) return false;
  }
  if (rule->state > 0 && !(b->state[side] = memory_allocate((size_t)n, rule->state, "the cells of a side", status)))
    return false;
  if (rule->fill) rule->fill(b, side, 0, n);
  return true;
}

bool boundary_create(struct boundary *b, const struct side side[SIDE_COUNT], int nx, int ny, struct status *status)
{
  *b = (struct boundary){.side = side, .size = {nx, ny}, .outlet_rate = boundary_outlet_rate(nx, ny)};
  for (enum side_name name = 0; name < SIDE_COUNT; name++) {
    b->rule[name] = side_rule_of(side[name].type);
    b->ring[side_axis(name)] = b->rule[name]->joins;
    if (create_side(b, name, status)) continue;
    boundary_destroy(b);
    return false;
  }
  return true;
}

void boundary_destroy(struct boundary *b)
{
  for (enum side_name side = 0; side < SIDE_COUNT; side++) {
    for (int j = 0; j < SIDE_LINKS; j++) free(b->c[side][j]);
    free(b->state[side]);
  }
  *b = (struct boundary){0};
}

bool boundary_store(struct boundary *b, struct store *store, struct status *status)
{
  for (enum side_name side = 0; side < SIDE_COUNT; side++) {
    const struct side_rule *rule = b->rule[side];
    const int n = boundary_length(b, side);
    if (rule->state == 0) continue;
    if (!store_bytes(store, b->state[side], (size_t)n * rule->state, status)) return false;
    if (rule->fill) rule->fill(b, side, 0, n);
  }
  return true;
}

void boundary_reset(struct boundary *b, const struct populations *p)
{
  for (enum side_name side = 0; side < SIDE_COUNT; side++) {
    const struct side_rule *rule = b->rule[side];
    if (rule->reset) rule->reset(b, p, side);
    if (rule->reset && rule->fill) rule->fill(b, side, 0, boundary_length(b, side));
  }
}

/* slot[to] = a slot[from] + c */
static inline void move_one(struct populations *p, size_t to, size_t from, double a, double c)
{
  if (p->precision == PRECISION_DOUBLE) {
    double *slot = p->block;
    slot[to] = a * slot[from] + c;
  } else {
    float *slot = p->block;
    slot[to] = (float)a * slot[from] + (float)c;
  }
}

/* slot[to + k] = a slot[from + k] + c[k] for k < n. */
static void move(struct populations *p, size_t to, size_t from, int n, double a, const double *c)
{
  if (p->precision == PRECISION_DOUBLE) {
    double *slot = p->block;
    for (int k = 0; k < n; k++) slot[to + (size_t)k] = a * slot[from + (size_t)k] + c[k];
  } else {
    float *slot = p->block;
    for (int k = 0; k < n; k++) slot[to + (size_t)k] = (float)a * slot[from + (size_t)k] + (float)c[k];
  }
}

static enum side_name opposite(enum side_name side)
{
  return side_is_high(side) ? side - 1 : side + 1;
}

/* Link j of cells target .. target + n - 1 of a side, from cells source .. source + n - 1. */
static void transfer(struct boundary *b, struct populations *p, enum side_name side, int j, int source, int target,
                     int n)
{
  const struct side_link *link = &b->link[side][j];
  int from[2], to[2];
  if (n <= 0) return;
  boundary_cell(b, b->rule[side]->joins ? opposite(side) : side, source, from);
  boundary_cell(b, side, target, to);
  move(p, populations_received(p, link->i, to[0], to[1]), populations_sent(p, link->m, from[0], from[1]), n,
       b->rule[side]->a, b->c[side][j] + source);
}

/* Advances the states of cells k0 .. k1 - 1, which have completed a step, and sets their c. */
static void advance_states(struct boundary *b, const struct populations *p, enum side_name side, int k0, int k1)
{
  const struct side_rule *rule = b->rule[side];
  if (!rule->step) return;
  rule->step(b, p, side, k0, k1);
  if (rule->fill) rule->fill(b, side, k0, k1);
}

/* The links of one side with sources k0 .. k1 - 1, corners excluded. `step`: the sources have completed a step, so
 * the states advance. */
static void side_links(struct boundary *b, struct populations *p, enum side_name side, int k0, int k1, bool step)
{
  const bool ring = b->ring[!side_axis(side)];
  const int n = boundary_length(b, side);
  if (step) advance_states(b, p, side, k0, k1);
  for (int j = 0; j < SIDE_LINKS; j++) {
    const int along = b->link[side][j].along, shift = b->link[side][j].shift;
    const int low = (!ring && along > 0) - shift, high = n - (!ring && along < 0) - shift; /* sources without corners */
    const int first = k0 > low ? k0 : low, end = k1 < high ? k1 : high;
    transfer(b, p, side, j, first, first + shift, end - first);
    if (ring && shift < 0 && k0 == 0) transfer(b, p, side, j, 0, n - 1, 1);
    if (ring && shift > 0 && k1 == n) transfer(b, p, side, j, n - 1, 0, 1);
  }
}

/* side_links for one cell k that is not at an end of its side: all links, without bounds, as at both ends of every row,
 * where bounds would cost as much as the links. Where c is 0, it is not read: the arrays leave the cache in each step. */
static void cell_links(struct boundary *b, struct populations *p, enum side_name side, int k, bool step)
{
  const struct side_rule *rule = b->rule[side];
  const int along = !side_axis(side);
  int from[2], to[2];
  if (step) advance_states(b, p, side, k, k + 1);
  boundary_cell(b, rule->joins ? opposite(side) : side, k, from);
  boundary_cell(b, side, k, to);
  for (int j = 0; j < SIDE_LINKS; j++) {
    const struct side_link *link = &b->link[side][j];
    to[along] = k + link->shift;
    move_one(p, populations_received(p, link->i, to[0], to[1]), populations_sent(p, link->m, from[0], from[1]), rule->a,
             rule->fill ? b->c[side][j][k] : 0);
  }
}

/* The link out of the corner of two sides. */
static void corner_link(struct boundary *b, struct populations *p, enum side_name x_side, enum side_name y_side)
{
  static const int diagonal[2][2] = {{5, 8}, {6, 7}};
  const enum side_name side[2] = {x_side, y_side};
  const int i = diagonal[x_side == SIDE_RIGHT][y_side == SIDE_TOP];
  const int cell[2] = {x_side == SIDE_LEFT ? 0 : p->nx - 1, y_side == SIDE_BOTTOM ? 0 : p->ny - 1};
  bool imposed[2];
  double velocity[2] = {0, 0}, excess = 0;
  int open = 0;
  for (int d = 0; d < 2; d++) {
    const struct side_rule *own = b->rule[side[d]], *other = b->rule[side[!d]];
    imposed[d] = own->imposes[0] || other->imposes[1];
    if (imposed[d])
      velocity[d] = b->side[own->imposes[0] ? side[d] : side[!d]].velocity[d];
    else if (own->corner)
      excess += own->corner(b, side[d], cell[!d]), open++;
  }
  const double c = d2q9_wall_momentum(i, velocity) + (open > 0 ? d2q9_weight[i] * excess / open : 0);
  move_one(p, populations_received(p, i, cell[0], cell[1]), populations_sent(p, reversed(i, imposed), cell[0], cell[1]),
           1, c);
}

static void links(struct boundary *b, struct populations *p, int y, int x0, int x1, bool step)
{
  const bool at[SIDE_COUNT] = {x0 == 0, x1 == p->nx, y == 0 && !b->ring[1], y == p->ny - 1 && !b->ring[1]};
  for (enum side_name x = SIDE_LEFT; x <= SIDE_RIGHT; x++)
    if (at[x] && y > 0 && y < p->ny - 1)
      cell_links(b, p, b->ring[0] ? opposite(x) : x, y, step);
    else if (at[x])
      side_links(b, p, b->ring[0] ? opposite(x) : x, y, y + 1, step);
  for (enum side_name end = SIDE_BOTTOM; end <= SIDE_TOP; end++) {
    if (!at[end]) continue;
    side_links(b, p, end, x0, x1, step);
    for (enum side_name x = SIDE_LEFT; x <= SIDE_RIGHT; x++)
      if (at[x] && !b->ring[0]) corner_link(b, p, x, end);
  }
}

void boundary_after(struct boundary *b, struct populations *p, int y, int x0, int x1)
{
  links(b, p, y, x0, x1, true);
}

void boundary_prefetch(const struct populations *p, int y)
{
  const size_t size = p->precision == PRECISION_DOUBLE ? sizeof(double) : sizeof(float);
  if (p->parity == 1) return;
  for (enum side_name side = SIDE_LEFT; side <= SIDE_RIGHT; side++)
    for (int j = 0; j < 3; j++) {
      const int x = side == SIDE_LEFT ? 0 : p->nx - 1;
      __builtin_prefetch((const char *)p->block + populations_received(p, inward[side][j], x, y) * size, 1);
    }
}

void boundary_refill(struct boundary *b, struct populations *p)
{
  struct populations before = *p; /* the same storage, with the parity of the last step */
  before.parity ^= 1;
  if (p->parity == 0) return; /* received populations are in the cells' own slots */
  for (int y = 0; y < p->ny; y++) links(b, &before, y, 0, p->nx, false);
}
