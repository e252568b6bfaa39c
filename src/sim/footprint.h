/* The memory that a run takes, known from the scene before any of it is asked for. Linux promises more memory than there
 * is and ends a program that uses it; a case that cannot fit is refused instead. */
#ifndef DELBM_SIM_FOOTPRINT_H
#define DELBM_SIM_FOOTPRINT_H

#include "scene/scene.h"

/* Bytes. Contacts are left out: how many there will be nobody knows. */
struct footprint {
  double fluid;  /* the populations */
  double discs;  /* their list and state, and the cells they cover, of this step and the next */
  double frames; /* the velocities that pictures are drawn from */
};
struct footprint footprint_of(const struct scene *scene);

double footprint_total(const struct footprint *footprint);

/* Fails with DELBM_INVALID, naming the key to blame, if the run takes more than `available` bytes. */
bool footprint_check(const struct scene *scene, double available, struct status *status);

#endif
