#include "fluid/boundary.h"

/* Higher wins a corner. */
static int precedence(enum side_type type)
{
  static const int order[] = {[SIDE_PERIODIC] = 0, [SIDE_OUTLET] = 1, [SIDE_INLET] = 2, [SIDE_WALL] = 3};
  return order[type];
}

static bool bounces(const struct side *side)
{
  return side->type == SIDE_WALL || side->type == SIDE_INLET;
}

/* slot[to + k] = slot[from + k] + add for k < n. */
static void move(struct populations *p, size_t to, size_t from, int n, double add)
{
  if (p->precision == PRECISION_DOUBLE) {
    double *slot = p->block;
    for (int k = 0; k < n; k++) slot[to + (size_t)k] = slot[from + (size_t)k] + add;
  } else {
    float *slot = p->block;
    for (int k = 0; k < n; k++) slot[to + (size_t)k] = slot[from + (size_t)k] + (float)add;
  }
}

static bool inside_y(const struct populations *p, int y)
{
  return p->periodic_y || (y >= 0 && y < p->ny);
}

/* True where the link from row from_y, beyond the bottom or top, is ruled by that side rather than by `own`. */
static bool ruled_by_end(const struct populations *p, const struct side side[SIDE_COUNT], const struct side *own,
                         int from_y)
{
  if (inside_y(p, from_y)) return false;
  return precedence(side[from_y < 0 ? SIDE_BOTTOM : SIDE_TOP].type) >= precedence(own->type);
}

/* The three links of cell (x, y) to the left (inward +1) or right (inward -1) side. */
static void side_links(struct populations *p, const struct side side[SIDE_COUNT], int y, int inward, bool before)
{
  static const int inward_east[3] = {1, 5, 8}, inward_west[3] = {3, 6, 7};
  const struct side *own = &side[inward > 0 ? SIDE_LEFT : SIDE_RIGHT];
  const int x = inward > 0 ? 0 : p->nx - 1, far = p->nx - 1 - x;
  for (int k = 0; k < 3; k++) {
    const int i = inward > 0 ? inward_east[k] : inward_west[k], o = d2q9_opposite[i];
    const int from_y = y - d2q9_ey[i], to_y = y + d2q9_ey[i];
    if (own->type == SIDE_OUTLET && !before) { /* what this row sent inwards also arrives one cell further out */
      if (inside_y(p, to_y)) move(p, populations_slot(p, i, x, to_y), populations_slot(p, i, x + inward, to_y), 1, 0);
      continue;
    }
    if (ruled_by_end(p, side, own, from_y)) continue;
    const size_t ghost = populations_slot(p, o, x - inward, from_y);
    if (bounces(own)) {
      const size_t stays = populations_slot(p, i, x, y);
      const double add = d2q9_wall_momentum(i, own->velocity);
      move(p, before ? ghost : stays, before ? stays : ghost, 1, add);
    } else if (own->type == SIDE_PERIODIC) {
      const size_t wrapped = populations_slot(p, o, far, from_y);
      move(p, before ? ghost : wrapped, before ? wrapped : ghost, 1, 0);
    } else {
      move(p, ghost, populations_slot(p, o, x, from_y), 1, 0);
    }
  }
}

/* The links of row y to the bottom (inward +1) or top (inward -1) side. */
static void end_links(struct populations *p, const struct side side[SIDE_COUNT], int y, int inward, bool before)
{
  static const int inward_north[3] = {2, 5, 6}, inward_south[3] = {4, 7, 8};
  const struct side *own = &side[inward > 0 ? SIDE_BOTTOM : SIDE_TOP];
  const bool periodic_x = side[SIDE_LEFT].type == SIDE_PERIODIC;
  for (int k = 0; k < 3; k++) {
    const int i = inward > 0 ? inward_north[k] : inward_south[k], o = d2q9_opposite[i], ex = d2q9_ex[i];
    int first = 0, end = p->nx; /* the cells whose link belongs to this side */
    if (ex > 0 && precedence(side[SIDE_LEFT].type) > precedence(own->type)) first++;
    if (ex < 0 && precedence(side[SIDE_RIGHT].type) > precedence(own->type)) end--;
    const int n = end - first;
    const size_t ghost = populations_slot(p, o, first - ex, y - inward);
    if (bounces(own)) {
      const size_t stays = populations_slot(p, i, first, y);
      const double add = d2q9_wall_momentum(i, own->velocity);
      move(p, before ? ghost : stays, before ? stays : ghost, n, add);
    } else if (before) {
      move(p, ghost, populations_slot(p, o, first - ex, y), n, 0);
      /* the column beside the corner is itself a ghost: take the periodic image, or the corner cell */
      if (ex > 0 && first == 0) move(p, ghost, populations_slot(p, o, periodic_x ? p->nx - 1 : 0, y), 1, 0);
      if (ex < 0 && end == p->nx)
        move(p, ghost + (size_t)n - 1, populations_slot(p, o, periodic_x ? 0 : p->nx - 1, y), 1, 0);
    } else {
      const int lo = ex > 0 ? 1 : 0, hi = ex < 0 ? p->nx - 1 : p->nx; /* where row y has written one row further in */
      move(p, populations_slot(p, i, lo, y), populations_slot(p, i, lo, y + inward), hi - lo, 0);
      const int corner = ex > 0 ? 0 : p->nx - 1, image = ex > 0 ? p->nx : -1, inner = corner + ex;
      const bool own_corner = ex > 0 ? first == 0 : end == p->nx;
      if (ex && own_corner)
        move(p, populations_slot(p, i, corner, y), populations_slot(p, i, periodic_x ? image : inner, y + inward), 1,
             0);
    }
  }
}

static void row_links(struct populations *p, const struct side side[SIDE_COUNT], int y, bool before)
{
  side_links(p, side, y, +1, before);
  side_links(p, side, y, -1, before);
  if (p->periodic_y) return;
  if (y == 0) end_links(p, side, y, +1, before);
  if (y == p->ny - 1) end_links(p, side, y, -1, before);
}

void boundary_before_row(struct populations *p, const struct side side[SIDE_COUNT], int y)
{
  row_links(p, side, y, true);
}

void boundary_after_row(struct populations *p, const struct side side[SIDE_COUNT], int y)
{
  row_links(p, side, y, false);
}

bool boundary_fill_first(const struct side side[SIDE_COUNT])
{
  return side[SIDE_BOTTOM].type == SIDE_OUTLET || side[SIDE_TOP].type == SIDE_OUTLET;
}
