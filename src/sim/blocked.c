#include "sim/blocked.h"

#include <omp.h>

int blocked_deepest(int ny, int threads)
{
  return ny / threads / 2;
}

/* Rows first .. end - 1 and what lies beyond them: nothing (a wall), or the next slab. */
struct slab {
  int first, end;
  bool open_below, open_above;
};

/* Slab `number` of `count` into which another is cut. */
static struct slab slab_of(const struct slab *whole, int number, int count)
{
  const int64_t rows = whole->end - whole->first;
  return (struct slab){.first = whole->first + (int)(rows * number / count),
                       .end = whole->first + (int)(rows * (number + 1) / count),
                       .open_below = whole->open_below || number > 0,
                       .open_above = whole->open_above || number + 1 < count};
}

/* Step s of the block in cells x0 .. x1 - 1 of row y, which may lie beyond a periodic side. */
static void update(struct flow *f, int s, int y, int x0, int x1)
{
  if (x0 >= x1) return;
  struct populations p = f->populations; /* the parity of a block's steps differs from row to row */
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

/* Step s of tile number k (of the last, if `last`) in row y. */
static void update_tile(struct flow *f, int y, int s, int k, int width, bool last)
{
  const int nx = f->populations.nx;
  const bool ring = f->scene->domain.side[SIDE_LEFT].type == SIDE_PERIODIC;
  const bool whole = k == 0 && last;       /* the tile is the row: nothing to retreat from */
  const int left = ring && !whole ? s : 0; /* where the first tile begins */
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

/* What slabs left out on both sides of the border below row `border`. */
static void sweep_border(struct flow *f, int border, int steps)
{
  for (int s = 1; s < steps; s++)
    for (int y = border - s; y < border + s; y++) update(f, s, y, 0, f->populations.nx);
}

/* A block in tiles of this width. */
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
  const bool tiled = blocking->width > 0 && blocking->width < nx && steps <= nx; /* a retreat round the box is none */
  const int whole = !tiled ? steps : flow_terms(f, steps - 1) == SWEEP_FORCE_AND_SUM;
  if (steps > whole) sweep_block(f, blocking->width, steps - whole);
  if (whole > 0) sweep_block(f, nx, whole);
}

/* Rows that may go ahead by `steps` must leave one slab twice as high. */
static bool is_high_enough(int rows, int steps)
{
  return rows >= 2 * steps;
}

/* The rows of all discs and `margin` more on each side. Across a periodic side they are counted on from the first disc,
 * which is sensible as long as they span less than half of the box. */
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

bool blocked_near(const struct scene *scene, const struct occupation *now, int steps, struct near_rows *near)
{
  const int ny = scene->domain.size[1];
  *near = (struct near_rows){.rows = rows_of_discs(scene, now, 3), .grow_below = true, .grow_above = true};
  if (scene_is_periodic(scene, 1)) return near->rows.end - near->rows.first + 4 * steps <= ny / 2;
  near->grow_below = is_high_enough(near->rows.first, steps);
  near->grow_above = is_high_enough(ny - near->rows.end, steps);
  if (!near->grow_below) near->rows.first = 0;
  if (!near->grow_above) near->rows.end = ny;
  return near->grow_below || near->grow_above;
}

struct rows blocked_near_at(const struct near_rows *near, int s)
{
  return (struct rows){near->rows.first - (near->grow_below ? s : 0), near->rows.end + (near->grow_above ? s : 0)};
}

bool blocked_discs_within(const struct scene *scene, const struct occupation *o, const struct rows *rows)
{
  const int ny = scene->domain.size[1];
  const struct rows discs = rows_of_discs(scene, o, 1);
  int shift = 0; /* both may be counted from either side of a periodic one */
  if (scene_is_periodic(scene, 1)) shift = discs.first < rows->first ? ny : discs.end > rows->end ? -ny : 0;
  const bool below = discs.first + shift >= rows->first || (rows->first == 0 && !scene_is_periodic(scene, 1));
  const bool above = discs.end + shift <= rows->end || (rows->end == ny && !scene_is_periodic(scene, 1));
  return below && above;
}

/* The slabs of one interval of rows; whoever has one. */
static void sweep_interval(struct flow *f, const struct slab *interval, int steps)
{
  const int threads = omp_get_num_threads(), thread = omp_get_thread_num();
  const int most = (interval->end - interval->first) / (2 * steps), count = most < threads ? most : threads;
  struct slab slab = {0};
  if (thread < count) {
    slab = slab_of(interval, thread, count);
    sweep_slab(f, &slab, f->populations.nx, steps);
  }
#pragma omp barrier
  if (thread < count && thread > 0) sweep_border(f, slab.first, steps);
#pragma omp barrier
}

void stage_sweep_ahead(struct flow *f, const struct near_rows *near, int steps)
{
  const int ny = f->populations.ny, first = near->rows.first, end = near->rows.end;
  if (f->populations.periodic_y) {
    sweep_interval(f, &(struct slab){end, first + ny, .open_below = true, .open_above = true}, steps);
    return;
  }
  if (near->grow_below) sweep_interval(f, &(struct slab){0, first, .open_above = true}, steps);
  if (near->grow_above) sweep_interval(f, &(struct slab){end, ny, .open_below = true}, steps);
}
