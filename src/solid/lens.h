/* Overlap areas in closed form, without cancellation at small overlap. */
#ifndef DELBM_SOLID_LENS_H
#define DELBM_SOLID_LENS_H

#include "solid/shape.h"

/* Two discs whose centres are `distance` apart. */
struct lens lens_of_discs(double radius_a, double radius_b, double distance);

/* A disc whose centre is `distance` from a wall, on the fluid's side where positive. */
struct lens lens_of_wall(double radius, double distance);

#endif
