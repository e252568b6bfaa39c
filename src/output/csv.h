/* particles.csv: one row per disc and snapshot, numbers with 17 digits, so that they read back as they were. Columns in SI
 * units follow on the right where the case says what they are; those of forces only if it gives the fluid's density. */
#ifndef DELBM_OUTPUT_CSV_H
#define DELBM_OUTPUT_CSV_H

#include "solid/discs.h"

struct csv;

/* Starts the file anew with its header. */
bool csv_open(struct csv **csv, const char *path, const struct units *units, struct status *status);

/* Opens the file of a run that goes on, cut back to the `length` that it had. Fails if it is shorter than that. */
bool csv_reopen(struct csv **csv, const char *path, const struct units *units, int64_t length, struct status *status);

/* Length of the file so far, bytes, all forced to the disk. */
bool csv_sync(struct csv *csv, int64_t *length, struct status *status);

/* Appends the discs at `step`, in one write: what was written stays when the program ends early. A value that is not
 * finite is refused (DELBM_FAILED) with its step, disc and column, and nothing of that snapshot is written. */
bool csv_write(struct csv *csv, int64_t step, const struct discs *discs, struct status *status);

/* Closes the file and sets *csv to NULL; *csv may be NULL. */
bool csv_close(struct csv **csv, struct status *status);

#endif
