/* A pair of discs, and a list of pairs that one thread fills. */
#ifndef DELBM_CONTACT_PAIR_H
#define DELBM_CONTACT_PAIR_H

#include "base/memory.h"

#include <stdint.h>

struct pair {
  uint32_t a, b; /* a < b */
};

struct pair_batch {
  struct pair *pairs;
  size_t count, capacity;
};

static inline bool pair_batch_add(struct pair_batch *batch, const struct pair *pair, struct status *status)
{
  if (!memory_grow(&batch->pairs, &batch->capacity, batch->count + 1, sizeof *pair, "the pairs", status)) return false;
  batch->pairs[batch->count++] = *pair;
  return true;
}

#endif
