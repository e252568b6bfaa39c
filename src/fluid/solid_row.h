/* Memory for a solid row (sweep.h): the weight B and the velocity of the solid in one row of cells, filled just before the row
 * is swept. Three row buffers that stay in cache take the place of three planes of the box. */
#ifndef DELBM_FLUID_SOLID_ROW_H
#define DELBM_FLUID_SOLID_ROW_H

#include "fluid/sweep.h"

/* Allocates a row of nx cells for the kernel's precision. */
bool solid_row_create(struct solid_row *row, int nx, const struct sweep_kernel *kernel, struct status *status);
void solid_row_destroy(struct solid_row *row);

#endif
