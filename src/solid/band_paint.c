#include "solid/band.h"

#include "base/memory.h"

#include <math.h>

_Static_assert((int)BAND_ROWS <= (int)SHAPE_ROWS, "the rows of a band are computed in one call");

enum { SLACK = SHAPE_PAD }; /* elements past a band's last cell that kernels may access */

/* The rows of one disc, or of one of its images across the bottom or top, that lie in one band. */
struct disc_rows {
  size_t disc;
  int from, end; /* from .. end - 1, counted from the lowest row of the disc */
  int to_band;   /* row of the band = row of the disc + to_band */
  bool inside;   /* the disc crosses neither the left nor the right side */
};

/* False if the image (-1, 0, 1) has no row in the band. */
static bool rows_in_band(const struct occupation *o, const struct discs *discs, int index, size_t disc, int image,
                         struct disc_rows *s)
{
  const int first_row = index * BAND_ROWS, rows = o->rows[disc];
  const int end_row = first_row + BAND_ROWS < o->size[1] ? first_row + BAND_ROWS : o->size[1];
  const int low = first_row + image * o->size[1] - o->row[disc], high = low + end_row - first_row;
  const int columns = (int)ceil(2 * discs->hydraulic[disc].radius) + 2;
  *s = (struct disc_rows){.disc = disc,
                          .from = low > 0 ? low : 0,
                          .end = high < rows ? high : rows,
                          .to_band = -low,
                          .inside = o->column[disc] >= 0 && o->column[disc] + columns <= o->size[0]};
  return s->from < s->end;
}

/* Insertion sort by first cell, then by owner; discs come in the order of x, so that nearly every run becomes the
 * last. */
static inline void insert_run(struct band *band, struct band_draft *draft, int row, const struct run *run,
                              const struct run_draft *run_draft)
{
  const size_t start = band->row_start[row];
  size_t at = band->row_end[row]++;
  for (; at > start; at--) {
    const struct run *before = &band->runs[at - 1];
    if (before->x < run->x || (before->x == run->x && before->owner <= run->owner)) break;
    band->runs[at] = *before;
    draft->runs[at] = draft->runs[at - 1];
  }
  band->runs[at] = *run;
  draft->runs[at] = *run_draft;
}

/* Adds piece `number` of row k of the disc: cells first .. end - 1, displaced by `shift` and cut to the box. `cell`:
 * index of the first cell in eps[]. False if no cell lies in the box. */
static bool add_piece(const struct occupation *o, struct band *band, struct band_draft *draft,
                      const struct disc_rows *s, int k, int first, int end, int shift, int number, size_t cell)
{
  const int nx = o->size[0], low = first + shift < 0 ? 0 : first + shift, high = end + shift > nx ? nx : end + shift;
  const int cut = low - (first + shift);
  if (low >= high) return false;
  const struct run run = {.x = low,
                          .n = high - low,
                          .owner = (uint32_t)s->disc,
                          .rx = first + 0.5 - o->x[s->disc] + cut,
                          .ry = o->row[s->disc] + k + 0.5 - o->y[s->disc]};
  const struct run_draft run_draft = {.cell = cell + (size_t)cut,
                                      .slot = 2 * (o->first_row[s->disc] + (size_t)k) + (size_t)number};
  insert_run(band, draft, k + s->to_band, &run, &run_draft);
  return true;
}

/* Adds the runs of row k of the disc: up to two pieces in a periodic box. */
static void add_row(const struct occupation *o, struct band *band, struct band_draft *draft, const struct disc_rows *s,
                    int k, int first, int end, size_t cell)
{
  if (s->inside || !o->periodic[0]) {
    add_piece(o, band, draft, s, k, first, end, 0, 0, cell);
    return;
  }
  const int shifts[3] = {0, o->size[0], -o->size[0]};
  for (int n = 0, count = 0; n < 3 && count < 2; n++)
    count += add_piece(o, band, draft, s, k, first, end, shifts[n], count, cell);
}

