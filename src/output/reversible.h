/* A file, written at any place, that can be taken back byte for byte to what it was at an earlier moment, a mark.
 *
 * Before a page of what was there at the last mark is first written to, it is appended to a second file, the way back. To
 * take the file back to a mark, the pages that the way back has received since are put back, last first, and both files
 * are cut to the lengths that they had. A file that has never been marked has no way back.
 *
 * The way back is written through to the disk, record by record, before the file is: a crash of the machine is no worse
 * than a kill. A record cut short is one whose page has not been written to. */
#ifndef DELBM_OUTPUT_REVERSIBLE_H
#define DELBM_OUTPUT_REVERSIBLE_H

#include "base/status.h"

#include <stddef.h>
#include <stdint.h>

struct reversible {
  const char *path, *undo_path;
  int descriptor, undo; /* -1: not open */
  int64_t length, undo_length;
  int64_t marked; /* length at the last mark */
  bool *is_kept;  /* which pages of that length have gone to the way back since */
};

/* Lengths of the two files, bytes. */
struct reversible_mark {
  int64_t file, undo;
};

/* Starts the file anew, or takes it back to a mark. The paths must outlive it. After a failure it is closed. */
bool reversible_create(struct reversible *file, const char *path, const char *undo_path, struct status *status);
bool reversible_return(struct reversible *file, const char *path, const char *undo_path,
                       const struct reversible_mark *mark, struct status *status);
void reversible_close(struct reversible *file);

/* These return an error number, or 0. What lies beyond the end reads as zero. */
int reversible_read(const struct reversible *file, void *to, size_t size, int64_t at);
int reversible_write(struct reversible *file, const void *from, size_t size, int64_t at);
int reversible_set_length(struct reversible *file, int64_t length);

/* Forces the file to the disk and marks it. */
bool reversible_set_mark(struct reversible *file, struct reversible_mark *mark, struct status *status);

#endif
