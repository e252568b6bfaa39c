#include "solid/band.h"

#include "base/memory.h"

#include <math.h>

/* Two runs of a row that meet; runs before `open` end before them. */
struct encounter {
  const struct run *row;
  const struct candidate *candidates; /* of the row's runs */
  const double *eps;
  size_t count, open, first, second;
  int y; /* of the box */
};

static bool covers(const struct run *run, int x)
{
  return x >= run->x && x < run->x + run->n;
}

/* eps of cell x, which the row's run r covers. */
static double fraction(const struct encounter *e, size_t r, int x)
{
  return e->eps[e->candidates[r].cell + (size_t)(x - e->row[r].x)];
}

/* Shares a cell among its owners, if it has more than one: the first of the encounter, and some of those after it. */
static void share_cell(struct occupation *o, struct band *band, const struct encounter *e, int x)
{
  double total = 0, damping = 0;
  size_t owners = 0, end = e->first;
  for (; end < e->count && e->candidates[end].reach_first <= x; end++) {
    if (!covers(&e->row[end], x)) continue;
    total += fraction(e, end, x);
    damping = fmax(damping, o->damping[e->row[end].disc]);
    owners += fraction(e, end, x) > 0;
  }
  if (owners < 2) return;
  const double weight = weight_of(occupation_law(o, damping, true), fmin(1, total)) / total;
  for (size_t r = e->first; r < end; r++)
    if (covers(&e->row[r], x)) band->share[e->row[r].share + (size_t)(x - e->row[r].x)] = fraction(e, r, x) * weight;
  band->shared_cells++;
  band->shared_owners += owners;
}

/* True if a run before the second, other than the first, covers the cell: it is then shared on their account. */
static bool shared_earlier(const struct encounter *e, int x)
{
  for (size_t r = e->open; r < e->second; r++)
    if (r != e->first && covers(&e->row[r], x)) return true;
  return false;
}

/* What (23) sums over the cells low .. high - 1, which both runs cover. */
static double cells_area(const struct occupation *o, const struct encounter *e, int low, int high)
{
  double area = 0;
  for (int x = low; x < high; x++) {
    const double eps_l = fraction(e, e->first, x), eps_r = fraction(e, e->second, x);
    if (eps_l > 0 && eps_r > 0) area += fmax(0, eps_l + eps_r - o->minimum);
  }
  return area;
}

static double nearest(const struct occupation *o, int axis, double d)
{
  return nearest_image(d, o->size[axis], o->periodic[axis]);
}

/* Whether row y is the one in which the pair is noted: that of the point where the discs' radical line crosses the line of
 * their centres, which both cover (if one holds the other: the smaller one's centre). Both have it within reach, so that
 * they meet in this row. A point outside of the box, where no rows are, decides nothing. */
static bool noted_in_row(const struct occupation *o, const struct discs *discs, uint32_t a, uint32_t b, int y)
{
  const double ra = discs->radius[a], rb = discs->radius[b], near = ra + rb + o->reach, difference = ra - rb;
  const double dx = nearest(o, 0, o->x[b] - o->x[a]), dy = nearest(o, 1, o->y[b] - o->y[a]), d2 = dx * dx + dy * dy;
  double along = 0.5; /* of the way from a to b */
  if (difference != 0) along = d2 > difference * difference ? 0.5 + 0.5 * difference * (ra + rb) / d2 : ra > rb;
  const double at_y = o->y[a] + along * dy;
  const bool above_or_below = !o->periodic[1] && !(at_y > 0 && at_y < o->size[1]);
  if (!above_or_below && band_wrap((int)floor(at_y), o->size[1]) != y) {
    const double at_x = o->x[a] + along * dx;
    if (o->periodic[0] || (at_x > 0 && at_x < o->size[0])) return false;
  }
  return d2 < near * near;
}

static bool note_pair(struct occupation *o, int index, const struct near_pair *pair, struct status *status)
{
  struct pair_batch *batch = &o->batches[index];
  if (!memory_grow(&batch->pairs, &batch->capacity, batch->count + 1, sizeof *batch->pairs, "a band's pairs", status))
    return false;
  batch->pairs[batch->count++] = *pair;
  return true;
}

/* Two runs whose reaches overlap: the cells that both cover are shared, and their discs may be a pair. */
static bool meet(struct occupation *o, int index, const struct discs *discs, const struct encounter *e,
                 struct status *status)
{
  struct band *band = &o->bands[index];
  const struct run *l = &e->row[e->first], *r = &e->row[e->second];
  struct near_pair pair = {.a = l->disc < r->disc ? l->disc : r->disc, .b = l->disc < r->disc ? r->disc : l->disc};
  const int low = l->x > r->x ? l->x : r->x;
  const int high = l->x + l->n < r->x + r->n ? l->x + l->n : r->x + r->n;
  for (int x = low; x < high; x++)
    if (!shared_earlier(e, x)) share_cell(o, band, e, x);
  if (pair.a == pair.b || o->search == PAIRS_NONE) return true;
  if (o->search == PAIRS_WITH_AREA) pair.cells_area = cells_area(o, e, low, high);
  const bool noted = o->search == PAIRS_WITH_AREA || noted_in_row(o, discs, pair.a, pair.b, e->y);
  return !noted || note_pair(o, index, &pair, status);
}

bool band_share(struct occupation *o, int index, const struct discs *discs, const struct band_draft *draft,
                struct status *status)
{
  struct band *band = &o->bands[index];
  o->batches[index].count = band->shared_cells = band->shared_owners = 0;
  for (int k = 0; k < BAND_ROWS; k++) {
    const struct candidate *c = draft->candidates + band->row_start[k];
    struct encounter e = {.row = band->runs + band->row_start[k],
                          .candidates = c,
                          .eps = draft->eps,
                          .count = band->row_end[k] - band->row_start[k],
                          .y = index * BAND_ROWS + k};
    for (e.first = 0; e.first + 1 < e.count; e.first++) {
      while (e.open < e.first && c[e.open].reach_end <= c[e.first].reach_first) e.open++;
      for (e.second = e.first + 1; e.second < e.count && c[e.second].reach_first < c[e.first].reach_end; e.second++)
        if (!meet(o, index, discs, &e, status)) return false;
    }
  }
  return true;
}
