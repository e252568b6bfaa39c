/* What the keys of a case must fulfil together, beyond what the table says of each alone. */
#ifndef DELBM_CASE_CASE_CHECK_H
#define DELBM_CASE_CASE_CHECK_H

#include "case/case_draft.h"

/* Adds to draft->errors. Keys that the table has refused are left out. False only for want of memory. */
bool case_check(struct draft *draft, struct status *status);

#endif
