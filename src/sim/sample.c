#include "sim/sample.h"

#include "base/memory.h"
#include "base/threads.h"
#include "fluid/vorticity.h"
#include "sim/diagnostics.h"
#include "solid/occupation.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>

struct sample_grid sample_grid_of(const struct scene *scene)
{
  const double *region = scene->output.fields.region;
  struct sample_grid grid = {.stride = scene->output.fields.stride};
  for (int axis = 0; axis < 2; axis++) {
    grid.first[axis] = (int)region[axis];
    grid.count[axis] = ((int)region[axis + 2] - grid.first[axis] + grid.stride - 1) / grid.stride;
  }
  return grid;
}

/* What is sampled and where it goes. */
struct sampling {
  const struct populations *populations;
  const struct fluid_force *force;
  const struct occupation *occupation;
  const struct sample_grid *grid;
  const struct sample *sample;
  bool periodic[2];
};

/* Buffers of one thread, of nx each: density and velocity of a row, ux of the rows beside it, what covers it, how much
 * that gives, and how many discs it is. */
struct rows {
  double *rho, *ux, *uy, *below, *above, *covered, *give, *owners;
};

/* The shares of a cell add up to its weight B: from that, backwards to eps. */
static void cover_row(const struct occupation *o, int y, const struct rows *rows, int nx)
{
  size_t count = 0;
  const struct run *runs = o ? occupation_row(o, y, &count) : NULL;
  double *covered = rows->covered, *give = rows->give, *owners = rows->owners;
  for (int x = 0; x < nx; x++) covered[x] = give[x] = owners[x] = 0;
  for (const struct run *run = runs; run < runs + count; run++)
    for (int k = 0; k < run->n; k++) {
      const int x = run->x + k;
      const double share = occupation_band(o, y)->share[run->share + (uint32_t)k];
      covered[x] += share;
      give[x] = fmax(give[x], o->give[run->disc]);
      owners[x] += share > 0;
    }
  for (int x = 0; count > 0 && x < nx; x++) {
    const bool between = owners[x] > 1 || occupation_at_side(o, x, y);
    covered[x] = fmin(1, weight_fraction(occupation_law(o, give[x], between), covered[x]));
  }
}

static void sample_row(const struct sampling *s, const struct rows *rows, int row)
{
  const struct populations *p = s->populations;
  const int y = s->grid->first[1] + row * s->grid->stride;
  const struct stencil v = stencil_at(y, p->ny, s->periodic[1]);
  diagnostics_row(p, s->force, y, rows->rho, rows->ux, rows->uy);
  diagnostics_row(p, s->force, v.low, NULL, rows->below, NULL);
  diagnostics_row(p, s->force, v.high, NULL, rows->above, NULL);
  cover_row(s->occupation, y, rows, p->nx);
  for (int k = 0; k < s->grid->count[0]; k++) {
    const int x = s->grid->first[0] + k * s->grid->stride;
    const size_t at = (size_t)row * (size_t)s->grid->count[0] + (size_t)k;
    const struct stencil h = stencil_at(x, p->nx, s->periodic[0]);
    const struct sample *to = s->sample;
    if (to->rho) to->rho[at] = rows->rho[x];
    if (to->velocity)
      to->velocity[3 * at] = rows->ux[x], to->velocity[3 * at + 1] = rows->uy[x], to->velocity[3 * at + 2] = 0;
    if (to->vorticity)
      to->vorticity[at] =
          stencil_slope(&h, rows->uy[h.low], rows->uy[h.high]) - stencil_slope(&v, rows->below[x], rows->above[x]);
    if (to->pressure) to->pressure[at] = (rows->rho[x] - 1) / 3;
    if (to->occupation) to->occupation[at] = rows->covered[x];
  }
}

bool sample_take(const struct populations *p, const bool periodic[2], const struct fluid_force *force,
                 const struct occupation *occupation, const struct sample_grid *grid, const struct sample *sample,
                 struct status *status)
{
  enum { BUFFERS = 8 };
  const struct sampling sampling = {p, force, occupation, grid, sample, {periodic[0], periodic[1]}};
  const int threads = threads_for((int64_t)p->nx * p->ny);
  const size_t nx = (size_t)p->nx;
  double *buffers = memory_allocate((size_t)threads * BUFFERS, nx * sizeof *buffers, "rows of fields", status);
  if (!buffers) return false;
#pragma omp parallel num_threads(threads)
  {
    double *own = buffers + (size_t)omp_get_thread_num() * BUFFERS * nx;
    const struct rows rows = {own,          own + nx,     own + 2 * nx, own + 3 * nx,
                              own + 4 * nx, own + 5 * nx, own + 6 * nx, own + 7 * nx};
#pragma omp for schedule(static)
    for (int row = 0; row < grid->count[1]; row++) sample_row(&sampling, &rows, row);
  }
  free(buffers);
  return true;
}
