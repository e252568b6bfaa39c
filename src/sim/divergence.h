/* Why a run diverged: the cause that its numbers point to, and the number to change, in words for a person. */
#ifndef DELBM_SIM_DIVERGENCE_H
#define DELBM_SIM_DIVERGENCE_H

#include "model/scene.h"
#include "solid/discs.h"

struct divergence {
  const struct scene *scene;
  const struct discs *discs; /* as they are now */
  int64_t step;
  double excess; /* mean over all cells of density - 1; NAN: not known */
  int cell[2];   /* the fastest one, or one that is not finite; -1: not known */
};

/* Adds the cause, where one is found, to the message of *status. */
void divergence_explain(const struct divergence *divergence, struct status *status);

#endif
