/* Overlap areas and chords of discs in closed form, accurate also at small overlap. Lattice units. */
#ifndef DELBM_SOLID_LENS_H
#define DELBM_SOLID_LENS_H

#include "solid/shape.h"

/* Two discs at a distance of their centres. */
struct lens lens_of_discs(double radius_a, double radius_b, double distance);

/* A disc and a wall; `distance` of the centre from the wall is positive on the side of the fluid. */
struct lens lens_of_wall(double radius, double distance);

#endif
