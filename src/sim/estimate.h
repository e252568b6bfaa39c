/* Estimates of a scene's behaviour from its parameters: rules of thumb with sources, for `info` and for the cause of
 * a divergence. Lattice units. */
#ifndef DELBM_SIM_ESTIMATE_H
#define DELBM_SIM_ESTIMATE_H

#include "model/scene.h"

/* Advised bounds. The relaxation time 1/s_nu, above 1/2, below which errors are hardly damped; the grid Reynolds number
 * |u|/viscosity above which cells are too coarse for the flow. (For speed: scene_advised_speed.) */
static const double estimate_min_tau = 0.503, estimate_max_grid_reynolds = 10;

/* Weight of discs per length over the fluid's pressure, above which the fluid oscillates or diverges (bench
 * stability, map "packing"). */
static const double estimate_max_load = 0.2;

enum { ESTIMATE_KEY = 64 };

/* An expected speed, and the key of the case that causes it. */
struct estimate {
  double speed;           /* cells/step; 0: the case has none */
  const char *from;       /* "the sides", "the discs", "the force" */
  char key[ESTIMATE_KEY]; /* key to change: "fluid.force" */
  double advised;         /* value of the key (of a pair: its length) at which the speed is estimate_advised_speed */
  const char *unit;       /* of `advised` */
};

/* Speed to stay below: scene_advised_speed; without fluid scene_max_speed, since only contacts limit it. */
double estimate_advised_speed(const struct scene *scene);

/* The largest speed within `steps` steps of: sides, discs at the start, settling discs, fluid driven by a body
 * force; without fluid: discs at the start, falling discs. */
struct estimate estimate_fastest(const struct scene *scene, int64_t steps);

/* Terminal speed of a single disc in unbounded fluid, from its weight and the drag of a cylinder: C_D = 8 pi/(Re
 * ln(7.4/Re)) (Lamb) at small Re, and the fit 1 + 10 Re^(-2/3) of measured drag beyond Re = 1. Within a factor of
 * two. */
double estimate_settling(double radius, double viscosity, double weight);

/* Speed of a free disc without fluid that falls from its initial position and velocity, for `steps` steps or until it
 * reaches a side, at `factor` times the gravity of the scene. */
double estimate_fall(const struct scene *scene, const struct disc_spec *disc, int64_t steps, double factor);

/* Speed of the fluid driven by fluid.force along a periodic axis within `steps` steps, 0 along another axis: at most
 * g t; between walls H apart at most g H^2/(8 viscosity), the largest of plane Poiseuille flow; past fixed discs at
 * most what their drag as a square array (Sangani & Acrivos 1982) or one by one allows. */
double estimate_forced(const struct scene *scene, int axis, int64_t steps);

/* Momentum per step that gravity adds to the box: weight less buoyancy of the free discs. */
void estimate_weight(const struct scene *scene, double weight[2]);

/* Pressure of this weight on the side below over the fluid's pressure at rest; 0 along an axis not closed by walls. */
double estimate_load(const struct scene *scene, int axis);

/* The lightest disc for which the explicit solve diverges (bench stability, map "density of a settling disc");
 * particles.count if there is none. */
size_t estimate_lightest_explicit(const struct scene *scene);

#endif
