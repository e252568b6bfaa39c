#include "solid/band.h"

#include "base/memory.h"

#include <math.h>

_Static_assert(BAND_ROWS + 2 <= SHAPE_ROWS, "the rows of a band, and one beyond on each side");

enum { SLACK = SHAPE_PAD }; /* elements past a band's last share that kernels may touch */

/* Rows of one disc, or of one periodic image of it, in one band. */
struct stretch {
  size_t disc;
  int from, end;  /* its rows, of which those below 0 and beyond its last only announce it */
  int to_band;    /* what to add to such a row for one of the band */
  bool inside;    /* all of it, with its reach, between left and right */
  int reach_from; /* the rows that its extents are needed of */
  int reach_end;
};

/* False where the image (-1, 0, 1) has no row in the band. */
static bool stretch_of(const struct occupation *o, const struct discs *discs, int index, size_t disc, int image,
                       struct stretch *s)
{
  const int first_row = index * BAND_ROWS, rows = o->rows[disc], reach = o->reach;
  const int end_row = first_row + BAND_ROWS < o->size[1] ? first_row + BAND_ROWS : o->size[1];
  const int low = first_row + image * o->size[1] - o->row[disc], high = low + end_row - first_row;
  const int columns = (int)ceil(2 * discs->radius[disc]) + 2;
  *s = (struct stretch){.disc = disc,
                        .from = low > -reach ? low : -reach,
                        .end = high < rows + reach ? high : rows + reach,
                        .to_band = -low,
                        .inside = o->column[disc] - reach >= 0 && o->column[disc] + columns + reach <= o->size[0]};
  s->reach_from = s->from - reach > 0 ? s->from - reach : 0;
  s->reach_end = s->end + reach < rows ? s->end + reach : rows;
  return s->from < s->end;
}

/* The columns by which row k of the disc makes it a candidate: those of its rows within reach, widened by the reach. */
static void reach_columns(const struct occupation *o, const struct stretch *s, const struct row_extents *e, int k,
                          int *first, int *end)
{
  const int reach = o->reach;
  *first = INT32_MAX;
  *end = INT32_MIN;
  for (int r = k - reach; r <= k + reach; r++) {
    if (r < s->reach_from || r >= s->reach_end) continue;
    const int at = r - s->reach_from;
    if (e->first[at] - reach < *first) *first = e->first[at] - reach;
    if (e->end[at] + reach > *end) *end = e->end[at] + reach;
  }
}

/* Of two runs of a row, by where they begin to be candidates, then by disc. */
static bool run_before(int32_t first, uint32_t disc, const struct candidate *other, const struct run *other_run)
{
  return first < other->reach_first || (first == other->reach_first && disc < other_run->disc);
}

/* Enters a run into its row; nearly always last, as discs come along x. */
static inline void enter_run(struct band *band, struct band_draft *draft, int row, const struct run *run,
                             const struct candidate *candidate)
{
  const size_t start = band->row_start[row];
  size_t at = band->row_end[row]++;
  for (; at > start && run_before(candidate->reach_first, run->disc, &draft->candidates[at - 1], &band->runs[at - 1]);
       at--) {
    band->runs[at] = band->runs[at - 1];
    draft->candidates[at] = draft->candidates[at - 1];
  }
  band->runs[at] = *run;
  draft->candidates[at] = *candidate;
}

/* Cells of a row before the box wraps or cuts it: its own, and those within reach of them. */
struct piece {
  int first, end, reach_first, reach_end;
};

static int clamp(int at, int most)
{
  return at < 0 ? 0 : at > most ? most : at;
}

/* The piece moved by `shift` columns into the box and cut to it, as piece number `number` of the disc's row k. Returns
 * false if nothing of it, nor its reach, is inside. */
