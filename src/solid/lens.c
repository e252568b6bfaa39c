#include "solid/lens.h"

#include "solid/segment.h"

#include <math.h>

/* Area of the segment of a disc beyond a chord at signed distance x from its centre: sector less triangle. */
static double disc_segment(double radius, double half_chord, double x)
{
  if (x > 0 && half_chord <= radius / 2) return radius * radius * unit_segment(half_chord / radius);
  return radius * radius * atan2(half_chord, x) - x * half_chord;
}

struct lens lens_of_discs(double ra, double rb, double d)
{
  if (d >= ra + rb) return (struct lens){0, 0};
  const double smaller = fmin(ra, rb);
  if (d <= fabs(ra - rb)) return (struct lens){M_PI * smaller * smaller, 0};
  const double product = (ra + rb - d) * (d + ra - rb) * (d - ra + rb) * (d + ra + rb);
  const double half_chord = sqrt(product) / (2 * d);
  if (ra == rb) return (struct lens){2 * disc_segment(ra, half_chord, d / 2), 2 * half_chord};
  const double xa = (d * d + (ra - rb) * (ra + rb)) / (2 * d), xb = d - xa;
  return (struct lens){disc_segment(ra, half_chord, xa) + disc_segment(rb, half_chord, xb), 2 * half_chord};
}

struct lens lens_of_wall(double radius, double d)
{
  if (d >= radius) return (struct lens){0, 0};
  if (d <= -radius) return (struct lens){M_PI * radius * radius, 0};
  const double half_chord = sqrt((radius - d) * (radius + d));
  return (struct lens){disc_segment(radius, half_chord, d), 2 * half_chord};
}
