/* The probable cause of divergence and the key to change, as text for the user. */
#ifndef DELBM_SIM_DIVERGENCE_H
#define DELBM_SIM_DIVERGENCE_H

#include "model/scene.h"
#include "solid/discs.h"

struct divergence {
  const struct scene *scene;
  const struct discs *discs; /* as they are now */
  int64_t step;
  double excess; /* mean over all cells of density - 1; NAN: unknown */
  int cell[2];   /* the fastest cell, or a cell that is not finite; -1: unknown */
};

/* Appends the cause, if one is found, to the message of *status. */
void divergence_explain(const struct divergence *divergence, struct status *status);

#endif
