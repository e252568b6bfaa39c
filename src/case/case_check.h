/* Conditions on several keys of a case together; the table of keys has the conditions on single keys. */
#ifndef DELBM_CASE_CASE_CHECK_H
#define DELBM_CASE_CASE_CHECK_H

#include "case/case_draft.h"

/* Adds to draft->errors. Ignores keys that the table has refused. False only if memory runs out. */
bool case_check(struct draft *draft, struct status *status);

#endif
