/* Number of sub-steps of a step: a contact lasts at least contact.steps_per_contact sub-steps, and its damper does
 * not overshoot. One with area by cells, which is evaluated once a step. */
#ifndef DELBM_CONTACT_SUBSTEPS_H
#define DELBM_CONTACT_SUBSTEPS_H

#include "contact/law.h"

/* Rates of contacts: the largest stiffness (force per overlap) times compliance (speed per impulse; without fluid the
 * inverse mass of relative motion), and the largest damping coefficient times compliance. */
struct contact_rates {
  bool any; /* false: no contact may act */
  double spring, damper;
};

/* Rates of a contact of two discs, friction and rolling friction included, for a stiffness and compliance of approach. */
struct contact_rates substeps_rates(const struct contact_law *law, double stiffness, double compliance);

int substeps_needed(const struct scene *scene, const struct contact_rates *rates);

/* The choice of contact.substeps: auto with area by lens, whatever the key says: the number that resolves each contact
 * of the scene's free discs up to an overlap of one cell. */
int substeps_automatic(const struct scene *scene);

/* The number with area by lens: a fixed one, or substeps_automatic. */
int substeps_by_lens(const struct scene *scene);

/* The largest number that a step may take. */
int substeps_max(const struct scene *scene);

#endif
