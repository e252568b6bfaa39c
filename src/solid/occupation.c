#include "solid/occupation.h"

#include "base/memory.h"
#include "solid/area.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

_Static_assert(BAND_ROWS + 2 <= AREA_ROWS, "the rows of a band, and one beyond on each side");

enum { SLACK = AREA_PAD }; /* elements past a band's last share that kernels may touch */

/* What a run is besides its cells: those that make discs candidates, the run's own widened by the reach; where its eps
 * begin; and where place[] keeps its number in the band. */
struct candidate {
  int32_t reach_first, reach_end;
  size_t cell, place;
};

struct band_draft {
  struct candidate *candidates; /* of each run of the band */
  double *eps;                  /* of all cells, disc by disc */
  size_t candidate_capacity, eps_capacity;
};

/* Rows and columns that a disc can touch. */
static size_t most_lines(double radius)
{
  return (size_t)ceil(2 * radius) + 2;
}

/* Cells that a disc can touch: those within half a cell's diagonal, and one more all round. */
static double most_cells(double radius)
{
  return ceil(M_PI * (radius + 1.5) * (radius + 1.5));
}

double occupation_bytes(const struct scene *scene)
{
  const size_t row = sizeof(struct run) + sizeof(struct moment_sums) + 2 * sizeof(size_t);
  const size_t disc = 2 * sizeof(double) + 5 * sizeof(int32_t) + sizeof(size_t) + 2 * sizeof(uint32_t) + 1;
  double bytes = 0;
  for (size_t i = 0; i < scene->particles.count; i++) {
    const double radius = scene->particles.discs[i].radius;
    bytes += most_cells(radius) * sizeof(double) + (double)(most_lines(radius) * row + disc);
  }
  return bytes;
}

static bool allocate(struct occupation *o, size_t rows, struct status *status)
{
  const char *what = "the occupation tables";
  const size_t n = o->discs, bands = (size_t)o->band_count;
  return (o->x = memory_allocate(n, sizeof *o->x, what, status)) &&
         (o->y = memory_allocate(n, sizeof *o->y, what, status)) &&
         (o->column = memory_allocate(n, sizeof *o->column, what, status)) &&
         (o->row = memory_allocate(n, sizeof *o->row, what, status)) &&
         (o->rows = memory_allocate(n, sizeof *o->rows, what, status)) &&
         (o->moved = memory_allocate(n, sizeof *o->moved, what, status)) &&
         (o->was_row = memory_allocate(n, sizeof *o->was_row, what, status)) &&
         (o->was_rows = memory_allocate(n, sizeof *o->was_rows, what, status)) &&
         (o->first_row = memory_allocate(n, sizeof *o->first_row, what, status)) &&
         (o->place = memory_allocate(2 * rows, sizeof *o->place, what, status)) &&
         (o->order = memory_allocate(n, sizeof *o->order, what, status)) &&
         (o->band_start = memory_allocate(bands + 1, sizeof *o->band_start, what, status)) &&
         (o->stale = memory_allocate(bands, sizeof *o->stale, what, status)) &&
         (o->bands = memory_allocate(bands, sizeof *o->bands, what, status)) &&
         (o->batches = memory_allocate(bands, sizeof *o->batches, what, status));
}

bool occupation_create(struct occupation *o, const struct scene *scene, const struct discs *discs, int reach,
                       struct status *status)
{
  *o = (struct occupation){.size = {scene->domain.size[0], scene->domain.size[1]},
                           .periodic = {scene_is_periodic(scene, 0), scene_is_periodic(scene, 1)},
                           .three_nu = 3 * scene->fluid.viscosity,
                           .reach = reach,
                           .minimum = 0.95,
                           .area = area_find(scene->fluid.kernel),
                           .search = scene->contact.search != SEARCH_GRID ? PAIRS_NONE
                                     : scene->contact.area == AREA_CELLS  ? PAIRS_WITH_AREA
                                                                          : PAIRS_ONCE,
                           .discs = discs->count,
                           .band_count = (scene->domain.size[1] + BAND_ROWS - 1) / BAND_ROWS};
  size_t rows = 0;
  for (size_t i = 0; i < discs->count; i++) rows += most_lines(discs->radius[i]);
  if (!allocate(o, rows, status)) {
    occupation_destroy(o);
    return false;
  }
  rows = 0;
  for (size_t i = 0; i < discs->count; i++) {
    o->order[i] = (uint32_t)i;
    o->first_row[i] = rows;
    rows += most_lines(discs->radius[i]);
  }
  return true;
}

void occupation_destroy(struct occupation *o)
{
  for (int k = 0; o->bands && k < o->band_count; k++) {
    free(o->bands[k].runs);
    if (o->batches) free(o->batches[k].pairs);
    free(o->bands[k].share);
    free(o->bands[k].sums);
  }
  for (size_t t = 0; t < o->draft_count; t++) {
    free(o->drafts[t].candidates);
    free(o->drafts[t].eps);
  }
  void *const arrays[] = {o->x,          o->y,        o->column,    o->row,     o->rows,  o->moved,
                          o->was_row,    o->was_rows, o->first_row, o->place,   o->order, o->band_start,
                          o->band_discs, o->stale,    o->bands,     o->batches, o->drafts};
  for (size_t k = 0; k < sizeof arrays / sizeof arrays[0]; k++) free(arrays[k]);
  *o = (struct occupation){0};
}