static bool enter_piece(const struct occupation *o, struct band *band, struct band_draft *draft,
                        const struct stretch *s, const struct piece *p, int k, int shift, int number, size_t cell)
{
  const int nx = o->size[0];
  const int reach_first = clamp(p->reach_first + shift, nx), reach_end = clamp(p->reach_end + shift, nx);
  if (reach_first >= reach_end) return false;
  const int low = p->first + shift < 0 ? 0 : p->first + shift, high = p->end + shift > nx ? nx : p->end + shift;
  const int cut = low - (p->first + shift);
  const size_t disc = s->disc;
  const struct run run = {.x = low < high ? low : reach_first,
                          .n = low < high ? high - low : 0,
                          .disc = (uint32_t)disc,
                          .rx = p->first + 0.5 - o->x[disc] + cut,
                          .ry = o->row[disc] + k + 0.5 - o->y[disc]};
  const struct candidate candidate = {
      .reach_first = reach_first,
      .reach_end = reach_end,
      .cell = cell + (size_t)cut,
      .place = k >= 0 && k < o->rows[disc] ? 2 * (o->first_row[disc] + (size_t)k) + (size_t)number : no_run};
  enter_run(band, draft, k + s->to_band, &run, &candidate);
  return true;
}

/* The runs of row k of the disc, whose cells begin at `cell`: at most two pieces. */
static void enter_row(const struct occupation *o, struct band *band, struct band_draft *draft, const struct stretch *s,
                      const struct row_extents *e, int k, size_t cell)
{
  const int column = o->column[s->disc], at = k - s->reach_from;
  const bool own = k >= 0 && k < o->rows[s->disc];
  struct piece p;
  reach_columns(o, s, e, k, &p.reach_first, &p.reach_end);
  p.reach_first += column;
  p.reach_end += column;
  p.first = own ? column + e->first[at] : p.reach_first;
  p.end = own ? column + e->end[at] : p.reach_first;
  if (s->inside || !o->periodic[0]) {
    enter_piece(o, band, draft, s, &p, k, 0, 0, cell);
    return;
  }
  const int shifts[3] = {0, o->size[0], -o->size[0]};
  for (int n = 0, count = 0; n < 3 && count < 2; n++)
    count += enter_piece(o, band, draft, s, &p, k, shifts[n], count, cell);
}

/* enter_row for rows from .. end - 1 of a disc inside the box, where runs reach no further than their cells: nearly all. */
static void enter_rows_inside(const struct occupation *o, struct band *band, struct band_draft *draft,
                              const struct stretch *s, const struct row_extents *e, int from, int end, size_t cell)
{
  const double left = o->column[s->disc] + 0.5 - o->x[s->disc], low = o->row[s->disc] + 0.5 - o->y[s->disc];
  for (int k = from; k < end; k++) {
    const int at = k - s->reach_from, n = e->end[at] - e->first[at], first = o->column[s->disc] + e->first[at];
    const struct run run = {.x = first, .n = n, .disc = (uint32_t)s->disc, .rx = left + e->first[at], .ry = low + k};
    const struct candidate candidate = {
        .reach_first = first, .reach_end = first + n, .cell = cell, .place = 2 * (o->first_row[s->disc] + (size_t)k)};
    enter_run(band, draft, k + s->to_band, &run, &candidate);
    cell += (size_t)n;
  }
}

/* The runs of a stretch, and the areas of their cells, which begin at `cells`; sets where they end. */
static bool paint_stretch(struct occupation *o, struct band *band, struct band_draft *draft, const struct discs *discs,
                          const struct stretch *s, size_t *cells, struct status *status)
{
  const size_t disc = s->disc;
  const struct shape *shape = &discs->shape[disc];
  const struct pose pose = discs_pose(discs, disc);
  const int rows = o->rows[disc], own = s->from > 0 ? s->from : 0, own_end = s->end < rows ? s->end : rows;
  struct row_extents e;
  shape->kind->extents(shape, &pose, o->row[disc] + s->reach_from, s->reach_end - s->reach_from, &e);
  size_t end = *cells;
  for (int k = own; k < own_end; k++) end += (size_t)(e.end[k - s->reach_from] - e.first[k - s->reach_from]);
  if (!memory_grow(&draft->eps, &draft->eps_capacity, end + SLACK, sizeof *draft->eps, "a band's cells", status))
    return false;
  if (own < own_end)
    shape->kind->fractions(shape, &pose, o->row[disc] + s->reach_from, own - s->reach_from, own_end - s->reach_from, &e,
                           draft->eps + *cells);
  size_t cell = *cells;
  *cells = end;
  if (s->inside && o->reach == 0) {
    enter_rows_inside(o, band, draft, s, &e, own, own_end, cell);
    return true;
  }
  for (int k = s->from; k < s->end; k++) {
    enter_row(o, band, draft, s, &e, k, cell);
    if (k >= own && k < own_end) cell += (size_t)(e.end[k - s->reach_from] - e.first[k - s->reach_from]);
  }
  return true;
}

