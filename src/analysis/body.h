/* One disc in a stream: drag and lift coefficients, terminal velocity, shedding. U is the speed of the fluid far away
 * relative to the disc, rho = 1 the reference density.
 *
 *   free disc   C_D = pi R g (rho_s - rho)/(rho U^2) from its weight, with U the mean of its velocity along gravity; and
 *               beside it as Zhang et al. (2017) print it, 8 R g (rho_s - rho)/(3 rho U^2), which is a sphere's
 *   held disc   C_D = F/(rho U^2 R) from the force along the stream, C_L = F/(rho U^2 R) from that a quarter turn
 *               counter-clockwise from it, C_M = T/(rho U^2 R^2); U from the inlet and the disc's own velocity
 *
 * Means are over a window: of a free disc the second half of its fall, up to ten diameters before a side; of a held one
 * the last quarter of the run. */
#ifndef DELBM_ANALYSIS_BODY_H
#define DELBM_ANALYSIS_BODY_H

#include "analysis/fit.h"
#include "analysis/history.h"
#include "scene/scene.h"

/* A wake is steady below this Reynolds number (47 for a fixed cylinder): what oscillates there is not shed. */
static const double body_steady_below = 47;

struct body {
  bool held;
  int64_t first, last;        /* steps of the window */
  struct spread speed;        /* U, cells/step */
  double reynolds;            /* 2 U R/nu */
  double drag, drag_printed;  /* of means; printed: NAN for a held disc */
  double drag_spread;         /* deviation within the window; NAN for a free disc */
  struct spread lift, torque; /* coefficients; NAN for a free disc */
  double spin;                /* mean omega R/U */
  double strouhal;            /* 2 f R/U of the lateral velocity, or of the lift; NAN where nothing is shed */
  double swing;               /* amplitude of that: lateral velocity over U, or C_L; NAN likewise */
};

/* True for a scene with one disc that is free and feels gravity along an axis, or held in a stream. */
bool body_applies(const struct scene *scene);
bool body_analyse(struct body *body, const struct scene *scene, const struct history *history, struct status *status);

#endif
