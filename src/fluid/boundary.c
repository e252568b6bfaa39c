#include "fluid/boundary.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

/* Populations that enter through a side. */
static const int inward[SIDE_COUNT][3] = {
    [SIDE_LEFT] = {1, 5, 8}, [SIDE_RIGHT] = {3, 6, 7}, [SIDE_BOTTOM] = {2, 5, 6}, [SIDE_TOP] = {4, 7, 8}};

/* The state of a ghost cell of an outlet (boundary.h). */
struct outlet_cell {
  double drift; /* d */
  double cut;   /* density of the source less that of the ghost */
  double last;  /* 3 (e - j) of the source after the last step */
};

static bool is_end(enum side_name side)
{
  return side == SIDE_BOTTOM || side == SIDE_TOP;
}

/* Cells along a side. */
static int side_length(const struct boundary *b, enum side_name side)
{
  return b->size[is_end(side) ? 0 : 1];
}

void boundary_corner_velocity(const struct side *x, const struct side *y, double velocity[2])
{
  const bool out_x = x->type == SIDE_OUTLET, out_y = y->type == SIDE_OUTLET;
  velocity[0] = out_x ? out_y ? NAN : y->velocity[0] : x->velocity[0];
  velocity[1] = out_y ? out_x ? NAN : x->velocity[1] : y->velocity[1];
}

/* c of a wall or inlet. */
static void set_momentum(struct boundary *b, enum side_name side)
{
  for (int j = 0; j < 3; j++)
    for (int k = 0; k < side_length(b, side); k++)
      b->c[side][j][k] = d2q9_wall_momentum(inward[side][j], b->side[side].velocity);
}

static bool create_side(struct boundary *b, enum side_name side, struct status *status)
{
  const enum side_type type = b->side[side].type;
  const size_t n = (size_t)side_length(b, side);
  if (type == SIDE_PERIODIC) return true;
  for (int j = 0; j < 3; j++) {
    b->c[side][j] = memory_allocate(n, sizeof *b->c[side][j], "the links of a side", status);
    if (!b->c[side][j]) return false;
  }
  if (type != SIDE_OUTLET) {
    set_momentum(b, side);
    return true;
  }
  b->ghost[side] = memory_allocate(n, sizeof *b->ghost[side], "the cells of an outlet", status);
  return b->ghost[side] != NULL;
}

bool boundary_create(struct boundary *b, const struct side side[SIDE_COUNT], int nx, int ny, struct status *status)
{
  *b = (struct boundary){.side = side, .size = {nx, ny}, .hold = boundary_outlet_hold(nx, ny)};
  for (enum side_name name = 0; name < SIDE_COUNT; name++)
    if (!create_side(b, name, status)) {
      boundary_destroy(b);
      return false;
    }
  return true;
}

void boundary_destroy(struct boundary *b)
{
  for (enum side_name side = 0; side < SIDE_COUNT; side++) {
    for (int j = 0; j < 3; j++) free(b->c[side][j]);
    free(b->ghost[side]);
  }
  *b = (struct boundary){0};
}

/* c of an outlet, from the state of its ghost cells. */
static void set_cut(struct boundary *b, enum side_name side, int k0, int k1)
{
  for (int j = 0; j < 3; j++)
    for (int k = k0; k < k1; k++) b->c[side][j][k] = -d2q9_weight[inward[side][j]] * b->ghost[side][k].cut;
}

bool boundary_store(struct boundary *b, struct store *store, struct status *status)
{
  for (enum side_name side = 0; side < SIDE_COUNT; side++) {
    const int n = side_length(b, side);
    if (b->side[side].type != SIDE_OUTLET) continue;
    if (!store_bytes(store, b->ghost[side], (size_t)n * sizeof *b->ghost[side], status)) return false;
    set_cut(b, side, 0, n);
  }
  return true;
}

/* Cell k of a side. */
static void side_cell(const struct boundary *b, enum side_name side, int k, int cell[2])
{
  const int axis = is_end(side) ? 1 : 0;
  cell[axis] = side == SIDE_LEFT || side == SIDE_BOTTOM ? 0 : b->size[axis] - 1;
  cell[!axis] = k;
}

