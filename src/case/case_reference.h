/* The reference of the keys of a case, from their table. */
#ifndef DELBM_CASE_CASE_REFERENCE_H
#define DELBM_CASE_CASE_REFERENCE_H

#include <stdio.h>

/* Prints every key with what is allowed, its unit, its default and a line of help. */
void case_print_keys(FILE *file);

#endif