/* Adds the runs of the rows, and appends the occupation fractions of their cells to eps[]. *cells: length of eps[]. */
static bool paint_rows(struct occupation *o, struct band *band, struct band_draft *draft, const struct discs *discs,
                       const struct disc_rows *s, size_t *cells, struct status *status)
{
  const size_t disc = s->disc;
  const struct shape *shape = &discs->hydraulic[disc];
  const struct pose pose = discs_pose(discs, disc);
  const int rows = s->end - s->from, column = o->column[disc];
  struct row_extents e;
  shape->kind->extents(shape, &pose, o->row[disc] + s->from, rows, &e);
  size_t cell = *cells;
  for (int k = 0; k < rows; k++) *cells += (size_t)(e.end[k] - e.first[k]);
  if (!memory_grow(&draft->eps, &draft->eps_capacity, *cells + SLACK, sizeof *draft->eps, "a band's cells", status))
    return false;
  shape->kind->fractions(shape, &pose, o->row[disc] + s->from, 0, rows, &e, draft->eps + cell);
  for (int k = 0; k < rows; k++) {
    add_row(o, band, draft, s, s->from + k, column + e.first[k], column + e.end[k], cell);
    cell += (size_t)(e.end[k] - e.first[k]);
  }
  return true;
}

/* Reserves memory for the maximum number of runs of each row. */
static bool reserve_runs(struct occupation *o, int index, const struct discs *discs, struct band_draft *draft,
                         struct status *status)
{
  struct band *band = &o->bands[index];
  size_t room[BAND_ROWS] = {0}, total = 0;
  struct disc_rows s;
  for (size_t d = o->band_start[index]; d < o->band_start[index + 1]; d++)
    for (int image = -o->periodic[1]; image <= o->periodic[1]; image++)
      if (rows_in_band(o, discs, index, o->band_discs[d], image, &s))
        for (int k = s.from; k < s.end; k++) room[k + s.to_band] += s.inside || !o->periodic[0] ? 1 : 2;
  for (int k = 0; k < BAND_ROWS; k++) {
    band->row_start[k] = band->row_end[k] = total;
    total += room[k];
  }
  return memory_grow(&draft->runs, &draft->run_capacity, total, sizeof *draft->runs, "a band's runs", status) &&
         memory_grow(&band->runs, &band->run_capacity, total, sizeof *band->runs, "a band's runs", status) &&
         memory_grow(&band->sums, &band->sums_capacity, total, sizeof *band->sums, "a band's sums", status);
}

/* Owner weights of a run of row y, as if each cell had one owner. The kernel writes past the end of the run; the next
 * run overwrites these elements. */
static void weigh_run(const struct occupation *o, const struct run *run, int y, const double *eps, double *owner_weight)
{
  const double damping = o->damping[run->owner];
  const int last = run->n - 1;
  o->kernel->weights(eps, run->n, occupation_law(o, damping, occupation_row_at_side(o, y)), owner_weight);
  if (o->periodic[0] || (run->x > 0 && run->x + last < o->size[0] - 1)) return;
  if (occupation_at_side(o, run->x, y)) owner_weight[0] = weight_of(occupation_law(o, damping, true), eps[0]);
  if (occupation_at_side(o, run->x + last, y))
    owner_weight[last] = weight_of(occupation_law(o, damping, true), eps[last]);
}

static bool weigh_runs(struct occupation *o, int index, const struct band_draft *draft, size_t cells,
                       struct status *status)
{
  struct band *band = &o->bands[index];
  uint32_t first = 0;
  if (cells > UINT32_MAX - SLACK)
    return status_fail(status, DELBM_FAILED, "%zu cells of discs in %d rows are more than a band can store", cells,
                       BAND_ROWS);
  if (!memory_grow(&band->owner_weight, &band->weight_capacity, cells + SLACK, sizeof *band->owner_weight,
                   "a band's cells", status))
    return false;
  for (int k = 0; k < BAND_ROWS; k++)
    for (size_t r = band->row_start[k]; r < band->row_end[k]; r++) {
      struct run *run = &band->runs[r];
      run->first = first;
      o->run_index[draft->runs[r].slot] = r;
      weigh_run(o, run, index * BAND_ROWS + k, draft->eps + draft->runs[r].cell, band->owner_weight + first);
      first += (uint32_t)run->n;
    }
  return true;
}

bool band_paint(struct occupation *o, int index, const struct discs *discs, struct band_draft *draft,
                struct status *status)
{
  struct band *band = &o->bands[index];
  size_t cells = 0;
  struct disc_rows s;
  if (!reserve_runs(o, index, discs, draft, status)) return false;
  for (size_t d = o->band_start[index]; d < o->band_start[index + 1]; d++)
    for (int image = -o->periodic[1]; image <= o->periodic[1]; image++)
      if (rows_in_band(o, discs, index, o->band_discs[d], image, &s) &&
          !paint_rows(o, band, draft, discs, &s, &cells, status))
        return false;
  return weigh_runs(o, index, draft, cells, status);
}
