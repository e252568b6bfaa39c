#include "solid/occupation.h"

#include "base/memory.h"
#include "solid/area.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SLACK = AREA_PAD }; /* elements past a band's last share that kernels may touch */

/* Rows and columns that a disc can touch. */
static size_t most_lines(double radius)
{
  return (size_t)ceil(2 * radius) + 2;
}

/* Cells that a disc can touch: those within half a cell's diagonal, and one more all round; and what the kernel pads.
 * */
static size_t most_cells(double radius)
{
  return (size_t)ceil(M_PI * (radius + 1.5) * (radius + 1.5)) + AREA_PAD;
}

double occupation_bytes(const struct scene *scene)
{
  const size_t row = sizeof(struct span) + 2 * sizeof(struct run) + sizeof(struct moment_sums) + 2 * sizeof(size_t);
  const size_t disc = 2 * sizeof(double) + 3 * sizeof(int32_t) + 2 * sizeof(size_t) + 2 * sizeof(uint32_t);
  double bytes = 0;
  for (size_t i = 0; i < scene->particles.count; i++) {
    const double radius = scene->particles.discs[i].radius;
    bytes += (double)(most_cells(radius) * 2 * sizeof(double) + most_lines(radius) * row + disc); /* eps and shares */
  }
  return bytes;
}

static bool allocate(struct occupation *o, size_t spans, size_t cells, struct status *status)
{
  const char *what = "the occupation tables";
  const size_t n = o->discs;
  return (o->x = memory_allocate(n, sizeof *o->x, what, status)) &&
         (o->y = memory_allocate(n, sizeof *o->y, what, status)) &&
         (o->column = memory_allocate(n, sizeof *o->column, what, status)) &&
         (o->row = memory_allocate(n, sizeof *o->row, what, status)) &&
         (o->rows = memory_allocate(n, sizeof *o->rows, what, status)) &&
         (o->first_span = memory_allocate(n, sizeof *o->first_span, what, status)) &&
         (o->first_cell = memory_allocate(n, sizeof *o->first_cell, what, status)) &&
         (o->spans = memory_allocate(spans, sizeof *o->spans, what, status)) &&
         (o->place = memory_allocate(2 * spans, sizeof *o->place, what, status)) &&
         (o->eps = memory_allocate(cells, sizeof *o->eps, what, status)) &&
         (o->order = memory_allocate(n, sizeof *o->order, what, status)) &&
         (o->band_start = memory_allocate((size_t)o->band_count + 1, sizeof *o->band_start, what, status)) &&
         (o->bands = memory_allocate((size_t)o->band_count, sizeof *o->bands, what, status)) &&
         (o->batches = memory_allocate((size_t)o->band_count, sizeof *o->batches, what, status));
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
                           .find_pairs = scene->contact.search == SEARCH_GRID,
                           .discs = discs->count,
                           .band_count = (scene->domain.size[1] + BAND_ROWS - 1) / BAND_ROWS};
  size_t spans = 0, cells = 0;
  for (size_t i = 0; i < discs->count; i++) {
    spans += most_lines(discs->radius[i]);
    cells += most_cells(discs->radius[i]);
  }
  if (!allocate(o, spans, cells, status)) {
    occupation_destroy(o);
    return false;
  }
  spans = cells = 0;
  for (size_t i = 0; i < discs->count; i++) {
    o->order[i] = (uint32_t)i;
    o->first_span[i] = spans;
    o->first_cell[i] = cells;
    spans += most_lines(discs->radius[i]);
    cells += most_cells(discs->radius[i]);
  }
  return true;
}

void occupation_destroy(struct occupation *o)
{
  for (int k = 0; o->bands && k < o->band_count; k++) {
    free(o->bands[k].runs);
    free(o->bands[k].found);
    if (o->batches) free(o->batches[k].pairs);
    free(o->bands[k].share);
    free(o->bands[k].sums);
  }
  void *const arrays[] = {o->x,          o->y,          o->column,     o->row,   o->rows,
                          o->first_span, o->first_cell, o->spans,      o->place, o->eps,
                          o->order,      o->band_start, o->band_discs, o->bands, o->batches};
  for (size_t k = 0; k < sizeof arrays / sizeof arrays[0]; k++) free(arrays[k]);
  *o = (struct occupation){0};
}

