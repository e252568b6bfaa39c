#include "solid/lens.h"

#include <math.h>

/* Area asin(s) - s sqrt(1 - s^2) of the segment of a unit disc with half chord s <= 1/4: s^3 times a polynomial in
 * z = s^2, interpolated at Chebyshev points from the series 2/3 + z/5 + 3 z^2/28 + ...; relative error 4e-18. */
static inline double small_segment(double s)
{
  const double z = s * s;
  double p = 0.026432541100717914;
  p = p * z + 0.023936430985272154;
  p = p * z + 0.030123858498508835;
  p = p * z + 0.03785887025065117;
  p = p * z + 0.04971594631909841;
  p = p * z + 0.0694444439896265;
  p = p * z + 0.10714285714563496;
  p = p * z + 0.1999999999999935;
  p = p * z + 2.0 / 3;
  return s * z * p;
}

/* Area of the segment of a disc beyond a chord at signed distance x from its centre: sector less triangle. */
static double disc_segment(double radius, double half_chord, double x)
{
  if (x > 0 && half_chord <= radius / 4) return radius * radius * small_segment(half_chord / radius);
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
