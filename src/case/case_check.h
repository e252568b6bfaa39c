/* Conditions on several keys of a case together; the table of keys has the conditions on single keys. */
#ifndef DELBM_CASE_CASE_CHECK_H
#define DELBM_CASE_CASE_CHECK_H

#include "case/case_draft.h"

/* Adds to draft->errors. Ignores keys that the table has refused. False only if memory runs out. */
bool case_check(struct draft *draft, struct status *status);

/* Listed discs that run into a side, at the stiffness of the complete scene. False with errors added. */
bool case_check_impacts(struct draft *draft);

#endif
