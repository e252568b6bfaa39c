/* The exact area of the intersection of a disc and a cell, in closed form.
 *
 * With the centre at the origin, let area(a, b) be the area of the disc's part {x > a, y > b}. The area in a cell is
 * the alternating sum of area(a, b) over the four corners. For a corner inside the disc the variables separate,
 *   area(a, b) = pi R^2/4 - D(a) - D(b) + a b,   D(t) = (R^2 asin(t/R) + t sqrt(R^2 - t^2))/2,
 * and outside the disc area(a, b) depends on the quadrant of the corner. So a disc costs one arcsine per grid line;
 * each corner serves four cells. D is continued beyond the disc by its values at +-R. */
#ifndef DELBM_BENCH_DISC_AREA_H
#define DELBM_BENCH_DISC_AREA_H

#include <math.h>

/* A grid line at signed distance t from the centre. */
struct disc_line {
  double t;
  double half_chord; /* sqrt(R^2 - t^2), 0 outside */
  double area;       /* D(t) */
};

static inline struct disc_line disc_line_at(double radius, double t)
{
  if (fabs(t) >= radius) return (struct disc_line){t, 0, copysign(M_PI / 4 * radius * radius, t)};
  const double h = sqrt((radius - t) * (radius + t));
  /* near +-R the arcsine of t/R would turn round-off into its root, 1e-8 */
  const double angle = fabs(t) < h ? asin(t / radius) : copysign(M_PI / 2 - asin(h / radius), t);
  return (struct disc_line){t, h, 0.5 * (radius * radius * angle + t * h)};
}

/* area(a, b) for the corner of the lines x = a and y = b. */
static inline double disc_corner_area(double radius, const struct disc_line *a, const struct disc_line *b)
{
  if (fabs(a->t) < b->half_chord) return M_PI / 4 * radius * radius - a->area - b->area + a->t * b->t;
  const double right = M_PI / 2 * radius * radius - 2 * a->area; /* of the part x > a */
  const double above = M_PI / 2 * radius * radius - 2 * b->area;
  if (a->t >= 0) return b->t >= 0 ? 0 : right;
  return b->t >= 0 ? above : right + above - M_PI * radius * radius;
}

/* Area of the intersection of a disc centred at (0, 0) and the unit square with lower left corner (x, y). Evaluates
 * four corners for each cell; disc_kernel.c is the fast form. */
double disc_cell_area(double radius, double x, double y);

#endif
