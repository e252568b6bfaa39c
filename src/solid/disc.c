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
static void find_arms(double distance, struct body_overlap *o)
{
  const double ra = o->radius[0], rb = o->radius[1], difference = ra - rb;
  const bool inside = distance <= fabs(difference);
  o->arm[0] = inside ? (ra > rb ? distance : 0) : 0.5 * (distance + difference * (ra + rb) / distance);
  o->arm[1] = distance - o->arm[0];
}

struct body_overlap disc_overlap(const struct shape *disc, const struct pose *pose, const struct shape *other,
                                 const struct pose *other_pose)
{
  const double dx = other_pose->x - pose->x, dy = other_pose->y - pose->y, distance = sqrt(dx * dx + dy * dy);
  struct body_overlap o = {.lens = lens_of_discs(disc->radius, other->radius, distance),
                           .depth = disc->radius + other->radius - distance,
                           .nx = 1,
                           .radius = {disc->radius, other->radius}};
  if (distance > 0) {
    o.nx = dx / distance;
    o.ny = dy / distance;
  }
  find_arms(distance, &o);
  return o;
}

struct body_overlap disc_overlap_half_plane(const struct shape *disc, const struct pose *pose, double distance,
                                            double nx, double ny)
{
  (void)pose;
  return (struct body_overlap){.lens = lens_of_wall(disc->radius, distance),
                               .depth = disc->radius - distance,
                               .nx = nx,
                               .ny = ny,
                               .arm = {distance, 0},
                               .radius = {disc->radius, INFINITY}};
}
