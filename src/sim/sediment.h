/* The discs that gravity draws to one side of the box, and the pile that they come to lie in. Rules of thumb. */
#ifndef DELBM_SIM_SEDIMENT_H
#define DELBM_SIM_SEDIMENT_H

#include "model/scene.h"

/* Solid fraction of discs poured at random. */
static const double sediment_packing = 0.8;

struct sediment {
  int axis;
  bool at_high_end; /* of the axis */
  size_t count;
  double weight, area;    /* sums; weight less buoyancy */
  double radius;          /* mean */
  double farthest;        /* largest distance of a centre from that side */
  double low[2], high[2]; /* bounding rectangle at the start */
};

struct sediment sediment_of(const struct scene *scene, int axis, bool at_high_end);

/* True for a free disc that gravity draws to the side of the sediment. */
bool sediment_has(const struct scene *scene, const struct sediment *sediment, const struct disc_spec *disc);

/* Density of the fluid about the discs: 1, or 0 without fluid. */
static inline double sediment_fluid(const struct scene *scene)
{
  return scene->fluid.none ? 0 : 1;
}

/* Weight less buoyancy along an axis. */
double sediment_disc_weight(const struct scene *scene, const struct disc_spec *disc, int axis);

/* Layers of the pile; up to 1, discs lie beside each other. */
double sediment_layers(const struct scene *scene, const struct sediment *sediment);

/* Weight per width: of the box or, for discs densely packed from the start, of the packing. */
double sediment_pressure(const struct scene *scene, const struct sediment *sediment);

/* Distance by which the farthest disc falls onto the pile of the others; <= 0: the pile is there from the start. */
double sediment_fall(const struct scene *scene, const struct sediment *sediment);

#endif
