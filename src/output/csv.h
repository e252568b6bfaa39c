/* particles.csv: one row per disc and snapshot (table.h). */
#ifndef DELBM_OUTPUT_CSV_H
#define DELBM_OUTPUT_CSV_H

#include "output/table.h"
#include "solid/discs.h"

/* Columns of particles.csv. */
extern const struct table_layout csv_layout;

/* Appends the discs at `step`, or none of them (table_add). */
bool csv_write(struct table *table, int64_t step, const struct discs *discs, struct status *status);

#endif
