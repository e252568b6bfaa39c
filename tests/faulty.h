/* Failures on demand within a program that faulty.c is linked to (its first lines say how they are named). */
#ifndef DELBM_TESTS_FAULTY_H
#define DELBM_TESTS_FAULTY_H

#include <stdbool.h>

/* From now on calls fail as DELBM_FAIL=wish would have them from the start. */
void faulty_begin(const char *wish);

/* Ends that; true if a call has failed. */
bool faulty_end(void);

#endif
