/* State on its way to a file or back. Each part of a simulation names what belongs to its state in one function for both
 * directions, so that what is restored cannot differ from what was saved. */
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

/* Saves or restores `size` bytes. Fails with DELBM_IO when they cannot be written, or are not there. */
bool store_bytes(struct store *store, void *data, size_t size, struct status *status);

/* The name of what follows; fails when restoring does not find it here. */
bool store_mark(struct store *store, const char *name, struct status *status);

#endif
