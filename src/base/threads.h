/* How many threads a piece of work gets. */
#ifndef DELBM_BASE_THREADS_H
#define DELBM_BASE_THREADS_H

#include <stdint.h>

/* As many as OpenMP offers, but none for less than 4096 cells: they would wait for each other longer than they work.
 * Results are the same with any number. */
int threads_for(int64_t cells);

/* How OMP_PROC_BIND and OMP_PLACES have bound threads to processors, in words: "unbound", or "close over 2 places". */
enum { THREADS_TEXT = 48 };
void threads_binding(char text[THREADS_TEXT]);

#endif
