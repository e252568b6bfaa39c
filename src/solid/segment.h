/* Area of the segment of a unit disc beyond a short chord. */
#ifndef DELBM_SOLID_SEGMENT_H
#define DELBM_SOLID_SEGMENT_H

/* Area asin(s) - s sqrt(1 - s^2) for the half chord s <= 1/2, centre on the other side: s^3 times a polynomial in z = s^2,
 * interpolated at Chebyshev points from the series 2/3 + z/5 + 3 z^2/28 + ...; relative error 4e-17. */
static inline double unit_segment(double s)
{
  const double z = s * s;
  double p = 0.059548534083841635;
  p = p * z - 0.030577907902097343;
  p = p * z + 0.03617288663735624;
  p = p * z + 0.0116029226819415;
  p = p * z + 0.02183131088045703;
  p = p * z + 0.02449378375582003;
  p = p * z + 0.030091284745622317;
  p = p * z + 0.03785980896026;
  p = p * z + 0.04971593770777089;
  p = p * z + 0.06944444381243556;
  p = p * z + 0.10714285715008443;
  p = p * z + 0.19999999999996762;
  p = p * z + 2.0 / 3;
  return s * z * p;
}

#endif
