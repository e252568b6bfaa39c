/* Values that follow from other keys where the case does not give them. */
#ifndef DELBM_SCENE_SCENE_DERIVE_H
#define DELBM_SCENE_SCENE_DERIVE_H

#include "scene/scene_draft.h"

/* Completes the scene of a valid draft: rates, densities, fill, zero_flux. */
void scene_derive(struct draft *draft);

#endif