/* slot[to + k] = slot[from + k] + c[k] for k < n. */
static void move(struct populations *p, size_t to, size_t from, int n, const double *c)
{
  if (p->precision == PRECISION_DOUBLE) {
    double *slot = p->block;
    for (int k = 0; k < n; k++) slot[to + (size_t)k] = slot[from + (size_t)k] + c[k];
  } else {
    float *slot = p->block;
    for (int k = 0; k < n; k++) slot[to + (size_t)k] = slot[from + (size_t)k] + (float)c[k];
  }
}

/* Cells target .. target + n - 1 of a side receive by link j what cells source .. source + n - 1 sent as population m. */
static void transfer(struct boundary *b, struct populations *p, enum side_name side, int j, int m, int source,
                     int target, int n)
{
  int from[2], to[2];
  if (n <= 0) return;
  side_cell(b, side, source, from);
  side_cell(b, side, target, to);
  move(p, populations_received(p, inward[side][j], to[0], to[1]), populations_sent(p, m, from[0], from[1]), n,
       b->c[side][j] + source);
}

/* Bounce-back of cells k0 .. k1 - 1, but for the link out of a corner. */
static void bounce_back(struct boundary *b, struct populations *p, enum side_name side, int k0, int k1)
{
  const bool ring = b->side[is_end(side) ? SIDE_LEFT : SIDE_BOTTOM].type == SIDE_PERIODIC;
  for (int j = 0; j < 3; j++) {
    const int i = inward[side][j], along = is_end(side) ? d2q9_ex[i] : d2q9_ey[i];
    const int first = !ring && along > 0 && k0 == 0 ? 1 : k0;
    const int end = !ring && along < 0 && k1 == side_length(b, side) ? k1 - 1 : k1;
    transfer(b, p, side, j, d2q9_opposite[i], first, first, end - first);
  }
}

/* The ghost cells beside cells k0 .. k1 - 1 send to the edge. */
static void send_from_ghosts(struct boundary *b, struct populations *p, enum side_name side, int k0, int k1)
{
  const bool ring = b->side[is_end(side) ? SIDE_LEFT : SIDE_BOTTOM].type == SIDE_PERIODIC;
  const int n = side_length(b, side);
  for (int j = 0; j < 3; j++) {
    const int i = inward[side][j], along = is_end(side) ? d2q9_ex[i] : d2q9_ey[i];
    const bool over_low = along < 0 && k0 == 0, over_high = along > 0 && k1 == n;
    const int first = k0 + over_low, end = k1 - over_high;
    transfer(b, p, side, j, i, first, first + along, end - first);
    if (ring && over_low) transfer(b, p, side, j, i, 0, n - 1, 1);
    if (ring && over_high) transfer(b, p, side, j, i, n - 1, 0, 1);
  }
}

struct edge_moments {
  double excess, outwards; /* over the reference density; momentum along the outward normal */
};

/* Moments of cell k, from what it has sent or, with `coming`, from what it is about to collide. */
static struct edge_moments edge_moments(const struct boundary *b, const struct populations *p, enum side_name side,
                                        int k, bool coming)
{
  const int *in = inward[side], axis = is_end(side) ? 1 : 0;
  struct edge_moments m = {0};
  int cell[2];
  side_cell(b, side, k, cell);
  for (int i = 0; i < Q; i++) {
    const int e[2] = {d2q9_ex[i], d2q9_ey[i]}, inwards[2] = {d2q9_ex[in[0]], d2q9_ey[in[0]]};
    const size_t slot = coming ? populations_source(p, i, cell[0], cell[1]) : populations_sent(p, i, cell[0], cell[1]);
    const double g = populations_get(p, slot);
    m.excess += g;
    m.outwards -= e[axis] * inwards[axis] * g;
  }
  return m;
}

void boundary_reset(struct boundary *b, const struct populations *p)
{
  for (enum side_name side = 0; side < SIDE_COUNT; side++) {
    if (b->side[side].type != SIDE_OUTLET) continue;
    for (int k = 0; k < side_length(b, side); k++) {
      const struct edge_moments m = edge_moments(b, p, side, k, true);
      b->ghost[side][k] = (struct outlet_cell){.last = 3 * (m.excess - m.outwards)};
    }
    set_cut(b, side, 0, side_length(b, side));
  }
}