/* Line tables of one disc at a time; a thread's own. Eight arrays of `size` elements in one block. */
struct lines {
  double *block;
  size_t capacity;
  double *column_t, *column_area, *row_t, *row_h, *row_area, *low, *high, *unused;
};

static bool lines_prepare(struct lines *l, size_t count, struct status *status)
{
  const size_t size = count + AREA_PAD;
  if (!memory_grow(&l->block, &l->capacity, 8 * size, sizeof *l->block, "a disc's lines", status)) return false;
  double **const arrays[8] = {&l->column_t, &l->column_area, &l->row_t, &l->row_h,
                              &l->row_area, &l->low,         &l->high,  &l->unused};
  for (size_t k = 0; k < 8; k++) *arrays[k] = l->block + k * size;
  return true;
}

/* Where a row's run begins and ends, and within it the cells whose corners all lie inside the disc. Columns count from
 * the one whose line lies at distance `left` from the centre. */
struct extent {
  int first, end, full, full_end;
};

static struct extent row_extent(double radius, double left, double t_low, double h_low, double t_high, double h_high)
{
  const bool across = t_low < 0 && t_high > 0; /* the widest chord lies inside this row */
  const double wide = across ? radius : fmax(h_low, h_high), narrow = fmin(h_low, h_high);
  struct extent e = {.first = (int)floor(-wide - left),
                     .end = (int)ceil(wide - left),
                     .full = (int)ceil(-narrow - left),
                     .full_end = (int)floor(narrow - left)};
  if (e.first < 0) e.first = 0; /* round-off in wide */
  if (e.full >= e.full_end || narrow <= 0) e.full = e.full_end = e.end;
  return e;
}

/* Lines are taken at their distance from the centre, computed as line - centre: the same bits wherever they are
 * needed. For a row, round-off may put the disc's right edge past column_end: hence one line more. */
static void paint_disc(struct occupation *o, size_t disc, double radius, double x, double y, struct lines *l)
{
  const int column = (int)floor(x - radius), columns = (int)ceil(x + radius) - column + 2;
  const int row = (int)floor(y - radius), rows = (int)ceil(y + radius) - row;
  o->area->lines(radius, x, column, columns, l->column_t, l->unused, l->column_area);
  o->area->lines(radius, y, row, rows + 1, l->row_t, l->row_h, l->row_area);
  o->area->corners(radius, l->row_t[0], l->row_h[0], l->row_area[0], columns, l->column_t, l->column_area, l->low);
  size_t cell = o->first_cell[disc];
  for (int r = 0; r < rows; r++) {
    struct span *span = &o->spans[o->first_span[disc] + (size_t)r];
    const struct extent e =
        row_extent(radius, l->column_t[0], l->row_t[r], l->row_h[r], l->row_t[r + 1], l->row_h[r + 1]);
    o->area->corners(radius, l->row_t[r + 1], l->row_h[r + 1], l->row_area[r + 1], columns, l->column_t, l->column_area,
                     l->high);
    o->area->cells(l->low, l->high, e.first, e.end, e.full, e.full_end, o->eps + cell);
    *span = (struct span){.first = e.first, .count = e.end - e.first, .cell = cell};
    o->place[2 * (size_t)(span - o->spans)] = o->place[2 * (size_t)(span - o->spans) + 1] = no_run;
    cell += (size_t)span->count;
    double *const swap = l->low;
    l->low = l->high;
    l->high = swap;
  }
  o->x[disc] = x;
  o->y[disc] = y;
  o->column[disc] = column;
  o->row[disc] = row;
  o->rows[disc] = rows;
}

