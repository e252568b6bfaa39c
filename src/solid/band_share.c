#include "solid/band.h"

#include <math.h>

/* Runs `first` and `second` of a row overlap; runs before `open` end before run `first` begins. */
struct overlap {
  const struct run *row;
  const struct run_draft *draft; /* [run of the row] */
  const double *eps;
  size_t count, open, first, second;
};

static bool covers(const struct run *run, int x)
{
  return x >= run->x && x < run->x + run->n;
}

/* eps of cell x in run r of the row. */
static double fraction(const struct overlap *e, size_t r, int x)
{
  return e->eps[e->draft[r].cell + (size_t)(x - e->row[r].x)];
}

/* Sets the owner weights of a cell with more than one owner. All its runs begin with run `first` or after it. */
static void share_cell(struct occupation *o, struct band *band, const struct overlap *e, int x)
{
  double total = 0, damping = 0;
  size_t owners = 0, end = e->first;
  for (; end < e->count && e->row[end].x <= x; end++) {
    if (!covers(&e->row[end], x)) continue;
    total += fraction(e, end, x);
    damping = fmax(damping, o->damping[e->row[end].owner]);
    owners += fraction(e, end, x) > 0;
  }
  if (owners < 2) return;
  const double weight = weight_of(occupation_law(o, damping, true), fmin(1, total)) / total;
  for (size_t r = e->first; r < end; r++)
    if (covers(&e->row[r], x))
      band->owner_weight[e->row[r].first + (size_t)(x - e->row[r].x)] = fraction(e, r, x) * weight;
  band->shared_cells++;
  band->shared_owners += owners;
}

/* True if a run before `second`, other than `first`, contains the cell: an earlier overlap has set its owner weights. */
static bool shared_earlier(const struct overlap *e, int x)
{
  for (size_t r = e->open; r < e->second; r++)
    if (r != e->first && covers(&e->row[r], x)) return true;
  return false;
}

static int end_of(const struct run *run)
{
  return run->x + run->n;
}

/* Sets the owner weights of the cells in both runs. */
static void share_overlap(struct occupation *o, struct band *band, const struct overlap *e)
{
  const struct run *l = &e->row[e->first], *r = &e->row[e->second];
  const int end = end_of(l) < end_of(r) ? end_of(l) : end_of(r);
  for (int x = r->x; x < end; x++)
    if (!shared_earlier(e, x)) share_cell(o, band, e, x);
}

void band_share(struct occupation *o, int index, const struct band_draft *draft)
{
  struct band *band = &o->bands[index];
  band->shared_cells = band->shared_owners = 0;
  for (int k = 0; k < BAND_ROWS; k++) {
    const struct run *row = band->runs + band->row_start[k];
    struct overlap e = {.row = row,
                        .draft = draft->runs + band->row_start[k],
                        .eps = draft->eps,
                        .count = band->row_end[k] - band->row_start[k]};
    for (e.first = 0; e.first + 1 < e.count; e.first++) {
      while (e.open < e.first && end_of(&row[e.open]) <= row[e.first].x) e.open++;
      for (e.second = e.first + 1; e.second < e.count && row[e.second].x < end_of(&row[e.first]); e.second++)
        share_overlap(o, band, &e);
    }
  }
}
