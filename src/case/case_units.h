/* The units block of a case. */
#ifndef DELBM_CASE_CASE_UNITS_H
#define DELBM_CASE_CASE_UNITS_H

#include "case/case_draft.h"

/* Sets draft->scene.units by the block, if there is one, before other keys are read: they are scaled by it. What is wrong
 * in it is left for the reading of its keys and for case_units_check to tell. */
void case_units_read(struct draft *draft);

/* What the keys of the block must fulfil together. Adds to draft->errors. */
void case_units_check(struct draft *draft);

#endif
