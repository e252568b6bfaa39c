/* Discs driven by callbacks. */
#ifndef DELBM_API_DRIVE_H
#define DELBM_API_DRIVE_H

#include "api/handle.h"

/* Before a step: calls all callbacks and sets the velocities that they return, or none if one is above the limits. */
bool api_drive_begin(struct delbm_simulation *simulation, struct api_call *call);
/* After a step: adds the inertia of the fluid inside to the forces. */
void api_drive_end(struct delbm_simulation *simulation);

#endif
