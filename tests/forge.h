/* Forged checkpoints with right checksums. */
#ifndef DELBM_TESTS_FORGE_H
#define DELBM_TESTS_FORGE_H

#include "output/checkpoint.h"

#include <criterion/criterion.h>
#include <stdio.h>
#include <string.h>
#include <zlib.h>

/* Changes the step in a checkpoint's head and the bits of `order` in its mark of the order of bytes. */
static inline void forge_head(const char *path, int64_t by, uint32_t order)
{
  static unsigned char bytes[1 << 21];
  struct checkpoint_head head;
  FILE *file = fopen(path, "r+b");
  cr_assert(file);
  const size_t size = fread(bytes, 1, sizeof bytes, file);
  cr_assert(size > sizeof head && size < sizeof bytes);
  memcpy(&head, bytes, sizeof head);
  head.step += by;
  head.order ^= order;
  memcpy(bytes, &head, sizeof head);
  const uint32_t sum = (uint32_t)crc32_z(0, bytes, size - sizeof sum);
  memcpy(bytes + size - sizeof sum, &sum, sizeof sum);
  rewind(file);
  cr_assert(fwrite(bytes, 1, size, file) == size && fclose(file) == 0);
}

static inline void forge_step(const char *path, int64_t by)
{
  forge_head(path, by, 0);
}

#endif
