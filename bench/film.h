/* Force between two close surfaces in slow flow, with and without sub-grid lubrication: scenes shared by bench lubrication
 * and tests. */
#ifndef DELBM_BENCH_FILM_H
#define DELBM_BENCH_FILM_H

#include "two_discs.h"

#include "model/scene.h"

enum film_motion {
  FILM_APPROACH,    /* force along the normal */
  FILM_SLIDE,       /* without spin: force along the tangent */
  FILM_SPIN,        /* both in the same sense: torque on a, over R_a */
  FILM_ENTRAINMENT, /* pairs: opposite spins, free of force: torque on a, over R_a */
  FILM_MOTIONS
};

struct film {
  double radius[2];  /* the second infinite: the wall at the bottom */
  double gap, angle; /* of the line of centres of a pair */
  double offset[2];  /* of the place on the grid, cells */
  double viscosity;
  double cutoff; /* of contact.lubrication; 0: none */
};

/* Force or torque over R_a, over viscosity and speed (spins: of the rim of a). The speed is so small that nothing moves. */
bool film_force(const struct film *film, enum film_motion motion, double *force, struct status *status);

/* Both the force and the torque over R_a. */
bool film_loads(const struct film *film, enum film_motion motion, double loads[2], struct status *status);

/* film_force in unbounded Stokes flow: exact, or two_discs.h. */
bool film_exact(const struct film *film, enum film_motion motion, double *force);

/* film_force less film_exact at a gap of 4 cells, which the lattice resolves: the effect of the distant sides of the box, which hardly
 * depends on the gap. */
bool film_far(const struct film *film, enum film_motion motion, double *excess, struct status *status);

/* Difference of film_force, less the excess, to film_exact over film_exact. */
bool film_error(const struct film *film, enum film_motion motion, double excess, double *error, struct status *status);

#endif