/* Room for the runs of each row: as many as there may be. */
static bool make_room(struct occupation *o, int index, const struct discs *discs, struct band_draft *draft,
                      struct status *status)
{
  struct band *band = &o->bands[index];
  size_t room[BAND_ROWS] = {0}, total = 0;
  struct stretch s;
  for (size_t d = o->band_start[index]; d < o->band_start[index + 1]; d++)
    for (int image = -o->periodic[1]; image <= o->periodic[1]; image++)
      if (stretch_of(o, discs, index, o->band_discs[d], image, &s))
        for (int k = s.from; k < s.end; k++) room[k + s.to_band] += s.inside || !o->periodic[0] ? 1 : 2;
  for (int k = 0; k < BAND_ROWS; k++) {
    band->row_start[k] = band->row_end[k] = total;
    total += room[k];
  }
  return memory_grow(&draft->candidates, &draft->candidate_capacity, total, sizeof *draft->candidates, "a band's runs",
                     status) &&
         memory_grow(&band->runs, &band->run_capacity, total, sizeof *band->runs, "a band's runs", status) &&
         memory_grow(&band->sums, &band->sums_capacity, total, sizeof *band->sums, "a band's sums", status);
}

/* The shares of a run of row y, whose cells are taken to have one owner. What a kernel writes past the end of a run is
 * overwritten by the next. */
static void lay_out_run(const struct occupation *o, const struct run *run, int y, const double *eps, double *share)
{
  const double damping = o->damping[run->disc];
  const int last = run->n - 1;
  o->kernel->weights(eps, run->n, occupation_law(o, damping, occupation_row_at_side(o, y)), share);
  if (o->periodic[0] || (run->x > 0 && run->x + last < o->size[0] - 1)) return;
  if (occupation_at_side(o, run->x, y)) share[0] = weight_of(occupation_law(o, damping, true), eps[0]);
  if (occupation_at_side(o, run->x + last, y)) share[last] = weight_of(occupation_law(o, damping, true), eps[last]);
}

static bool lay_out_shares(struct occupation *o, int index, const struct band_draft *draft, size_t cells,
                           struct status *status)
{
  struct band *band = &o->bands[index];
  uint32_t share = 0;
  if (cells > UINT32_MAX - SLACK)
    return status_fail(status, DELBM_FAILED, "%zu covered cells in %d rows are more than a band can hold", cells,
                       BAND_ROWS);
  if (!memory_grow(&band->share, &band->share_capacity, cells + SLACK, sizeof *band->share, "a band's cells", status))
    return false;
  for (int k = 0; k < BAND_ROWS; k++)
    for (size_t r = band->row_start[k]; r < band->row_end[k]; r++) {
      struct run *run = &band->runs[r];
      run->share = share;
      if (run->n == 0) continue;
      o->place[draft->candidates[r].place] = r;
      lay_out_run(o, run, index * BAND_ROWS + k, draft->eps + draft->candidates[r].cell, band->share + share);
      share += (uint32_t)run->n;
    }
  return true;
}

bool band_paint(struct occupation *o, int index, const struct discs *discs, struct band_draft *draft,
                struct status *status)
{
  struct band *band = &o->bands[index];
  size_t cells = 0;
  struct stretch s;
  if (!make_room(o, index, discs, draft, status)) return false;
  for (size_t d = o->band_start[index]; d < o->band_start[index + 1]; d++)
    for (int image = -o->periodic[1]; image <= o->periodic[1]; image++)
      if (stretch_of(o, discs, index, o->band_discs[d], image, &s) &&
          !paint_stretch(o, band, draft, discs, &s, &cells, status))
        return false;
  return lay_out_shares(o, index, draft, cells, status);
}