/* Notes where disc i is now. Rows that lie in no band keep no_run. */
static void settle(struct occupation *o, const struct discs *discs, size_t i)
{
  const double radius = discs->radius[i], x = discs->x[i], y = discs->y[i];
  o->moved[i] = !(o->painted && o->x[i] == x && o->y[i] == y);
  if (!o->moved[i]) return;
  o->was_row[i] = o->row[i];
  o->was_rows[i] = o->rows[i];
  o->x[i] = x;
  o->y[i] = y;
  o->column[i] = (int)floor(x - radius);
  o->row[i] = (int)floor(y - radius);
  o->rows[i] = (int)ceil(y + radius) - o->row[i];
  for (size_t k = 0; k < 2 * (size_t)o->rows[i]; k++) o->place[2 * o->first_row[i] + k] = no_run;
}

/* Insertion sort: discs keep their order from step to step but for a few. */
static void sort_by_x(struct occupation *o)
{
  for (size_t k = 1; k < o->discs; k++) {
    const uint32_t disc = o->order[k];
    size_t at = k;
    for (; at > 0; at--) {
      const uint32_t before = o->order[at - 1];
      if (o->x[before] < o->x[disc] || (o->x[before] == o->x[disc] && before < disc)) break;
      o->order[at] = before;
    }
    o->order[at] = disc;
  }
}

struct order_key {
  double x;
  uint32_t disc;
};

static int compare_keys(const void *a, const void *b)
{
  const struct order_key *l = a, *r = b;
  if (l->x != r->x) return l->x < r->x ? -1 : 1;
  return l->disc < r->disc ? -1 : l->disc > r->disc;
}

static bool sort_from_scratch(struct occupation *o, struct status *status)
{
  struct order_key *keys = memory_allocate(o->discs, sizeof *keys, "sorting the discs", status);
  if (!keys) return false;
  for (size_t i = 0; i < o->discs; i++) keys[i] = (struct order_key){o->x[i], (uint32_t)i};
  qsort(keys, o->discs, sizeof *keys, compare_keys);
  for (size_t i = 0; i < o->discs; i++) o->order[i] = keys[i].disc;
  free(keys);
  return true;
}

static int wrap(int at, int n)
{
  return at < 0 ? at + n : at >= n ? at - n : at;
}

/* Visits each band that rows low .. high touch, once, from the lowest on. */
struct band_walk {
  int y, high, opening, previous;
};

static struct band_walk walk_bands(const struct occupation *o, int row, int rows)
{
  struct band_walk walk = {.y = row - o->reach, .high = row + rows - 1 + o->reach, .opening = -1, .previous = -1};
  const int ny = o->size[1];
  if (!o->periodic[1]) {
    if (walk.y < 0) walk.y = 0;
    if (walk.high >= ny) walk.high = ny - 1;
  }
  return walk;
}

/* The next band, or -1 past the last. */
static int next_band(const struct occupation *o, struct band_walk *walk)
{
  while (walk->y <= walk->high) {
    const int row = wrap(walk->y, o->size[1]), band = row / BAND_ROWS;
    const int band_end = (band + 1) * BAND_ROWS < o->size[1] ? (band + 1) * BAND_ROWS : o->size[1];
    walk->y += band_end - row;
    if (band == walk->previous || band == walk->opening) continue;
    if (walk->opening < 0) walk->opening = band;
    walk->previous = band;
    return band;
  }
  return -1;
}

/* Bands that a moved disc has left or come to. Returns whether there are any. */
static bool mark_stale(struct occupation *o)
{
  bool any = !o->painted;
  memset(o->stale, any, (size_t)o->band_count);
  for (size_t i = 0; i < o->discs && o->painted; i++) {
    if (!o->moved[i]) continue;
    struct band_walk old = walk_bands(o, o->was_row[i], o->was_rows[i]), new = walk_bands(o, o->row[i], o->rows[i]);
    for (int band; (band = next_band(o, &old)) >= 0; any = true) o->stale[band] = 1;
    for (int band; (band = next_band(o, &new)) >= 0; any = true) o->stale[band] = 1;
  }
  return any;
}

