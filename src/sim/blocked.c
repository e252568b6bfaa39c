/* The sweep blocked in time: several steps of a row in one pass through memory.
 *
 * Wavefront. A row may advance to step s once the row and its two neighbours have completed step s - 1
 * (populations.h: a step touches rows y - 1 .. y + 1 only). A wavefront passes over the rows with each step one row
 * behind the step before, so a row is read from memory once per block of `depth` steps.
 *
 * Tiles. Rows are divided into tiles of `width` cells, each step shifted by one cell to the left of the step before,
 * so that the working set of a wavefront, depth + 2 rows of a tile, fits the nearest cache. With periodic x the
 * first tile recedes from the left side by a cell each step, and the last tile also updates these first cells.
 *
 * Slabs. Each thread has a slab of rows. Within a block a slab recedes by a row each step from adjacent slabs (not
 * from walls); after a barrier, the missing triangle around each border, which grows by a row on both sides each
 * step, is swept. With ny/threads >= 2 depth rows the triangles do not overlap.
 *
 * Races. Between two barriers a thread writes rows of its own slab or triangle; the dependence of a step on the step
 * before in neighbouring rows is satisfied within the slab, or by the barrier. Each row has its own parity within a
 * block. Every row is updated once per step, by the arithmetic of the unblocked sweep: the bits are independent of
 * depth, width and threads.
 *
 * Discs. The rows of discs and three more on each side (the disc rows) are excluded; the other rows (the free rows)
 * advance through the whole block first and recede from the disc rows by a row each step, as slabs do from each
 * other. Then the disc rows are swept step by step, in all four stages, and grow by a row each step. Discs below
 * Mach 0.6 move by at most 0.35 rows a step and so remain within the disc rows. */
#include "sim/blocked.h"

#include <omp.h>

int blocked_max_depth(int ny, int threads)
{
  return ny / threads / 2;
}

/* Rows first .. end - 1; open: adjacent to another slab, else to a wall. */
struct slab {
  int first, end;
  bool open_below, open_above;
};

/* Slab `number` of `count` equal parts of `whole`. */
static struct slab slab_of(const struct slab *whole, int number, int count)
{
  const int64_t rows = whole->end - whole->first;
  return (struct slab){.first = whole->first + (int)(rows * number / count),
                       .end = whole->first + (int)(rows * (number + 1) / count),
                       .open_below = whole->open_below || number > 0,
                       .open_above = whole->open_above || number + 1 < count};
}

/* Step s of the block in cells x0 .. x1 - 1 of row y; y may lie beyond a periodic side. */
static void update(struct flow *f, int s, int y, int x0, int x1)
{
  if (x0 >= x1) return;
  struct populations p = f->populations; /* with the parity of step s */
  p.parity ^= s & 1;
  y = populations_row(&p, y);
  void *a[Q];
  populations_cells(&p, x0, y, a);
  f->kernel->fluid[f->adaptive][flow_terms(f, s)](a, x1 - x0, &f->constants, NULL,
                                                  f->row_momentum ? f->row_momentum[y] : NULL);
  boundary_after(&f->boundary, &p, y, x0, x1);
}

static int clamp(int at, int low, int high)
{
  return at < low ? low : at > high ? high : at;
}

/* Step s of tile k in row y; `last`: the tile is the last of the row. */
static void update_tile(struct flow *f, int y, int s, int k, int width, bool last)
{
  const int nx = f->populations.nx;
  const bool ring = f->scene->domain.side[SIDE_LEFT].type == SIDE_PERIODIC;
  const bool whole = k == 0 && last;       /* one tile: the row is not divided */
  const int left = ring && !whole ? s : 0; /* start of the first tile */
  const int x0 = k == 0 ? left : clamp(k * width - s, left, nx);
  const int x1 = last ? nx : clamp((k + 1) * width - s, left, nx);
  update(f, s, y, x0, x1);
  if (left > 0 && last) update(f, s, y, 0, left);
}

/* A wavefront over the slab, tile by tile. */
static void sweep_slab(struct flow *f, const struct slab *slab, int width, int steps)
{
  const int tiles = (f->populations.nx + width - 1) / width;
  for (int k = 0; k < tiles; k++)
    for (int front = slab->first; front < slab->end + steps; front++)
      for (int s = 0; s < steps; s++) {
        const int y = front - s;
        const int low = slab->first + (slab->open_below ? s : 0), high = slab->end - (slab->open_above ? s : 0);
        if (y >= low && y < high) update_tile(f, y, s, k, width, k == tiles - 1);
      }
}

/* The triangle around the border below row `border`. */
static void sweep_border(struct flow *f, int border, int steps)
{
  for (int s = 1; s < steps; s++)
    for (int y = border - s; y < border + s; y++) update(f, s, y, 0, f->populations.nx);
}

