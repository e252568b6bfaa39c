/* The reference of all keys, printed from their table. */
#ifndef DELBM_CASE_CASE_REFERENCE_H
#define DELBM_CASE_CASE_REFERENCE_H

#include <stdio.h>

/* Prints every key with allowed values, unit, default and help. */
void case_print_keys(FILE *file);

#endif
