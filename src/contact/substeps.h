/* Sub-steps: how many of them a step of stiff contacts takes, so that a contact lasts contact.steps_per_contact of them and its damper
 * does not overshoot. Areas by cells are known once a step: with them it is one. */
#ifndef DELBM_CONTACT_SUBSTEPS_H
#define DELBM_CONTACT_SUBSTEPS_H

#include "model/scene.h"

/* For a contact of this stiffness (force per overlap), damping and inverse mass of relative motion. */
int substeps_needed(const struct scene *scene, double stiffness, double damping, double inverse_mass);

/* The most that any two of the scene's discs would take at an overlap of one cell. */
int substeps_max(const struct scene *scene);

/* The same with the area by lens: what contact.substeps: auto would choose. */
int substeps_by_lens(const struct scene *scene);

#endif
