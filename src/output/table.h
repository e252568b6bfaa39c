/* A file of numbers with comma-separated columns. A row has keys, which are whole numbers (the step first), and values
 * with 17 digits, which are read back exactly. Columns in SI units are appended on the right if the case has a `units`
 * block; columns with a mass in their unit need the fluid's density. Rows are written in blocks: a block is complete in
 * the file or absent, and remains there after the end of a killed program. */
#ifndef DELBM_OUTPUT_TABLE_H
#define DELBM_OUTPUT_TABLE_H

#include "base/status.h"
#include "lattice/units.h"

#include <stdint.h>

struct table_key {
  const char *name; /* in the header */
  const char *noun; /* in messages */
};

struct table_column {
  const char *name;
  size_t member;    /* offset of the quantity in the struct from which the owner of the table makes its rows */
  const char *unit; /* of the lattice; "" for a pure number, which has no column in SI */
};

struct table_layout {
  const struct table_key *keys;
  size_t key_count;
  const struct table_column *columns;
  size_t count;
};

struct table;

/* Creates the file with its header. The layout must outlive the table. */
bool table_open(struct table **table, const char *path, const struct table_layout *layout, const struct units *units,
                struct status *status);

/* Opens the file of a resumed run, truncated to `length` bytes. Fails if the file is shorter. */
bool table_reopen(struct table **table, const char *path, const struct table_layout *layout, const struct units *units,
                  int64_t length, struct status *status);

/* Forces the file to the disk; *length is its length in bytes. */
bool table_sync(struct table *table, int64_t *length, struct status *status);

/* Begins a block of rows. Fails if the path no longer refers to the file. */
bool table_begin(struct table *table, struct status *status);

/* Adds a row to the block: key_count keys, count values. A value that is not finite is refused (DELBM_FAILED) with its
 * keys and column. */
bool table_add(struct table *table, const int64_t *keys, const double *values, struct status *status);

/* Appends the block to the file in one write. */
bool table_write(struct table *table, struct status *status);

/* Closes the file and sets *table to NULL; *table may be NULL. */
bool table_close(struct table **table, struct status *status);

#endif
