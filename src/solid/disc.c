#include "solid/disc.h"

#include "solid/lens.h"

#include <math.h>

double disc_area(const struct shape *disc)
{
  return M_PI * (disc->radius * disc->radius);
}

double disc_gyration2(const struct shape *disc)
{
  return disc->radius * disc->radius / 2;
}

struct shape_box disc_box(const struct shape *disc, const struct pose *pose)
{
  const double radius = disc->radius;
  const int row = (int)floor(pose->y - radius);
  return (struct shape_box){
      .column = (int)floor(pose->x - radius), .row = row, .rows = (int)ceil(pose->y + radius) - row};
}

/* Distances from the centres to the chord of the lens; if one disc is inside the other, to the centre of the smaller
 * one. */
static void find_arms(double ra, double rb, struct body_overlap *o)
{
  const double difference = ra - rb;
  const bool inside = o->distance <= fabs(difference);
  o->arm[0] = inside ? (ra > rb ? o->distance : 0) : 0.5 * (o->distance + difference * (ra + rb) / o->distance);
  o->arm[1] = o->distance - o->arm[0];
}

struct body_overlap disc_overlap(const struct shape *disc, const struct shape *other, double dx, double dy)
{
  struct body_overlap o = {.distance = sqrt(dx * dx + dy * dy), .nx = 1};
  o.lens = lens_of_discs(disc->radius, other->radius, o.distance);
  if (o.distance > 0) {
    o.nx = dx / o.distance;
    o.ny = dy / o.distance;
  }
  find_arms(disc->radius, other->radius, &o);
  return o;
}

struct body_overlap disc_overlap_half_plane(const struct shape *disc, double distance, double nx, double ny)
{
  return (struct body_overlap){
      .lens = lens_of_wall(disc->radius, distance), .distance = distance, .nx = nx, .ny = ny, .arm = {distance, 0}};
}
