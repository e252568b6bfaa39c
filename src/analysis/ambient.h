/* The velocity that a disc's speed is measured against, each axis by itself:
 *
 *   AMBIENT_STREAM   with an inlet: the velocity of the first inlet, the free stream
 *   AMBIENT_REST     walls close the axis: zero, as no mean flux is possible
 *   AMBIENT_MEAN     else: the mean velocity of the box at the end of the run, mean_ux and mean_uy of run.json
 *
 * The mean velocity is the fluid's momentum over its mass, cells inside discs included: the flux through a
 * cross-section over its height (the superficial velocity of a porous medium). */
#ifndef DELBM_ANALYSIS_AMBIENT_H
#define DELBM_ANALYSIS_AMBIENT_H

#include "model/scene.h"

enum ambient_kind { AMBIENT_STREAM, AMBIENT_REST, AMBIENT_MEAN };

struct ambient {
  enum ambient_kind kind[2];
  double velocity[2]; /* NAN where it is the mean velocity and that is unknown */
};

/* Mean velocity from DIR/run.json; NAN where there is no such file yet, or no such figure in it. */
bool ambient_read_mean(const char *directory, double mean[2], struct status *status);

struct ambient ambient_of(const struct scene *scene, const double mean[2]);

/* The reference of speeds, for messages. */
const char *ambient_name(enum ambient_kind kind);

#endif
