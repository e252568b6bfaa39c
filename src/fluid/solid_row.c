#include "fluid/solid_row.h"

#include "base/memory.h"

#include <stdlib.h>

enum { SLACK = 8 }; /* elements past the row that a kernel may touch */

bool solid_row_create(struct solid_row *row, int nx, const struct sweep_kernel *kernel, struct status *status)
{
  const size_t size = kernel->precision == PRECISION_DOUBLE ? sizeof(double) : sizeof(float);
  *row = (struct solid_row){0};
  if ((row->b = memory_allocate((size_t)nx + SLACK, size, "a solid row", status)) &&
      (row->bvx = memory_allocate((size_t)nx + SLACK, size, "a solid row", status)) &&
      (row->bvy = memory_allocate((size_t)nx + SLACK, size, "a solid row", status)))
    return true;
  solid_row_destroy(row);
  return false;
}

void solid_row_destroy(struct solid_row *row)
{
  free(row->b);
  free(row->bvx);
  free(row->bvy);
  *row = (struct solid_row){0};
}
