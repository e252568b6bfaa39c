/* Scenes to case files. */
#ifndef DELBM_CASE_CASE_WRITE_H
#define DELBM_CASE_CASE_WRITE_H

#include "model/scene.h"

#include <stdio.h>

/* Writes the case with every default filled in; reading it gives the same scene, bit for bit. Discs of particles.fill
 * are left to be drawn again. False if writing failed. */
bool case_write(const struct scene *scene, FILE *file);

/* A sum (CRC-32) over what decides the course of a simulation and what its numbers mean: domain, fluid, units, coupling,
 * particles and contact as case_write writes them, not the length of the run nor what is written of it. */
bool case_fingerprint(const struct scene *scene, uint32_t *fingerprint, struct status *status);

#endif
