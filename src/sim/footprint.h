/* The memory that a run takes, known from the scene before any of it is asked for. Linux promises more memory than there
 * is and ends a program that uses it; a case that cannot fit is refused instead. */
#ifndef DELBM_SIM_FOOTPRINT_H
#define DELBM_SIM_FOOTPRINT_H

#include "model/scene.h"

/* Bytes, rather more than less. */
struct footprint {
  double fluid;    /* the populations */
  double discs;    /* their list and state, and the cells they cover, of this step and the next */
  double contacts; /* pairs and sides, as many as a dense packing has, and what they are found by */
  double fields;   /* the samples of a snapshot, and discs as points */
  double frames;   /* the velocities that pictures are drawn from */
  double program;  /* itself, and what libraries hold */
};
struct footprint footprint_of(const struct scene *scene);

double footprint_total(const struct footprint *footprint);

/* Fails with DELBM_INVALID, naming the key to blame, if the run takes more than `available` bytes. */
bool footprint_check(const struct scene *scene, double available, struct status *status);

#endif
