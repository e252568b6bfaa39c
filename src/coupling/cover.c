#include "coupling/cover.h"

#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

enum { SLACK = 8 }; /* elements past the row that a kernel may touch */

bool cover_create(struct cover *cover, int nx, const struct sweep_kernel *kernel, struct status *status)
{
  const size_t size = kernel->precision == PRECISION_DOUBLE ? sizeof(double) : sizeof(float);
  *cover = (struct cover){.kernel = kernel, .value_size = size};
  if ((cover->row.b = memory_allocate((size_t)nx + SLACK, size, "a row's cover", status)) &&
      (cover->row.bvx = memory_allocate((size_t)nx + SLACK, size, "a row's cover", status)) &&
      (cover->row.bvy = memory_allocate((size_t)nx + SLACK, size, "a row's cover", status)))
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

void cover_paint(struct cover *cover, const struct run *runs, size_t count, const double *share,
                 const struct surface_velocity *surface)
{
  for (size_t r = 0; r < count; r++) {
    const struct run *run = &runs[r];
    const struct surface_velocity *v = &surface[run->disc];
    cover->kernel->paint(&cover->row, run->x, run->n, share + run->share, v->vx - v->omega * run->ry,
                         v->vy + v->omega * run->rx, v->omega);
  }
}

void cover_clear(struct cover *cover, const struct run *runs, size_t count)
{
  void *const buffers[3] = {cover->row.b, cover->row.bvx, cover->row.bvy};
  int first = runs[0].x, end = first;
  for (size_t r = 0; r < count; r++) {
    if (runs[r].x < first) first = runs[r].x;
    if (runs[r].x + runs[r].n > end) end = runs[r].x + runs[r].n;
  }
  for (int k = 0; k < 3; k++)
    memset((char *)buffers[k] + (size_t)first * cover->value_size, 0, (size_t)(end - first) * cover->value_size);
}
