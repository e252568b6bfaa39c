/* series.csv: one row per time, with sums and maxima over fluid and discs (table.h). */
#ifndef DELBM_OUTPUT_SERIES_H
#define DELBM_OUTPUT_SERIES_H

#include "output/table.h"
#include "sim/instant.h"

/* Columns of series.csv. */
extern const struct table_layout series_layout;

/* Appends the row of `step` (table_add). */
bool series_write(struct table *table, int64_t step, const struct instant *instant, struct status *status);

#endif
