/* What a scene will do, foreseen from its numbers before a step is taken: rules of thumb with their sources, for `info` and
 * for the reason why a run diverged. Lattice units. */
#ifndef DELBM_SIM_ESTIMATE_H
#define DELBM_SIM_ESTIMATE_H

#include "model/scene.h"

/* Advised bounds. The relaxation time 1/s_nu, above 1/2, below which errors are hardly damped; the grid Reynolds number
 * |u|/viscosity above which cells are too coarse for the flow. (For speed: scene_advised_speed.) */
static const double estimate_least_tau = 0.503, estimate_most_grid_reynolds = 10;

/* Part of the fluid's pressure above which the weight of discs makes it ring or diverge (bench stability, map "packing"). */
static const double estimate_most_load = 0.2;

enum { ESTIMATE_KEY = 64 };

/* A speed that the scene leads to, and the number of the case that it comes from. */
struct estimate {
  double speed;           /* cells/step; 0: the case has none */
  const char *from;       /* "the sides", "the discs", "the force" */
  char key[ESTIMATE_KEY]; /* of the number to change: "fluid.force" */
  double most;            /* value of the key (of a pair: its length) at which the speed is the advised one */
  const char *unit;       /* of that value */
};

/* The fastest of: sides, discs as given, discs that settle, fluid that a body force drives, within so many steps. */
struct estimate estimate_fastest(const struct scene *scene, int64_t steps);

/* Speed at which a disc settles alone in unbounded fluid, from its weight and the drag of a cylinder: C_D = 8 pi/(Re
 * ln(7.4/Re)) (Lamb) at small Re, and the fit 1 + 10 Re^(-2/3) of measured drag beyond Re = 1. Within a factor of two. */
double estimate_settling(double radius, double viscosity, double weight);

/* Speed that fluid.force gives the fluid along a periodic axis within so many steps, 0 along another: at most g t; between
 * walls H apart at most g H^2/(8 viscosity), the largest of plane Poiseuille flow; past fixed discs at most what their
 * drag as a square array (Sangani & Acrivos 1982) or one by one allows. */
double estimate_forced(const struct scene *scene, int axis, int64_t steps);

/* What gravity adds to the momentum of the box in a step, by the free discs less their buoyancy. */
void estimate_weight(const struct scene *scene, double weight[2]);

/* Pressure of that weight on the side below, as a part of the fluid's at rest; 0 along an axis that no walls close. */
double estimate_load(const struct scene *scene, int axis);

/* The lightest of the discs that the explicit solve makes diverge (bench stability, map "density of a settling disc");
 * particles.count without any. */
size_t estimate_lightest_explicit(const struct scene *scene);

#endif
