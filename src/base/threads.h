/* Number of threads, and their binding to processors. */
#ifndef DELBM_BASE_THREADS_H
#define DELBM_BASE_THREADS_H

#include <stdint.h>

/* The number that OpenMP offers, limited to one per 4096 cells: below, barriers take longer than the work. Results do
 * not depend on the number. */
int threads_for(int64_t cells);

/* The effect of OMP_PROC_BIND and OMP_PLACES in words: "unbound", or "close over 2 places". */
enum { THREADS_TEXT = 48 };
void threads_binding(char text[THREADS_TEXT]);

#endif
