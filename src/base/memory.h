/* Aligned, zeroed memory whose failure is reported in words, and huge pages for what is large. */
#ifndef DELBM_BASE_MEMORY_H
#define DELBM_BASE_MEMORY_H

#include "base/status.h"

#include <stddef.h>

enum { CACHE_LINE = 64 };

/* count * size bytes, zeroed, aligned to a cache line; NULL with *status filled when it cannot be had: more than
 * the machine has is not asked for. `what` names the purpose in the message. A count of zero gives a valid pointer. Released by free(). */
void *memory_allocate(size_t count, size_t size, const char *what, struct status *status);

/* Grows *array to hold at least `count` elements of `size` bytes, keeping the first *capacity of them. */
bool memory_grow(void *array, size_t *capacity, size_t count, size_t size, const char *what, struct status *status);

/* Address space for large arrays, aligned to 2 MiB and advised to use huge pages. Its pages are placed by the first
 * thread that writes to them (first touch) and read as zero until then. Released by memory_unmap with the same size. */
void *memory_map(size_t bytes, const char *what, struct status *status);
void memory_unmap(void *pointer, size_t bytes);

/* Memory of this machine, bytes. */
double memory_physical(void);

/* Peak resident memory of this process, MiB. */
double memory_peak_mib(void);

#endif
