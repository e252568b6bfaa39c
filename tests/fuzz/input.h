/* What libFuzzer hands over, as a file that the readers can open. */
#ifndef DELBM_TESTS_FUZZ_INPUT_H
#define DELBM_TESTS_FUZZ_INPUT_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

enum { INPUT_PATH = 64 };

/* A file in memory with these bytes; returns its descriptor, which the caller closes, and its path. */
static inline int input_file(const uint8_t *bytes, size_t size, char path[INPUT_PATH])
{
  const int descriptor = memfd_create("input", MFD_CLOEXEC);
  if (descriptor < 0 || write(descriptor, bytes, size) != (ssize_t)size) abort();
  snprintf(path, INPUT_PATH, "/proc/self/fd/%d", descriptor);
  return descriptor;
}

#endif
