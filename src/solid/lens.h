/* Overlap areas in closed form, without cancellation at small overlap. */
#ifndef DELBM_SOLID_LENS_H
#define DELBM_SOLID_LENS_H

#include "solid/shape.h"

/* Two discs whose centres are `distance` apart. */
struct lens lens_of_discs(double radius_a, double radius_b, double distance);

/* A disc whose centre is `distance` from a wall, on the fluid's side where positive. */
struct lens lens_of_wall(double radius, double distance);

/* For small overlap the area is c overlap^(3/2). c of two discs, or with an infinite radius of a disc and a wall; and what
 * follows from it. */
double lens_small(double radius_a, double radius_b);
double lens_small_area(double c, double overlap);
double lens_small_chord(double c, double overlap);
double lens_small_overlap(double c, double area);

#endif
