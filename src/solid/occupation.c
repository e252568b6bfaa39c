/* A shape is convex, so that a disc has one run of cells in each row, or two where a periodic side divides it. Memory
 * is proportional to the number of owned cells, not to the box: the rows are divided into bands of BAND_ROWS, and a
 * band stores the runs of its rows, row by row and by first cell, and the owner weights of their cells in the same
 * order. The sweep thus reads both arrays once, front to back. Occupation fractions eps are intermediate: they exist
 * for one band at a time, in scratch memory that stays in cache (band.h).
 *
 * A call has three passes:
 *
 *   1. locate        per disc, in parallel: pose, damping, rows and columns; `moved` if one of pose and damping differs.
 *   2. list_bands    one thread: the discs of each band in the order of x, and which bands have changed. A
 *                    band without a change is not painted again.
 *   3. band_paint    per changed band, in parallel: runs, eps, and owner weights B(eps) as if each cell had one owner.
 *      band_share    corrects the cells with several owners: B(min(1, sum eps_p)) and w_p = eps_p/sum eps (22).
 *
 * eps is computed from line tables (disc_kernel.c), in wide discs for the cells of the rim only. The chords of the two
 * lines of a row bound the rim, so that no list of boundary cells is stored between steps (the modified Verlet list of
 * the paper).
 *
 * No races: pass 1 writes arrays of its disc, and pass 3 writes the band and, of each disc in the band, the entries of
 * run_index[] of its rows in the band. Orders (discs along x, runs in a row, owners of a cell) are by position, then by
 * index. */
#include "solid/occupation.h"

#include "base/memory.h"
#include "solid/band.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* Upper bound of the number of rows, and of columns, of a disc. */
static size_t max_lines(double radius)
{
  return (size_t)ceil(2 * radius) + 2;
}

static bool allocate(struct occupation *o, size_t rows, struct status *status)
{
  const char *what = "the occupation tables";
  const size_t n = o->discs, bands = (size_t)o->band_count;
  return (o->x = memory_allocate(n, sizeof *o->x, what, status)) &&
         (o->y = memory_allocate(n, sizeof *o->y, what, status)) &&
         (o->angle = memory_allocate(n, sizeof *o->angle, what, status)) &&
         (o->damping = memory_allocate(n, sizeof *o->damping, what, status)) &&
         (o->column = memory_allocate(n, sizeof *o->column, what, status)) &&
         (o->row = memory_allocate(n, sizeof *o->row, what, status)) &&
         (o->rows = memory_allocate(n, sizeof *o->rows, what, status)) &&
         (o->moved = memory_allocate(n, sizeof *o->moved, what, status)) &&
         (o->old_row = memory_allocate(n, sizeof *o->old_row, what, status)) &&
         (o->old_rows = memory_allocate(n, sizeof *o->old_rows, what, status)) &&
         (o->first_row = memory_allocate(n, sizeof *o->first_row, what, status)) &&
         (o->run_index = memory_allocate(2 * rows, sizeof *o->run_index, what, status)) &&
         (o->order = memory_allocate(n, sizeof *o->order, what, status)) &&
         (o->band_start = memory_allocate(bands + 1, sizeof *o->band_start, what, status)) &&
         (o->changed = memory_allocate(bands, sizeof *o->changed, what, status)) &&
         (o->bands = memory_allocate(bands, sizeof *o->bands, what, status));
}

bool occupation_create(struct occupation *o, const struct scene *scene, const struct discs *discs,
                       struct status *status)
{
  *o = (struct occupation){.size = {scene->domain.size[0], scene->domain.size[1]},
                           .periodic = {scene_is_periodic(scene, 0), scene_is_periodic(scene, 1)},
                           .form = scene->coupling.form,
                           .viscosity = scene->fluid.viscosity,
                           .kernel = solid_kernel_find(scene->fluid.kernel),
                           .discs = discs->count,
                           .band_count = (scene->domain.size[1] + BAND_ROWS - 1) / BAND_ROWS};
  size_t rows = 0;
  for (size_t i = 0; i < discs->count; i++) rows += max_lines(discs->hydraulic[i].radius);
  if (!allocate(o, rows, status)) {
    occupation_destroy(o);
    return false;
  }
  rows = 0;
  for (size_t i = 0; i < discs->count; i++) {
    o->order[i] = (uint32_t)i;
    o->first_row[i] = rows;
    rows += max_lines(discs->hydraulic[i].radius);
  }
  return true;
}

void occupation_destroy(struct occupation *o)
{
  for (int k = 0; o->bands && k < o->band_count; k++) {
    free(o->bands[k].runs);
    free(o->bands[k].owner_weight);
    free(o->bands[k].sums);
  }
  for (size_t t = 0; t < o->draft_count; t++) {
    free(o->drafts[t].runs);
    free(o->drafts[t].eps);
  }
  void *const arrays[] = {o->x,     o->y,          o->angle,      o->damping,  o->column,    o->row,
                          o->rows,  o->moved,      o->old_row,    o->old_rows, o->first_row, o->run_index,
                          o->order, o->band_start, o->band_discs, o->changed,  o->bands,     o->drafts};
  for (size_t k = 0; k < sizeof arrays / sizeof arrays[0]; k++) free(arrays[k]);
  *o = (struct occupation){0};
}

