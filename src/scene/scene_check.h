/* What the keys of a case must fulfil together, beyond what the table says of each alone. */
#ifndef DELBM_SCENE_SCENE_CHECK_H
#define DELBM_SCENE_SCENE_CHECK_H

#include "scene/scene_draft.h"

/* Adds to draft->errors. Keys that the table has refused are left out. False only for want of memory. */
bool scene_check(struct draft *draft, struct status *status);

#endif
