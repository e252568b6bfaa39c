/* Memory for a solid row (sweep.h). A row is filled just before its sweep, so that three row buffers in cache
 * replace three planes of the box. */
#ifndef DELBM_FLUID_SOLID_ROW_H
#define DELBM_FLUID_SOLID_ROW_H

#include "fluid/sweep.h"

/* Allocates a row of nx cells for the kernel's precision. */
bool solid_row_create(struct solid_row *row, int nx, const struct sweep_kernel *kernel, struct status *status);
void solid_row_destroy(struct solid_row *row);

#endif
