/* The history of a run's discs: particles.csv read back. */
#ifndef DELBM_ANALYSIS_HISTORY_H
#define DELBM_ANALYSIS_HISTORY_H

#include "base/status.h"

#include <stddef.h>
#include <stdint.h>

/* The columns after step and id, in the order of the file (output/csv.c). */
enum history_column {
  HISTORY_X,
  HISTORY_Y,
  HISTORY_VX,
  HISTORY_VY,
  HISTORY_OMEGA,
  HISTORY_ANGLE,
  HISTORY_FX,
  HISTORY_FY,
  HISTORY_TORQUE,
  HISTORY_CONTACT_FX,
  HISTORY_CONTACT_FY,
  HISTORY_CONTACT_TORQUE,
  HISTORY_COLUMNS
};

struct history {
  size_t discs;
  size_t snapshots;
  int64_t *step;  /* [snapshots] */
  double *values; /* [snapshots][discs][HISTORY_COLUMNS] */
};

/* Reads the table at `path` of a scene with `discs` discs. An incomplete last snapshot is left out. DELBM_IO if the
 * file cannot be read; DELBM_INVALID, with the line, if it is no such table or has no complete snapshot. */
bool history_read(struct history *history, const char *path, size_t discs, struct status *status);
void history_clear(struct history *history);

static inline double history_at(const struct history *h, size_t snapshot, size_t disc, enum history_column column)
{
  return h->values[(snapshot * h->discs + disc) * HISTORY_COLUMNS + column];
}

#endif
