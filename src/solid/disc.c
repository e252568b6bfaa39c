#include "solid/disc.h"

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
