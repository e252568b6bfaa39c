/* Rebound of a disc from a wall in viscous fluid: scene shared by bench rebound and tests. */
#ifndef DELBM_BENCH_REBOUND_H
#define DELBM_BENCH_REBOUND_H

#include "model/scene.h"

struct rebound {
  double density, viscosity;
  double cutoff; /* of contact.lubrication; 0: none */
  double stokes; /* density/9 times Re = 2 R v/viscosity, v the speed of impact, as for spheres */
  double
      restitution; /* speed of rebound over speed of impact, both at a gap of R/5; 0 if the disc does not return there */
};

/* Sets stokes and restitution. */
bool rebound_run(struct rebound *rebound, struct status *status);

#endif