/* The step of the ghost cells beside cells k0 .. k1 - 1. */
static void update_cut(struct boundary *b, const struct populations *p, enum side_name side, int k0, int k1)
{
  const double h = b->hold;
  for (int k = k0; k < k1; k++) {
    struct outlet_cell *ghost = &b->ghost[side][k];
    const struct edge_moments m = edge_moments(b, p, side, k, false);
    const double now = 3 * (m.excess - m.outwards);
    ghost->drift += h / 6 * (now - ghost->last + ghost->cut - ghost->drift);
    ghost->cut = h * (m.excess - ghost->cut / 2) + ghost->drift;
    ghost->last = now;
  }
  set_cut(b, side, k0, k1);
}

/* What cell (x, y) at the left or right end of its row sends out comes in at the other end. */
static void wrap(struct populations *p, int x, int y)
{
  static const double nothing = 0;
  const int *out = inward[x == 0 ? SIDE_RIGHT : SIDE_LEFT], far = p->nx - 1 - x;
  for (int j = 0; j < 3; j++) {
    const int i = out[j], to_y = y + d2q9_ey[i];
    if (!p->periodic_y && (to_y < 0 || to_y >= p->ny)) continue; /* a link of the bottom or top */
    move(p, populations_received(p, i, far, populations_row(p, to_y)), populations_sent(p, i, x, y), 1, &nothing);
  }
}

/* The link out of the corner of two sides. */
static void corner_link(struct boundary *b, struct populations *p, enum side_name x_side, enum side_name y_side)
{
  static const int diagonal[2][2] = {{5, 8}, {6, 7}};
  const int i = diagonal[x_side == SIDE_RIGHT][y_side == SIDE_TOP];
  const int x = x_side == SIDE_LEFT ? 0 : p->nx - 1, y = y_side == SIDE_BOTTOM ? 0 : p->ny - 1;
  const bool ghost = b->ghost[x_side] && b->ghost[y_side];
  double velocity[2];
  boundary_corner_velocity(&b->side[x_side], &b->side[y_side], velocity);
  double c = d2q9_wall_momentum(i, velocity);
  if (ghost) c = -d2q9_weight[i] * (b->ghost[x_side][y].cut + b->ghost[y_side][x].cut) / 2;
  move(p, populations_received(p, i, x, y), populations_sent(p, ghost ? i : d2q9_opposite[i], x, y), 1, &c);
}

/* The links of one side that begin at its cells k0 .. k1 - 1. `step`: these have just taken a step. */
static void side_links(struct boundary *b, struct populations *p, enum side_name side, int k0, int k1, bool step)
{
  if (b->side[side].type == SIDE_OUTLET) {
    if (step) update_cut(b, p, side, k0, k1);
    send_from_ghosts(b, p, side, k0, k1);
  } else {
    bounce_back(b, p, side, k0, k1);
  }
}

static void links(struct boundary *b, struct populations *p, int y, int x0, int x1, bool step)
{
  const bool ring = b->side[SIDE_LEFT].type == SIDE_PERIODIC;
  const bool at[SIDE_COUNT] = {x0 == 0, x1 == p->nx, y == 0 && !p->periodic_y, y == p->ny - 1 && !p->periodic_y};
  for (enum side_name x = SIDE_LEFT; x <= SIDE_RIGHT; x++) {
    if (at[x] && ring) wrap(p, x == SIDE_LEFT ? 0 : p->nx - 1, y);
    if (at[x] && !ring) side_links(b, p, x, y, y + 1, step);
  }
  for (enum side_name end = SIDE_BOTTOM; end <= SIDE_TOP; end++) {
    if (!at[end]) continue;
    side_links(b, p, end, x0, x1, step);
    for (enum side_name x = SIDE_LEFT; x <= SIDE_RIGHT; x++)
      if (at[x] && !ring) corner_link(b, p, x, end);
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
  struct populations before = *p; /* the same populations, as the last step left them */
  before.parity ^= 1;
  if (p->parity == 0) return; /* what links receive has been read with the cells */
  for (int y = 0; y < p->ny; y++) links(b, &before, y, 0, p->nx, false);
}
