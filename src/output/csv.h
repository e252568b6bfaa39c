/* particles.csv: one row per disc and snapshot, numbers with 17 digits, which are read back exactly. Columns in SI
 * units are appended on the right if the case has a `units` block; columns of forces need the fluid's density. */
#ifndef DELBM_OUTPUT_CSV_H
#define DELBM_OUTPUT_CSV_H

#include "solid/discs.h"

struct csv;

/* Creates the file with its header. */
bool csv_open(struct csv **csv, const char *path, const struct units *units, struct status *status);

/* Opens the file of a resumed run, truncated to `length` bytes. Fails if the file is shorter. */
bool csv_reopen(struct csv **csv, const char *path, const struct units *units, int64_t length, struct status *status);

/* Forces the file to the disk; *length is its length in bytes. */
bool csv_sync(struct csv *csv, int64_t *length, struct status *status);

/* Appends the discs at `step` in one write, so that rows written before the end of a killed program remain. A value
 * that is not finite is refused (DELBM_FAILED) with its step, disc and column, and the snapshot is not written. */
bool csv_write(struct csv *csv, int64_t step, const struct discs *discs, struct status *status);

/* Closes the file and sets *csv to NULL; *csv may be NULL. */
bool csv_close(struct csv **csv, struct status *status);

#endif