/* Updates pose, damping and rows of disc i. Rows beyond walls lie in no band: their entries remain no_run. */
static void locate(struct occupation *o, const struct discs *discs, size_t i)
{
  const struct shape *shape = &discs->hydraulic[i];
  const struct shape_kind *kind = shape->kind;
  const struct pose pose = discs_pose(discs, i);
  const double damping = weight_damping(o->form, o->viscosity, shape->radius * discs->omega[i]);
  const bool same_cells = o->x[i] == pose.x && o->y[i] == pose.y && (kind->round || o->angle[i] == pose.angle);
  o->moved[i] = !(o->painted && same_cells && o->damping[i] == damping);
  if (!o->moved[i]) return;
  const struct shape_box box = kind->box(shape, &pose);
  o->old_row[i] = o->row[i];
  o->old_rows[i] = o->rows[i];
  o->x[i] = pose.x;
  o->y[i] = pose.y;
  o->angle[i] = pose.angle;
  o->damping[i] = damping;
  o->column[i] = box.column;
  o->row[i] = box.row;
  o->rows[i] = box.rows;
  for (size_t k = 0; k < 2 * (size_t)o->rows[i]; k++) o->run_index[2 * o->first_row[i] + k] = no_run;
}

/* Insertion sort: between steps the order changes in few places. */
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

/* Iterator over the bands of rows y .. high, from the lowest; a periodic box may reach the first one again. */
struct band_walk {
  int y, high, first, previous;
};

static struct band_walk walk_bands(const struct occupation *o, int row, int rows)
{
  struct band_walk walk = {.y = row, .high = row + rows - 1, .first = -1, .previous = -1};
  const int ny = o->size[1];
  if (!o->periodic[1]) {
    if (walk.y < 0) walk.y = 0;
    if (walk.high >= ny) walk.high = ny - 1;
  }
  return walk;
}

/* The next band, or -1 after the last. */
static int next_band(const struct occupation *o, struct band_walk *walk)
{
  while (walk->y <= walk->high) {
    const int row = band_wrap(walk->y, o->size[1]), band = row / BAND_ROWS;
    const int band_end = (band + 1) * BAND_ROWS < o->size[1] ? (band + 1) * BAND_ROWS : o->size[1];
    walk->y += band_end - row;
    if (band == walk->previous || band == walk->first) continue;
    if (walk->first < 0) walk->first = band;
    walk->previous = band;
    return band;
  }
  return -1;
}

/* Marks the bands that contain, or contained, a disc that has moved. False if there is none. */
static bool mark_changed(struct occupation *o)
{
  bool any = !o->painted;
  memset(o->changed, any, (size_t)o->band_count);
  for (size_t i = 0; i < o->discs && o->painted; i++) {
    if (!o->moved[i]) continue;
    struct band_walk old = walk_bands(o, o->old_row[i], o->old_rows[i]), new = walk_bands(o, o->row[i], o->rows[i]);
    for (int band; (band = next_band(o, &old)) >= 0; any = true) o->changed[band] = 1;
    for (int band; (band = next_band(o, &new)) >= 0; any = true) o->changed[band] = 1;
  }
  return any;
}

/* Counting sort of the discs by band, in the order of x within a band. While discs are inserted, band_start[k + 1] is
 * the end of the list of band k so far. */
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

/* Pass 2, and scratch memory for all threads. */
static bool prepare_bands(struct occupation *o, struct status *status)
{
  const size_t threads = (size_t)omp_get_num_threads();
  size_t capacity = o->draft_count;
  if (!mark_changed(o)) return true;
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
  for (size_t i = 0; i < o->discs; i++) locate(o, discs, i);
#pragma omp single
  {
    if (!prepare_bands(o, &status)) team_fail(team, &status);
    team_decide(team, &o->leave_unlisted);
  }
  if (o->leave_unlisted) return false;
#pragma omp for schedule(static)
  for (int k = 0; k < o->band_count; k++) {
    struct band_draft *draft = &o->drafts[omp_get_thread_num()];
    if (!o->changed[k]) continue;
    if (band_paint(o, k, discs, draft, &status))
      band_share(o, k, draft);
    else
      team_fail(team, &status);
  }
#pragma omp single
  {
    o->painted = true;
    team_decide(team, &o->leave_unpainted);
  }
  return !o->leave_unpainted;
}

/* Adds the occupation fractions of a run, computed for its row before wrapping and cutting. */
static void add_fractions(const struct occupation *o, const struct discs *discs, const struct run *run, double *eps,
                          double *scratch)
{
  const struct shape *shape = &discs->hydraulic[run->owner];
  const struct pose pose = discs_pose(discs, run->owner);
  const int row = (int)lround(run->ry + pose.y - 0.5), column = (int)lround(run->rx + pose.x - 0.5);
  struct row_extents e;
  shape->kind->extents(shape, &pose, row, 1, &e);
  shape->kind->fractions(shape, &pose, row, 0, 1, &e, scratch);
  const double *from = scratch + (column - o->column[run->owner] - e.first[0]);
  for (int k = 0; k < run->n; k++) eps[run->x + k] = fmin(1, eps[run->x + k] + from[k]);
}

void occupation_fractions(const struct occupation *o, const struct discs *discs, int y, double *eps, double *scratch)
{
  size_t count;
  const struct run *runs = occupation_row(o, y, &count);
  memset(eps, 0, (size_t)o->size[0] * sizeof *eps);
  for (size_t r = 0; r < count; r++)
    if (runs[r].n > 0) add_fractions(o, discs, &runs[r], eps, scratch);
}
