#include "coupling/cover.h"

#include "base/memory.h"

#include <stdlib.h>

enum { SLACK = 8 }; /* elements past the row that a kernel may touch */

bool cover_create(struct cover *cover, int nx, const struct sweep_kernel *kernel, struct status *status)
{
  const size_t size = kernel->precision == PRECISION_DOUBLE ? sizeof(double) : sizeof(float);
  *cover = (struct cover){0};
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
