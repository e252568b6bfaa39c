/* Writing of scenes as case files. */
#ifndef DELBM_CASE_CASE_WRITE_H
#define DELBM_CASE_CASE_WRITE_H

#include "model/scene.h"

#include <stdio.h>

/* Writes the case with all defaults; reading it returns the same scene, bit for bit. Discs of particles.fill are not
 * written, but generated again from their seed. False if writing failed. */
bool case_write(const struct scene *scene, FILE *file);

/* CRC-32 over the sections that determine the results and their units: domain, fluid, units, coupling, particles and
 * contact, as case_write writes them. The sections run and output are excluded. */
bool case_fingerprint(const struct scene *scene, uint32_t *fingerprint, struct status *status);

#endif
