#include "disc_area.h"

double disc_cell_area(double radius, double x, double y)
{
  const struct disc_line left = disc_line_at(radius, x), right = disc_line_at(radius, x + 1);
  const struct disc_line bottom = disc_line_at(radius, y), top = disc_line_at(radius, y + 1);
  return disc_corner_area(radius, &left, &bottom) - disc_corner_area(radius, &right, &bottom) -
         disc_corner_area(radius, &left, &top) + disc_corner_area(radius, &right, &top);
}
