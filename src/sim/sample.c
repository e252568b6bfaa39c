/* Each thread samples whole rows of the grid with its own buffers: density and velocity of row y, ux of the rows beside
 * it for the vorticity d(uy)/dx - d(ux)/dy (central differences, vorticity.h), and the total occupation fraction of the
 * discs. Rows of the destination arrays are disjoint: no race, and the same bits for any number of threads. */
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

/* Source and destination of the samples. */
struct sampling {
  const struct populations *populations;
  const struct fluid_force *force;
  const struct occupation *occupation;
  const struct discs *discs;
  const struct sample_grid *grid;
  const struct sample *sample;
  bool periodic[2];
};

/* Buffers of one thread: density and velocity of a row, ux of the rows below and above, total occupation fraction,
 * nx each; occupation fractions of one disc (widest_row). */
struct sample_rows {
  double *rho, *ux, *uy, *below, *above, *fraction, *disc;
};

static void sample_row(const struct sampling *s, const struct sample_rows *rows, int row)
{
  const struct populations *p = s->populations;
  const int y = s->grid->first[1] + row * s->grid->stride;
  const struct stencil v = stencil_at(y, p->ny, s->periodic[1]);
  diagnostics_row(p, s->force, y, rows->rho, rows->ux, rows->uy);
  diagnostics_row(p, s->force, v.low, NULL, rows->below, NULL);
  diagnostics_row(p, s->force, v.high, NULL, rows->above, NULL);
  if (s->occupation && s->sample->occupation)
    occupation_fractions(s->occupation, s->discs, y, rows->fraction, rows->disc);
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
    if (to->occupation) to->occupation[at] = rows->fraction[x];
  }
}

/* Upper bound of the cells of a disc in a row, with padding (occupation_fractions). */
static size_t widest_row(const struct discs *discs)
{
  double radius = 0;
  for (size_t i = 0; i < discs->count; i++) radius = fmax(radius, discs->hydraulic[i].radius);
  return (size_t)ceil(2 * radius) + 2 + SHAPE_PAD;
}

bool sample_take(const struct populations *p, const bool periodic[2], const struct fluid_force *force,
                 const struct occupation *occupation, const struct discs *discs, const struct sample_grid *grid,
                 const struct sample *sample, struct status *status)
{
  enum { ROWS = 6 };
  const struct sampling sampling = {p, force, occupation, discs, grid, sample, {periodic[0], periodic[1]}};
  const int threads = threads_for((int64_t)p->nx * p->ny);
  const size_t nx = (size_t)p->nx, each = ROWS * nx + (occupation ? widest_row(discs) : 0);
  double *buffers = memory_allocate((size_t)threads, each * sizeof *buffers, "rows of fields", status);
  if (!buffers) return false;
#pragma omp parallel num_threads(threads)
  {
    double *own = buffers + (size_t)omp_get_thread_num() * each;
    const struct sample_rows rows = {own,          own + nx,     own + 2 * nx, own + 3 * nx,
                                     own + 4 * nx, own + 5 * nx, own + 6 * nx};
#pragma omp for schedule(static)
    for (int row = 0; row < grid->count[1]; row++) sample_row(&sampling, &rows, row);
  }
  free(buffers);
  return true;
}