/* Discs that moved are painted. */
static bool paint(struct occupation *o, const struct discs *discs, struct status *status)
{
  bool failed = false;
  struct lines lines = {0};
#pragma omp for schedule(dynamic, 8) nowait
  for (size_t i = 0; i < o->discs; i++) {
    if (failed || (o->painted && o->x[i] == discs->x[i] && o->y[i] == discs->y[i])) continue;
    if (lines_prepare(&lines, most_lines(discs->radius[i]) + 1, status))
      paint_disc(o, i, discs->radius[i], discs->x[i], discs->y[i], &lines);
    else
      failed = true;
  }
  free(lines.block);
  return !failed;
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

/* Calls for the bands that the disc's rows (and reach) lie in: sets first..last, unwrapped; returns false if there are
 * none. */
static bool disc_bands(const struct occupation *o, size_t disc, int *first, int *last)
{
  int low = o->row[disc] - o->reach, high = o->row[disc] + o->rows[disc] - 1 + o->reach;
  const int ny = o->size[1];
  if (!o->periodic[1]) {
    if (low < 0) low = 0;
    if (high >= ny) high = ny - 1;
    if (low > high) return false;
  }
  *first = low;
  *last = high;
  return true;
}

static int wrap(int at, int n)
{
  return at < 0 ? at + n : at >= n ? at - n : at;
}

/* Adds the disc to the count (fill = false) or to the list (fill = true) of each band that it touches, once. */
static void enter_bands(struct occupation *o, uint32_t disc, bool fill)
{
  int low, high, previous = -1, opening = -1;
  if (!disc_bands(o, disc, &low, &high)) return;
  for (int y = low; y <= high;) {
    const int row = wrap(y, o->size[1]), band = row / BAND_ROWS;
    if (band != previous && band != opening) {
      if (fill)
        o->band_discs[o->band_start[band + 1]++] = disc;
      else
        o->band_start[band + 1]++;
      if (opening < 0) opening = band;
      previous = band;
    }
    const int band_end = (band + 1) * BAND_ROWS < o->size[1] ? (band + 1) * BAND_ROWS : o->size[1];
    y += band_end - row;
  }
}

/* Lists the discs of every band, along x. The end of band k doubles as the place where the next of k + 1 is entered. */
static bool list_bands(struct occupation *o, struct status *status)
{
  memset(o->band_start, 0, ((size_t)o->band_count + 1) * sizeof *o->band_start);
  for (size_t k = 0; k < o->discs; k++) enter_bands(o, o->order[k], false);
  size_t total = 0;
  for (int b = 1; b <= o->band_count; b++) {
    const size_t count = o->band_start[b];
    o->band_start[b] = total;
    total += count;
  }
  if (!memory_grow(&o->band_discs, &o->band_discs_capacity, total, sizeof *o->band_discs, "the bands' discs", status))
    return false;
  for (size_t k = 0; k < o->discs; k++) enter_bands(o, o->order[k], true);
  return true;
}

/* The span that row k of the disc offers to the search for pairs: its own, or beyond its ends the one next to it. */
static void reach_columns(const struct occupation *o, size_t disc, int k, int *first, int *end)
{
  const struct span *spans = o->spans + o->first_span[disc];
  const int rows = o->rows[disc], reach = o->reach;
  *first = INT32_MAX;
  *end = INT32_MIN;
  for (int r = k - reach; r <= k + reach; r++) {
    if (r < 0 || r >= rows) continue;
    if (spans[r].first - reach < *first) *first = spans[r].first - reach;
    if (spans[r].first + spans[r].count + reach > *end) *end = spans[r].first + spans[r].count + reach;
  }
}

/* One piece of a run: columns moved by `shift` into the box and cut to it. False if nothing of it, nor its reach, is
 * inside. */
static bool cut_run(const struct occupation *o, struct run *run, int shift, int first, int count, int reach_first,
                    int reach_end)
{
  const int nx = o->size[0];
  const int low = first + shift < 0 ? 0 : first + shift;
  const int high = first + shift + count > nx ? nx : first + shift + count;
  const int reach_low = reach_first + shift < 0 ? 0 : reach_first + shift;
  const int reach_high = reach_end + shift > nx ? nx : reach_end + shift;
  if (reach_low >= reach_high) return false;
  const int cut = low - (first + shift);
  run->reach_first = reach_low;
  run->reach_end = reach_high;
  run->x = low < high ? low : reach_low;
  run->n = low < high ? high - low : 0;
  run->rx += cut;
  run->cell += (size_t)cut;
  return true;
}

int occupation_runs(const struct occupation *o, size_t disc, int k, struct run runs[2], int *y)
{
  int row = o->row[disc] + k;
  if (o->periodic[1])
    row = wrap(row, o->size[1]);
  else if (row < 0 || row >= o->size[1])
    return 0;
  *y = row;
  int reach_first, reach_end;
  reach_columns(o, disc, k, &reach_first, &reach_end);
  const bool own = k >= 0 && k < o->rows[disc];
  const struct span none = {.first = reach_first}, *span = own ? &o->spans[o->first_span[disc] + (size_t)k] : &none;
  const int column = o->column[disc], first = column + span->first;
  const struct run whole = {.disc = (uint32_t)disc,
                            .rx = first + 0.5 - o->x[disc],
                            .ry = o->row[disc] + k + 0.5 - o->y[disc],
                            .cell = span->cell,
                            .place = own ? 2 * (o->first_span[disc] + (size_t)k) : no_run};
  int count = 0;
  const int shifts[3] = {0, o->size[0], -o->size[0]};
  for (int s = 0; s < (o->periodic[0] ? 3 : 1) && count < 2; s++) {
    runs[count] = whole;
    runs[count].place += own ? (size_t)count : 0;
    count += cut_run(o, &runs[count], shifts[s], first, span->count, column + reach_first, column + reach_end);
  }
  return count;
}

static int run_before(const struct run *l, const struct run *r)
{
  return l->reach_first < r->reach_first || (l->reach_first == r->reach_first && l->disc < r->disc);
}

/* The runs of the band's rows, disc by disc along x, into found[]; count[k] of them in row k of the band. */
static bool find_runs(struct occupation *o, int index, size_t count[BAND_ROWS], struct status *status)
{
  struct band *band = &o->bands[index];
  const bool periodic = o->periodic[1];
  const int first_row = index * BAND_ROWS;
  const int end_row = first_row + BAND_ROWS < o->size[1] ? first_row + BAND_ROWS : o->size[1];
  const size_t most = 2 * (size_t)(end_row - first_row) + 2; /* runs of one disc: two pieces a row */
  band->run_count = 0;
  for (size_t d = o->band_start[index]; d < o->band_start[index + 1]; d++) {
    const uint32_t disc = o->band_discs[d];
    if (!memory_grow(&band->found, &band->found_capacity, band->run_count + most, sizeof *band->found, "a band's runs",
                     status))
      return false;
    for (int image = periodic ? -1 : 0; image <= (periodic ? 1 : 0); image++) {
      const int low = first_row + image * o->size[1] - o->row[disc], high = low + end_row - first_row;
      const int k_end = high < o->rows[disc] + o->reach ? high : o->rows[disc] + o->reach;
      for (int k = low > -o->reach ? low : -o->reach; k < k_end; k++) {
        int y = first_row;
        const int n = occupation_runs(o, disc, k, &band->found[band->run_count], &y);
        for (int r = 0; r < n; r++) band->found[band->run_count++].row = y - first_row;
        count[y - first_row] += (size_t)n;
      }
    }
  }
  return true;
}

/* The band's runs row by row, each row in order: nearly so already, as discs come along x. */
static bool collect_runs(struct occupation *o, int index, struct status *status)
{
  struct band *band = &o->bands[index];
  size_t count[BAND_ROWS] = {0}, next[BAND_ROWS];
  if (!find_runs(o, index, count, status)) return false;
  if (!memory_grow(&band->runs, &band->run_capacity, band->run_count, sizeof *band->runs, "a band's runs", status))
    return false;
  band->row_start[0] = 0;
  for (int k = 0; k < BAND_ROWS; k++) {
    next[k] = band->row_start[k];
    band->row_start[k + 1] = band->row_start[k] + count[k];
  }
  for (size_t f = 0; f < band->run_count; f++) {
    const struct run *run = &band->found[f];
    const size_t start = band->row_start[run->row];
    size_t at = next[run->row]++;
    for (; at > start && run_before(run, &band->runs[at - 1]); at--) band->runs[at] = band->runs[at - 1];
    band->runs[at] = *run;
  }
  return true;
}

/* Lays out the shares of a band's runs, as if each cell had one owner, and room for their sums. What a kernel writes
 * past the end of a run is overwritten by the next. */
static bool lay_out_shares(struct occupation *o, struct band *band, struct status *status)
{
  size_t cells = 0;
  for (size_t r = 0; r < band->run_count; r++) {
    band->runs[r].share = cells;
    cells += (size_t)band->runs[r].n;
  }
  if (!memory_grow(&band->share, &band->share_capacity, cells + SLACK, sizeof *band->share, "a band's shares",
                   status) ||
      !memory_grow(&band->sums, &band->sums_capacity, band->run_count, sizeof *band->sums, "a band's sums", status))
    return false;
  for (size_t r = 0; r < band->run_count; r++) {
    const struct run *run = &band->runs[r];
    if (run->n == 0) continue;
    o->place[run->place] = r;
    o->area->weights(o->eps + run->cell, run->n, o->three_nu, band->share + run->share);
  }
  return true;
}

static bool covers(const struct run *run, int x)
{
  return x >= run->x && x < run->x + run->n;
}

static size_t cell_of(const struct run *run, int x)
{
  return run->cell + (size_t)(x - run->x);
}

/* Shares a cell among its owners: runs[0], and some of those after it. */
static void share_cell(struct occupation *o, struct band *band, const struct run *runs, size_t count, int x)
{
  double total = 0;
  size_t owners = 0, end = 0;
  for (; end < count && runs[end].reach_first <= x; end++) {
    if (!covers(&runs[end], x)) continue;
    total += o->eps[cell_of(&runs[end], x)];
    owners++;
  }
  if (total <= 0) return;
  const double weight = occupation_weight(fmin(1, total), o->three_nu) / total;
  for (size_t r = 0; r < end; r++)
    if (covers(&runs[r], x))
      band->share[runs[r].share + (size_t)(x - runs[r].x)] = o->eps[cell_of(&runs[r], x)] * weight;
  band->shared_cells++;
  band->shared_owners += owners;
}

/* True if a run before runs[second], other than runs[first], covers the cell: it is then shared on their account. */
static bool shared_earlier(const struct run *row, size_t first, size_t second, int x)
{
  for (size_t r = 0; r < second; r++)
    if (r != first && covers(&row[r], x)) return true;
  return false;
}

/* Two runs whose reaches overlap: their discs are a candidate, and the cells that both cover are shared. */
static bool meet(struct occupation *o, struct band *band, const struct run *row, size_t count, size_t first,
                 size_t second, struct status *status)
{
  const struct run *l = &row[first], *r = &row[second];
  struct pair_batch *batch = &o->batches[band - o->bands];
  double area = 0;
  const int low = l->x > r->x ? l->x : r->x;
  const int high = l->x + l->n < r->x + r->n ? l->x + l->n : r->x + r->n;
  for (int x = low; x < high; x++) {
    const double eps_l = o->eps[cell_of(l, x)], eps_r = o->eps[cell_of(r, x)];
    if (eps_l > 0 && eps_r > 0) area += fmax(0, eps_l + eps_r - o->minimum);
    if (!shared_earlier(row, first, second, x)) share_cell(o, band, row + first, count - first, x);
  }
  if (l->disc == r->disc || !o->find_pairs) return true;
  if (!memory_grow(&batch->pairs, &batch->capacity, batch->count + 1, sizeof *batch->pairs, "a band's pairs", status))
    return false;
  batch->pairs[batch->count++] = (struct near_pair){
      .a = l->disc < r->disc ? l->disc : r->disc, .b = l->disc < r->disc ? r->disc : l->disc, .cells_area = area};
  return true;
}

static bool find_shared(struct occupation *o, int index, struct status *status)
{
  struct band *band = &o->bands[index];
  o->batches[index].count = band->shared_cells = band->shared_owners = 0;
  for (int k = 0; k < BAND_ROWS; k++) {
    const struct run *row = band->runs + band->row_start[k];
    const size_t count = band->row_start[k + 1] - band->row_start[k];
    for (size_t l = 0; l + 1 < count; l++)
      for (size_t r = l + 1; r < count && row[r].reach_first < row[l].reach_end; r++)
        if (!meet(o, band, row, count, l, r, status)) return false;
  }
  return true;
}

void stage_occupation(struct occupation *o, const struct discs *discs, struct team *team)
{
  struct status status;
  if (!paint(o, discs, &status)) team_fail(team, &status);
#pragma omp barrier
#pragma omp single
  {
    if (o->painted)
      sort_by_x(o);
    else if (!sort_from_scratch(o, &status))
      team_fail(team, &status);
    if (!team->failed && !list_bands(o, &status)) team_fail(team, &status);
    team->stop = team->failed;
  }
  if (team->stop) return;
#pragma omp for schedule(static)
  for (int k = 0; k < o->band_count; k++)
    if (!collect_runs(o, k, &status) || !lay_out_shares(o, &o->bands[k], &status) || !find_shared(o, k, &status))
      team_fail(team, &status);
#pragma omp single
  {
    o->painted = true;
    team->stop = team->failed;
  }
}
