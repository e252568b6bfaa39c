/* Saving and restoring of state. Each part of a simulation lists its state in one function for both directions, so
 * that both agree. */
#ifndef DELBM_BASE_STORE_H
#define DELBM_BASE_STORE_H

#include "base/status.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

struct store {
  FILE *stream;
  const char *path; /* for messages */
  bool saving;      /* else restoring */
  uint32_t sum;     /* CRC-32 of all bytes so far */
};

/* Saves or restores `size` bytes. Fails with DELBM_IO on a write error, or at a premature end of the file. */
bool store_bytes(struct store *store, void *data, size_t size, struct status *status);

/* Saves a name before a part of the state, or fails if it differs when restored. */
bool store_mark(struct store *store, const char *name, struct status *status);

#endif
