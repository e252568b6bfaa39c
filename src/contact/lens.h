/* Overlap areas in closed form, without cancellation at small overlap. */
#ifndef DELBM_CONTACT_LENS_H
#define DELBM_CONTACT_LENS_H

/* An overlap: its area and its chord, which is d(area)/d(overlap distance). */
struct lens {
  double area, chord;
};

/* Two discs whose centres are `distance` apart. */
struct lens lens_of_discs(double radius_a, double radius_b, double distance);

/* A disc whose centre is `distance` from a wall, on the fluid's side where positive. */
struct lens lens_of_wall(double radius, double distance);

#endif