/* Lists the discs of every band, along x. The end of band k doubles as the place where the next of k + 1 is entered. */
static bool list_bands(struct occupation *o, struct status *status)
{
  memset(o->band_start, 0, ((size_t)o->band_count + 1) * sizeof *o->band_start);
  for (size_t i = 0; i < o->discs; i++) {
    struct band_walk walk = walk_bands(o, o->row[i], o->rows[i]);
    for (int band; (band = next_band(o, &walk)) >= 0;) o->band_start[band + 1]++;
  }
  size_t total = 0;
  for (int b = 1; b <= o->band_count; b++) {
    const size_t count = o->band_start[b];
    o->band_start[b] = total;
    total += count;
  }
  if (!memory_grow(&o->band_discs, &o->band_discs_capacity, total, sizeof *o->band_discs, "the bands' discs", status))
    return false;
  for (size_t k = 0; k < o->discs; k++) {
    const uint32_t disc = o->order[k];
    struct band_walk walk = walk_bands(o, o->row[disc], o->rows[disc]);
    for (int band; (band = next_band(o, &walk)) >= 0;) o->band_discs[o->band_start[band + 1]++] = disc;
  }
  return true;
}

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
static void reach_columns(const struct occupation *o, const struct stretch *s, const struct area_extents *e, int k,
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
                      const struct area_extents *e, int k, size_t cell)
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
                              const struct stretch *s, const struct area_extents *e, int from, int end, size_t cell)
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
  const double radius = discs->radius[disc], x = o->x[disc], y = o->y[disc];
  const int rows = o->rows[disc], own = s->from > 0 ? s->from : 0, own_end = s->end < rows ? s->end : rows;
  struct area_extents e;
  o->area->extents(radius, x, y, o->row[disc] + s->reach_from, s->reach_end - s->reach_from, &e);
  size_t end = *cells;
  for (int k = own; k < own_end; k++) end += (size_t)(e.end[k - s->reach_from] - e.first[k - s->reach_from]);
  if (!memory_grow(&draft->eps, &draft->eps_capacity, end + SLACK, sizeof *draft->eps, "a band's cells", status))
    return false;
  if (own < own_end)
    o->area->rows(radius, x, y, o->row[disc] + s->reach_from, own - s->reach_from, own_end - s->reach_from, &e,
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

/* The shares of the band's cells, as if each had one owner. What a kernel writes past the end of a run is overwritten by
 * the next. */
static bool lay_out_shares(struct occupation *o, struct band *band, const struct band_draft *draft, size_t cells,
                           struct status *status)
{
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
      o->area->weights(draft->eps + draft->candidates[r].cell, run->n, o->three_nu, band->share + share);
      share += (uint32_t)run->n;
    }
  return true;
}

static bool paint_band(struct occupation *o, int index, const struct discs *discs, struct band_draft *draft,
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
  return lay_out_shares(o, band, draft, cells, status);
}

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

/* Shares a cell among its owners: the first of the encounter, and some of those after it. */
static void share_cell(struct occupation *o, struct band *band, const struct encounter *e, int x)
{
  double total = 0;
  size_t owners = 0, end = e->first;
  for (; end < e->count && e->candidates[end].reach_first <= x; end++) {
    if (!covers(&e->row[end], x)) continue;
    total += fraction(e, end, x);
    owners++;
  }
  if (total <= 0) return;
  const double weight = occupation_weight(fmin(1, total), o->three_nu) / total;
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
  const double size = o->size[axis];
  if (!o->periodic[axis] || fabs(d) <= size / 2) return d;
  return d > 0 ? d - size : d + size;
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
  if (!above_or_below && wrap((int)floor(at_y), o->size[1]) != y) {
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

static bool find_shared(struct occupation *o, int index, const struct discs *discs, const struct band_draft *draft,
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

/* What follows from where the discs are, before bands are painted. */
static bool prepare_bands(struct occupation *o, struct status *status)
{
  const size_t threads = (size_t)omp_get_num_threads();
  size_t capacity = o->draft_count;
  if (!mark_stale(o)) return true;
  if (!memory_grow(&o->drafts, &capacity, threads, sizeof *o->drafts, "the bands", status)) return false;
  if (threads > o->draft_count) {
    memset(o->drafts + o->draft_count, 0, (threads - o->draft_count) * sizeof *o->drafts);
    o->draft_count = threads;
  }
  if (o->painted)
    sort_by_x(o);
  else if (!sort_from_scratch(o, status))
    return false;
  return list_bands(o, status);
}

bool stage_occupation(struct occupation *o, const struct discs *discs, struct team *team)
{
  struct status status;
#pragma omp for schedule(static)
  for (size_t i = 0; i < o->discs; i++) settle(o, discs, i);
#pragma omp single
  {
    if (!prepare_bands(o, &status)) team_fail(team, &status);
    team_decide(team, TEAM_LISTED);
  }
  if (team->stop[TEAM_LISTED]) return false;
#pragma omp for schedule(static)
  for (int k = 0; k < o->band_count; k++) {
    struct band_draft *draft = &o->drafts[omp_get_thread_num()];
    if (o->stale[k] && (!paint_band(o, k, discs, draft, &status) || !find_shared(o, k, discs, draft, &status)))
      team_fail(team, &status);
  }
#pragma omp single
  {
    o->painted = true;
    team_decide(team, TEAM_PAINTED);
  }
  return !team->stop[TEAM_PAINTED];
}
