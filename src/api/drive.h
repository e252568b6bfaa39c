/* Discs driven by callbacks. */
#ifndef DELBM_API_DRIVE_H
#define DELBM_API_DRIVE_H

#include "api/handle.h"

/* Before a step and after it: asks the callbacks, in the caller's locale, and sets what they ask for, or nothing if one of
 * them asks for too much; makes the forces whole. */
bool api_drive_begin(struct delbm_simulation *simulation, struct api_call *call);
void api_drive_end(struct delbm_simulation *simulation);

#endif
