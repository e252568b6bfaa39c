/* Default values that depend on other keys. */
#ifndef DELBM_CASE_CASE_DERIVE_H
#define DELBM_CASE_CASE_DERIVE_H

#include "case/case_draft.h"

/* Completes the scene of a valid draft: rates, densities, fill, zero_flux. */
void case_derive(struct draft *draft);

/* contact.stiffness: auto, once the discs of particles.fill are there. Fails for lack of memory. */
bool case_derive_stiffness(struct draft *draft, struct status *status);

#endif
