/* Aligned, zeroed memory, with huge pages for large blocks. A failure is reported with size and purpose.
 *
 * Budget. Linux overcommits memory and kills a process that uses too much. A block of 2 MiB or more is therefore
 * refused if it exceeds the memory of the machine less the resident memory of this process, as the kernel counts it
 * (libraries and all threads included). Mapped pages are not resident until they are written, so that a mapped block
 * has to be written at once, or to be the last. */
#ifndef DELBM_BASE_MEMORY_H
#define DELBM_BASE_MEMORY_H

#include "base/status.h"

#include <stddef.h>

enum { CACHE_LINE = 64 };

/* count * size zeroed bytes, aligned to a cache line; NULL with *status filled on failure. `what`: the purpose, for the
 * message. A valid pointer also for a count of zero. Released by free(). */
void *memory_allocate(size_t count, size_t size, const char *what, struct status *status);

/* Grows *array to at least `count` elements of `size` bytes; the first *capacity are copied. */
bool memory_grow(void *array, size_t *capacity, size_t count, size_t size, const char *what, struct status *status);

/* Zeroed memory for large arrays, aligned to 2 MiB, in huge pages where the kernel allows. A page is placed near the
 * thread that first writes to it. Released by memory_unmap with the same size. */
void *memory_map(size_t bytes, const char *what, struct status *status);
void memory_unmap(void *pointer, size_t bytes);

/* Memory of this machine, bytes. */
double memory_physical(void);

/* Resident memory of this process, bytes; 0 without /proc. */
double memory_resident(void);

/* Bytes allocated and mapped since the start of the process, freed blocks included: differences are reproducible. */
double memory_handed_out(void);

/* Peak resident memory of this process, MiB. */
double memory_peak_mib(void);

#endif
