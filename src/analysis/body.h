/* A disc in a stream: drag and lift coefficients, terminal speed, shedding. U is the speed of the ambient fluid
 * relative to the disc (ambient.h), rho = 1 the reference density, D = 2 R.
 *
 *   free disc    U is the component along gravity's axis, positive in the sense in which the disc moves through the
 *                fluid at last. Its terminal value is the mean over a plateau (plateau.h) of at least five diameters of
 *                way through the fluid, which ends three diameters before a side that the disc approaches. Without a
 *                plateau there is no terminal speed and no coefficient, and `note` has the reason.
 *                C_D = pi R g (rho_s - rho)/(rho U^2) from the weight; and beside it as Zhang et al. (2017) print it,
 *                8 R g (rho_s - rho)/(3 rho U^2), a sphere's. No C_D where the disc moves against its weight, as on the
 *                centre line of a channel whose mean velocity is less than the velocity there. Shedding is sought in
 *                the lateral velocity over the second half of the fall
 *   prescribed   fixed discs, or discs driven at one velocity; means per disc, R the mean radius. U from the ambient
 *                fluid and the discs' own velocity. C_D = F/(rho U^2 R) from the force along U, C_L = F/(rho U^2 R) from the force a
 *                quarter turn counter-clockwise from U, C_M = T/(rho U^2 R^2), over the last quarter of the run; and
 *                K = F/(rho nu U), the drag of slow flow through arrays. A body force on the fluid acts like a
 *                pressure gradient, and its part in F is counted */
#ifndef DELBM_ANALYSIS_BODY_H
#define DELBM_ANALYSIS_BODY_H

#include "analysis/ambient.h"
#include "analysis/fit.h"
#include "analysis/history.h"

/* Below this Reynolds number (47 for a fixed cylinder) a wake is steady, and oscillations are not shedding. */
static const double body_steady_below = 47;

/* Oscillations within the window at least: fewer cannot be distinguished from a drift. */
static const double body_min_cycles = 3;

/* Shortest way of a plateau, and the excluded way before the side ahead; diameters. */
static const double body_min_way = 5, body_side_ahead = 3;

struct body {
  bool prescribed;
  char note[192]; /* warning to the reader of the figures; may be empty */
  struct ambient ambient;
  enum ambient_kind relative; /* reference of U */
  int64_t first, last;        /* window of the means, steps */
  struct spread speed;        /* U, cells/step; NAN: no terminal speed */
  double fastest;             /* largest U; -INFINITY for fixed or driven discs, and relative to a mean */
  int64_t fastest_step;       /* when */
  double reynolds;            /* 2 U R/nu */
  double drag, drag_printed;  /* of means; printed: NAN for fixed or driven discs */
  double drag_spread;         /* deviation within the window; NAN for a free disc */
  double resistance;          /* K; NAN for a free disc */
  struct spread lift, torque; /* coefficients; NAN for a free disc */
  double spin;                /* mean omega R/U */
  double strouhal;            /* 2 f R/U of the lateral velocity, or of the lift; NAN where nothing is shed */
  double swing;               /* amplitude of the shedding: lateral velocity over U, or C_L; NAN likewise */
  double growth; /* of the swing: standard deviation in the last third of the series over the first third */
};

/* True for a scene with fluid and one free disc under gravity along an axis; and for a scene of fixed or driven discs of one
 * velocity where an inlet, a force, a wall or the discs themselves cause a relative motion of fluid and discs. */
bool body_applies(const struct scene *scene);

/* `mean` as of ambient_read_mean. */
bool body_analyse(struct body *body, const struct scene *scene, const double mean[2], const struct history *history,
                  struct status *status);

#endif
