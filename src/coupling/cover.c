#include "coupling/cover.h"

#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

bool cover_create(struct cover *cover, int nx, enum precision precision, struct status *status)
{
  const size_t size = precision == PRECISION_DOUBLE ? sizeof(double) : sizeof(float);
  *cover = (struct cover){.precision = precision};
  if ((cover->row.b = memory_allocate((size_t)nx, size, "a row's cover", status)) &&
      (cover->row.bvx = memory_allocate((size_t)nx, size, "a row's cover", status)) &&
      (cover->row.bvy = memory_allocate((size_t)nx, size, "a row's cover", status)))
    return true;
  cover_destroy(cover);
  return false;
}

void cover_destroy(struct cover *cover)
{
  free(cover->row.b);
  free(cover->row.bvx);
  free(cover->row.bvy);
  cover->row = (struct row_cover){0};
}

static void paint_double(const struct row_cover *row, const struct run *run, const double *share,
                         const struct surface_velocity *v)
{
  double *restrict b = (double *)row->b + run->x, *restrict bvx = (double *)row->bvx + run->x;
  double *restrict bvy = (double *)row->bvy + run->x;
  const double vx = v->vx - v->omega * run->ry;
  for (int k = 0; k < run->n; k++) {
    b[k] += share[k];
    bvx[k] += share[k] * vx;
    bvy[k] += share[k] * (v->vy + v->omega * (run->rx + k));
  }
}

static void paint_single(const struct row_cover *row, const struct run *run, const double *share,
                         const struct surface_velocity *v)
{
  float *restrict b = (float *)row->b + run->x, *restrict bvx = (float *)row->bvx + run->x;
  float *restrict bvy = (float *)row->bvy + run->x;
  const double vx = v->vx - v->omega * run->ry;
  for (int k = 0; k < run->n; k++) {
    b[k] += (float)share[k];
    bvx[k] += (float)(share[k] * vx);
    bvy[k] += (float)(share[k] * (v->vy + v->omega * (run->rx + k)));
  }
}

void cover_paint(struct cover *cover, const struct run *runs, size_t count, const double *share,
                 const struct surface_velocity *surface)
{
  for (size_t r = 0; r < count; r++) {
    const struct run *run = &runs[r];
    if (cover->precision == PRECISION_DOUBLE)
      paint_double(&cover->row, run, share + run->cell, &surface[run->disc]);
    else
      paint_single(&cover->row, run, share + run->cell, &surface[run->disc]);
  }
}

void cover_clear(struct cover *cover, const struct run *runs, size_t count)
{
  const size_t size = cover->precision == PRECISION_DOUBLE ? sizeof(double) : sizeof(float);
  void *const buffers[3] = {cover->row.b, cover->row.bvx, cover->row.bvy};
  for (size_t r = 0; r < count; r++)
    for (int k = 0; k < 3; k++) memset((char *)buffers[k] + (size_t)runs[r].x * size, 0, (size_t)runs[r].n * size);
}
