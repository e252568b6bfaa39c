/* Fault injection in a program that is linked with faulty.c, which has the syntax. */
#ifndef DELBM_TESTS_FAULTY_H
#define DELBM_TESTS_FAULTY_H

#include <stdbool.h>

/* Starts fault injection as with DELBM_FAIL=wish at the start of the program. */
void faulty_begin(const char *wish);

/* Ends fault injection; true if a call has failed. */
bool faulty_end(void);

#endif
