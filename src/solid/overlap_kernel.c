/* Overlaps of discs as contacts, compiled once per instruction set (VARIANT). The contact point lies on the line of
 * centres, at the chord of the lens.
 *
 * Lens of two discs at distance d: arms a = (d + (R_a - R_b)(R_a + R_b)/d)/2 and d - a, half chord s with
 * 4 d^2 s^2 = (R_a + R_b - d)(d + R_a - R_b)(d - R_a + R_b)(d + R_a + R_b), area the sum of two segments. A segment with
 * s <= R/2, centre on the other side of the chord, is a polynomial (segment.h); the few deeper ones are computed one by
 * one. If one disc is inside the other, the contact point is the centre of the smaller disc, and the chord 0. */
#include "base/variant.h"
#include "solid/disc.h"
#include "solid/segment.h"

#include <math.h>

extern shape_overlaps KERNEL(disc_overlaps), KERNEL(disc_overlaps_half_plane);

/* Area of the segment of a disc beyond a chord at signed distance `arm` from its centre. */
static double deep_segment(double radius, double half_chord, double arm)
{
  return radius * radius * atan2(half_chord, arm) - arm * half_chord;
}

/* Adds the segments of the discs of radius[k] to the areas. No variable of the loop is narrower than its elements: else a vector
 * has more than VECTOR elements and the loop a remainder, in which a compiler may fuse other products. */
static inline void add_segments(int n, const double *restrict radius, const double *restrict arm,
                                const double *restrict chord, double *restrict area)
{
  double deep[BODY_PAIRS], any = 0;
#pragma omp simd reduction(+ : any)
  for (int k = 0; k < n; k++) {
    const double s = 0.5 * chord[k] / radius[k];
    const bool is_deep = s > 0.5 || arm[k] < 0;
    const double segment = radius[k] * radius[k] * unit_segment(s < 0.5 ? s : 0.5);
    deep[k] = is_deep;
    area[k] += is_deep ? 0 : segment;
    any += deep[k];
  }
  for (int k = 0; any > 0 && k < n; k++)
    if (deep[k] > 0) area[k] += deep_segment(radius[k], 0.5 * chord[k], arm[k]);
}

void KERNEL(disc_overlaps)(const struct body_pairs *pairs, struct body_overlaps *o)
{
  const int n = pairs->count;
  const double *restrict ra = pairs->radius[0], *restrict rb = pairs->radius[1];
#pragma omp simd
  for (int k = 0; k < n; k++) {
    const double dx = pairs->dx[k], dy = pairs->dy[k], d = sqrt(dx * dx + dy * dy);
    const double inverse = d > 0 ? 1 / d : 0, sum = ra[k] + rb[k], difference = ra[k] - rb[k];
    const double wider = difference > 0 ? difference : -difference, gap = sum > d ? sum - d : 0;
    const bool inside = d <= wider;
    const double product = gap * (d + difference) * (d - difference) * (d + sum);
    const double arm = 0.5 * (d + difference * sum * inverse), centre = difference > 0 ? d : 0;
    o->depth[k] = sum - d;
    o->nx[k] = d > 0 ? dx * inverse : 1;
    o->ny[k] = d > 0 ? dy * inverse : 0;
    o->arm[0][k] = inside ? centre : arm;
    o->arm[1][k] = d - o->arm[0][k];
    o->chord[k] = inside || product < 0 ? 0 : sqrt(product) * inverse;
    o->area[k] = 0;
  }
  if (!pairs->with_area) return;
  add_segments(n, ra, o->arm[0], o->chord, o->area);
  add_segments(n, rb, o->arm[1], o->chord, o->area);
#pragma omp simd
  for (int k = 0; k < n; k++) {
    const double smaller = ra[k] < rb[k] ? ra[k] : rb[k], wider = ra[k] > rb[k] ? ra[k] - rb[k] : rb[k] - ra[k];
    const bool inside = ra[k] + rb[k] - o->depth[k] <= wider;
    o->area[k] = inside ? M_PI * smaller * smaller : o->area[k];
  }
}

void KERNEL(disc_overlaps_half_plane)(const struct body_pairs *pairs, struct body_overlaps *o)
{
  const int n = pairs->count;
  const double *restrict radius = pairs->radius[0];
#pragma omp simd
  for (int k = 0; k < n; k++) {
    const double d = pairs->distance[k], r = radius[k], product = (r - d) * (r + d);
    o->depth[k] = r - d;
    o->nx[k] = pairs->dx[k];
    o->ny[k] = pairs->dy[k];
    o->arm[0][k] = d;
    o->arm[1][k] = 0;
    o->chord[k] = product > 0 ? 2 * sqrt(product) : 0;
    o->area[k] = 0;
  }
  if (!pairs->with_area) return;
  add_segments(n, radius, o->arm[0], o->chord, o->area);
}
