/* The units block of a case. */
#ifndef DELBM_CASE_CASE_UNITS_H
#define DELBM_CASE_CASE_UNITS_H

#include "case/case_draft.h"

/* Sets draft->scene.units from the block, before keys with units are read. Errors in the block are reported later, by
 * the reading of its keys and by case_units_check. */
void case_units_read(struct draft *draft);

/* Checks the keys of the block together. Adds to draft->errors. */
void case_units_check(struct draft *draft);

#endif
