/* Aligned, zeroed memory whose failure is reported in words, and huge pages for what is large.
 *
 * Budget. Linux promises more memory than there is and ends a process that uses it. A block of 2 MiB or more is therefore
 * refused if it does not fit into the memory of the machine beside what is resident of this process: what the kernel counts,
 * libraries and all threads included, so that no second account can differ from it. Memory that is mapped but not yet
 * written does not count as resident; its owner writes it at once, or maps it last. */
#ifndef DELBM_BASE_MEMORY_H
#define DELBM_BASE_MEMORY_H

#include "base/status.h"

#include <stddef.h>

enum { CACHE_LINE = 64 };

/* count * size bytes, zeroed, aligned to a cache line; NULL with *status filled when they cannot be had. `what` names the
 * purpose in the message. A count of zero returns a valid pointer. Released by free(). */
void *memory_allocate(size_t count, size_t size, const char *what, struct status *status);

/* Grows *array to hold at least `count` elements of `size` bytes, keeping the first *capacity of them. */
bool memory_grow(void *array, size_t *capacity, size_t count, size_t size, const char *what, struct status *status);

/* Address space for large arrays, aligned to 2 MiB and advised to use huge pages. Its pages are placed by the first
 * thread that writes to them (first touch) and read as zero until then. Released by memory_unmap with the same size. */
void *memory_map(size_t bytes, const char *what, struct status *status);
void memory_unmap(void *pointer, size_t bytes);

/* Memory of this machine, bytes. */
double memory_physical(void);

/* Memory of this process that is resident, bytes; 0 where the kernel does not say. */
double memory_resident(void);

/* Bytes that the functions above have handed out since the start of the process, freed ones included: the difference of two
 * calls is the same in every run. */
double memory_handed_out(void);

/* Peak resident memory of this process, MiB. */
double memory_peak_mib(void);

#endif