/* One block, in tiles of `width`. */
static void sweep_block(struct flow *f, int width, int steps)
{
  const int ny = f->populations.ny;
  const bool ring = f->populations.periodic_y;
  const struct slab box = {.end = ny, .open_below = ring, .open_above = ring};
  const struct slab slab = slab_of(&box, omp_get_thread_num(), omp_get_num_threads());
  sweep_slab(f, &slab, width, steps);
#pragma omp barrier
  if (slab.open_below) sweep_border(f, slab.first, steps);
#pragma omp barrier
#pragma omp single
  flow_advance(f, steps);
}

void stage_sweep_blocked(struct flow *f, const struct blocking *blocking, int steps)
{
  const int nx = f->populations.nx;
  const bool tiled =
      blocking->width > 0 && blocking->width < nx && steps <= nx; /* a tile recedes by at most nx cells */
  const int whole = !tiled ? steps : flow_terms(f, steps - 1) == SWEEP_FORCE_AND_SUM;
  if (steps > whole) sweep_block(f, blocking->width, steps - whole);
  if (whole > 0) sweep_block(f, nx, whole);
}

/* Free rows must contain one slab of 2 steps rows. */
static bool is_high_enough(int rows, int steps)
{
  return rows >= 2 * steps;
}

/* The rows of all discs and `margin` more on each side. Across a periodic side the numbers continue from the first
 * disc; valid for a span below half of the box. */
static struct rows rows_of_discs(const struct scene *scene, const struct occupation *o, int margin)
{
  const int ny = scene->domain.size[1], half = ny / 2;
  struct rows rows = {o->row[0], o->row[0] + o->rows[0]};
  for (size_t i = 1; i < o->discs; i++) {
    int first = o->row[i];
    if (scene_is_periodic(scene, 1)) first += first - o->row[0] > half ? -ny : first - o->row[0] < -half ? ny : 0;
    if (first < rows.first) rows.first = first;
    if (first + o->rows[i] > rows.end) rows.end = first + o->rows[i];
  }
  return (struct rows){rows.first - margin, rows.end + margin};
}

bool disc_rows_find(const struct scene *scene, const struct occupation *now, int steps, struct disc_rows *r)
{
  const int ny = scene->domain.size[1];
  *r = (struct disc_rows){.rows = rows_of_discs(scene, now, 3), .grow_below = true, .grow_above = true};
  if (scene_is_periodic(scene, 1)) return r->rows.end - r->rows.first + 4 * steps <= ny / 2;
  r->grow_below = is_high_enough(r->rows.first, steps);
  r->grow_above = is_high_enough(ny - r->rows.end, steps);
  if (!r->grow_below) r->rows.first = 0;
  if (!r->grow_above) r->rows.end = ny;
  return r->grow_below || r->grow_above;
}

struct rows disc_rows_at(const struct disc_rows *r, int s)
{
  return (struct rows){r->rows.first - (r->grow_below ? s : 0), r->rows.end + (r->grow_above ? s : 0)};
}

bool rows_contain_discs(const struct scene *scene, const struct occupation *o, const struct rows *rows)
{
  const int ny = scene->domain.size[1];
  const struct rows discs = rows_of_discs(scene, o, 1);
  int shift = 0; /* across a periodic side the numbers may differ by ny */
  if (scene_is_periodic(scene, 1)) shift = discs.first < rows->first ? ny : discs.end > rows->end ? -ny : 0;
  const bool below = discs.first + shift >= rows->first || (rows->first == 0 && !scene_is_periodic(scene, 1));
  const bool above = discs.end + shift <= rows->end || (rows->end == ny && !scene_is_periodic(scene, 1));
  return below && above;
}

/* Sweeps an interval of free rows, in slabs of at least 2 steps rows, at most one per thread. */
static void sweep_interval(struct flow *f, const struct slab *interval, int steps)
{
  const int threads = omp_get_num_threads(), thread = omp_get_thread_num();
  const int max = (interval->end - interval->first) / (2 * steps), count = max < threads ? max : threads;
  struct slab slab = {0};
  if (thread < count) {
    slab = slab_of(interval, thread, count);
    sweep_slab(f, &slab, f->populations.nx, steps);
  }
#pragma omp barrier
  if (thread < count && thread > 0) sweep_border(f, slab.first, steps);
#pragma omp barrier
}

void stage_sweep_free_rows(struct flow *f, const struct disc_rows *r, int steps)
{
  const int ny = f->populations.ny, first = r->rows.first, end = r->rows.end;
  if (f->populations.periodic_y) {
    sweep_interval(f, &(struct slab){end, first + ny, .open_below = true, .open_above = true}, steps);
    return;
  }
  if (r->grow_below) sweep_interval(f, &(struct slab){0, first, .open_above = true}, steps);
  if (r->grow_above) sweep_interval(f, &(struct slab){end, ny, .open_below = true}, steps);
}
