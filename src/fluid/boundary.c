#include "fluid/boundary.h"

/* Higher wins a corner. */
static int precedence(enum side_type type)
{
  static const int order[] = {[SIDE_PERIODIC] = 0, [SIDE_OUTLET] = 1, [SIDE_INLET] = 2, [SIDE_WALL] = 3};
  return order[type];
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

/* The link of direction i from the ghost (gx, gy) of an outlet. What arrives is what its edge cell, the nearest in the
 * box or the periodic image of that, sends the same way: before the sweep that waits where parity 0 left it, afterwards
 * where the cell has written it. */
static void outlet_link(struct populations *p, bool periodic_x, int i, int gx, int gy, bool before)
{
  const int ex = d2q9_ex[i], ey = d2q9_ey[i], o = d2q9_opposite[i], nx = p->nx, ny = p->ny;
  const int x = gx < 0 ? (periodic_x ? nx - 1 : 0) : gx < nx ? gx : (periodic_x ? 0 : nx - 1);
  const int y = gy < 0 ? 0 : gy < ny ? gy : ny - 1;
  double excess = 0;
  for (int k = 0; k < Q; k++)
    excess += populations_get(p, before ? populations_slot(p, k, x, y)
                                        : populations_slot(p, k, x + d2q9_ex[k], y + d2q9_ey[k]));
  const size_t from = before ? populations_slot(p, o, x, y) : populations_slot(p, i, x + ex, y + ey);
  const size_t to = before ? populations_slot(p, o, gx, gy) : populations_slot(p, i, gx + ex, gy + ey);
  populations_set(p, to, populations_get(p, from) - boundary_outlet_hold(nx, ny) * d2q9_weight[i] * excess);
}

/* Which sides a pass is for. */
enum { OUTLETS = 1, OTHERS = 2, ALL_SIDES = OUTLETS | OTHERS };

static bool is_meant(const struct side *side, int which)
{
  return (which & (side->type == SIDE_OUTLET ? OUTLETS : OTHERS)) != 0;
}

/* The links of row y to the left (inward +1) or right (inward -1) side, with the positions of x = 0 in plane 0 of the
 * rows below, at and above y: of an outlet those from the ghost beside the row, of
 * other sides those to the cell at its end. */
static void side_links(struct populations *p, const struct side side[SIDE_COUNT], int y, const size_t row[3],
                       int inward, bool before)
{
  static const int inward_east[3] = {1, 5, 8}, inward_west[3] = {3, 6, 7};
  const struct side *own = &side[inward > 0 ? SIDE_LEFT : SIDE_RIGHT];
  const int x = inward > 0 ? 0 : p->nx - 1, far = p->nx - 1 - x;
  for (int k = 0; k < 3; k++) {
    const int i = inward > 0 ? inward_east[k] : inward_west[k], o = d2q9_opposite[i];
    if (own->type == SIDE_OUTLET) {
      if (inside_y(p, y + d2q9_ey[i])) outlet_link(p, false, i, x - inward, y, before);
      continue;
    }
    if (ruled_by_end(p, side, own, y - d2q9_ey[i])) continue;
    const bool periodic = own->type == SIDE_PERIODIC;
    const size_t from = row[1 - d2q9_ey[i]] + (size_t)o * p->plane;
    const size_t ghost = from + (size_t)(ptrdiff_t)(x - inward);
    const size_t inside = periodic ? from + (size_t)far : row[1] + (size_t)i * p->plane + (size_t)x;
    const double add = periodic ? 0 : d2q9_wall_momentum(i, own->velocity);
    move(p, before ? ghost : inside, before ? inside : ghost, 1, add);
  }
}

/* The links of cells x0 .. x1 - 1 of row y to the bottom (inward +1) or top (inward -1) side. */
static void end_links(struct populations *p, const struct side side[SIDE_COUNT], int y, int x0, int x1, int inward,
                      bool before)
{
  static const int inward_north[3] = {2, 5, 6}, inward_south[3] = {4, 7, 8};
  const struct side *own = &side[inward > 0 ? SIDE_BOTTOM : SIDE_TOP];
  const bool periodic_x = side[SIDE_LEFT].type == SIDE_PERIODIC;
  for (int k = 0; k < 3; k++) {
    const int i = inward > 0 ? inward_north[k] : inward_south[k], o = d2q9_opposite[i], ex = d2q9_ex[i];
    int first = x0, end = x1; /* the cells whose link belongs to this side */
    if (ex > 0 && first == 0 && precedence(side[SIDE_LEFT].type) > precedence(own->type)) first++;
    if (ex < 0 && end == p->nx && precedence(side[SIDE_RIGHT].type) > precedence(own->type)) end--;
    if (own->type == SIDE_OUTLET) {
      for (int x = first; x < end; x++) outlet_link(p, periodic_x, i, x - ex, y - inward, before);
      continue;
    }
    const size_t ghost = populations_slot(p, o, first - ex, y - inward);
    const size_t inside = populations_slot(p, i, first, y);
    move(p, before ? ghost : inside, before ? inside : ghost, end - first, d2q9_wall_momentum(i, own->velocity));
  }
}

static void links(struct populations *p, const struct side side[SIDE_COUNT], int y, int x0, int x1, bool before,
                  int which)
{
  const size_t row[3] = {populations_slot(p, 0, 0, y - 1), populations_slot(p, 0, 0, y),
                         populations_slot(p, 0, 0, y + 1)};
  if (x0 == 0 && is_meant(&side[SIDE_LEFT], which)) side_links(p, side, y, row, +1, before);
  if (x1 == p->nx && is_meant(&side[SIDE_RIGHT], which)) side_links(p, side, y, row, -1, before);
  if (p->periodic_y) return;
  if (y == 0 && is_meant(&side[SIDE_BOTTOM], which)) end_links(p, side, y, x0, x1, +1, before);
  if (y == p->ny - 1 && is_meant(&side[SIDE_TOP], which)) end_links(p, side, y, x0, x1, -1, before);
}

void boundary_before(struct populations *p, const struct side side[SIDE_COUNT], int y, int x0, int x1)
{
  links(p, side, y, x0, x1, true, ALL_SIDES);
}

void boundary_after(struct populations *p, const struct side side[SIDE_COUNT], int y, int x0, int x1)
{
  links(p, side, y, x0, x1, false, ALL_SIDES);
}

void boundary_before_row(struct populations *p, const struct side side[SIDE_COUNT], int y)
{
  links(p, side, y, 0, p->nx, true, ALL_SIDES);
}

void boundary_outlets_before_row(struct populations *p, const struct side side[SIDE_COUNT], int y)
{
  links(p, side, y, 0, p->nx, true, OUTLETS);
}

void boundary_others_before_row(struct populations *p, const struct side side[SIDE_COUNT], int y)
{
  links(p, side, y, 0, p->nx, true, OTHERS);
}

void boundary_after_row(struct populations *p, const struct side side[SIDE_COUNT], int y)
{
  links(p, side, y, 0, p->nx, false, ALL_SIDES);
}

bool boundary_fill_first(const struct side side[SIDE_COUNT])
{
  for (int k = 0; k < SIDE_COUNT; k++)
    if (side[k].type == SIDE_OUTLET) return true;
  return false;
}
