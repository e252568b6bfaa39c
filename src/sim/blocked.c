#include "sim/blocked.h"

#include "fluid/boundary.h"

#include <omp.h>

bool blocked_possible(const struct scene *scene)
{
  return scene->particles.count == 0 && !scene->fluid.zero_flux && !boundary_fill_first(scene->domain.side);
}

int blocked_deepest(int ny, int threads)
{
  return ny / threads / 2;
}

/* Rows first .. end - 1 and what lies beyond them: nothing (a wall), or the next slab. */
struct slab {
  int first, end;
  bool open_below, open_above;
};

static struct slab slab_of(const struct flow *f, int thread, int threads)
{
  const int64_t ny = f->populations.ny;
  const bool ring = f->populations.periodic_y;
  return (struct slab){.first = (int)(ny * thread / threads),
                       .end = (int)(ny * (thread + 1) / threads),
                       .open_below = ring || thread > 0,
                       .open_above = ring || thread + 1 < threads};
}

/* Cells x0 .. x1 - 1 of row y, one step of the given parity. */
static void update(const struct flow *f, int parity, int y, int x0, int x1)
{
  if (x0 >= x1) return;
  struct populations p = f->populations; /* the parity of a block's steps differs from row to row */
  p.parity = parity;
  void *a[Q];
  double momentum[2];
  if (parity) boundary_before(&p, f->scene->domain.side, y, x0, x1);
  populations_cells(&p, x0, y, a);
  f->kernel->fluid[f->force](a, x1 - x0, &f->constants, NULL, momentum);
  if (parity) boundary_after(&p, f->scene->domain.side, y, x0, x1);
}

static int clamp(int at, int low, int high)
{
  return at < low ? low : at > high ? high : at;
}

/* Step s of tile number k (of the last, if `last`) in row y. */
static void update_tile(const struct flow *f, int y, int s, int k, int width, bool last)
{
  const int nx = f->populations.nx, parity = f->populations.parity ^ (s & 1);
  const bool ring = f->scene->domain.side[SIDE_LEFT].type == SIDE_PERIODIC;
  const int left = ring ? s : 0; /* where the first tile begins */
  const int x0 = k == 0 ? left : clamp(k * width - s, left, nx);
  const int x1 = last ? nx : clamp((k + 1) * width - s, left, nx);
  update(f, parity, y, x0, x1);
  if (last && ring) update(f, parity, y, 0, left);
}

/* A wavefront over the slab, tile by tile. */
static void sweep_slab(const struct flow *f, const struct slab *slab, int width, int steps)
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
static void sweep_border(const struct flow *f, int border, int steps)
{
  const int ny = f->populations.ny, nx = f->populations.nx;
  for (int s = 1; s < steps; s++)
    for (int y = border - s; y < border + s; y++) update(f, f->populations.parity ^ (s & 1), (y + ny) % ny, 0, nx);
}

void stage_sweep_blocked(struct flow *f, const struct blocking *blocking, int steps)
{
  const int threads = omp_get_num_threads(), thread = omp_get_thread_num();
  const struct slab slab = slab_of(f, thread, threads);
  const int nx = f->populations.nx;
  const int width = blocking->width > 0 && blocking->width < nx ? blocking->width : nx;
  sweep_slab(f, &slab, width, steps);
#pragma omp barrier
  if (slab.open_below) sweep_border(f, slab.first, steps);
#pragma omp barrier
#pragma omp single
  f->populations.parity ^= steps & 1;
}
