/* The contacts at one instant, from the positions of the discs alone. For output; independent of the contact stage. */
#ifndef DELBM_CONTACT_CENSUS_H
#define DELBM_CONTACT_CENSUS_H

#include "solid/discs.h"

struct contact_census {
  size_t contacts;    /* pairs of discs, and discs with sides, whose overlap depth is above 0 */
  double max_overlap; /* the largest depth over the smaller radius, with a side over the disc's; 0: no contact */
};

/* Counts the contacts in which a force acts, hence with at least one free disc. Called outside of parallel regions.
 * Fails only for want of memory. */
bool contact_census(const struct scene *scene, const struct discs *discs, struct contact_census *census,
                    struct status *status);

#endif
