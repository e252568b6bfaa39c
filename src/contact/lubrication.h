/* Sub-grid lubrication: the part of the force between two close surfaces that the lattice does not resolve.
 *
 * Exact forces. For two discs, or a disc and a side (1/R_b = 0), at a gap h in unbounded Stokes flow of viscosity mu,
 * with cosh s = 1 + h (1/R_a + 1/R_b) + h^2/(2 R_a R_b) (s is the difference of the bipolar coordinates of both
 * surfaces),
 *   approach:     F = 4 pi mu v/(s - tanh s),   v the approach speed, any radii;
 *   slip:         F = 2 pi mu v_s/s + O(s),     v_s the slip speed of the surfaces at the contact point;
 *   entrainment:  G = 8 pi mu v_e/s + O(s),     v_e their mean speed in the frame that turns with the line of centres.
 * Approach of a disc to a wall: Jeffrey & Onishi 1981, as are sliding, F = 4 pi mu V/s, and spin, torque 4 pi mu omega
 * R^2/tanh s; sliding has v_s = V, v_e = -V/2, spin has v_s = omega R, v_e = omega R/2. For two discs the
 * stream function sin(beta) (A cosh 2 alpha + B sinh 2 alpha + C alpha + D)/(cosh alpha - cos beta) in bipolar coordinates
 * satisfies no slip on both, which gives the force above.
 *
 * Resolved forces. Partly covered cells smooth the surfaces, so that the lattice resolves the gap h as a gap H >= h,
 *   H^2 = h^2 + q.
 * q in cells^2 is independent of the radii; measured by `delbm bench lubrication` for the form midpoint.
 *
 * Model. The coefficient L(h) - L(H) less its value at the cut-off, L the exact force per speed. Zero from the cut-off
 * on; below the least gap, a part of the smaller radius (roughness), constant; 0 in contact, where the contact law acts.
 * Each coefficient is at least 0: the model dissipates energy and never returns any. */
#ifndef DELBM_CONTACT_LUBRICATION_H
#define DELBM_CONTACT_LUBRICATION_H

#include "base/variant.h"

#include <math.h>

struct lubrication {
  double viscosity; /* mu */
  double cutoff;    /* gap, cells; 0: no lubrication */
  double least_gap; /* part of the smaller radius */
};

/* Forces per speed: per approach speed, per v_s, per v_e. */
struct lubrication_coefficients {
  double normal, slip, entrainment;
};

/* 2 (cosh s - 1) of a gap. */
static inline __attribute__((always_inline)) double lubrication_opening(double gap, double inverse_a, double inverse_b)
{
  return gap * (2 * (inverse_a + inverse_b) + gap * inverse_a * inverse_b);
}

/* 1/s^2; relative error below 1e-4 for s < 1 and 1 % for s < 2. Pade approximant of arcosh(1 + x)^2 = 2x - x^2/3 + 4 x^3/45 - ... */
static inline __attribute__((always_inline)) double lubrication_inverse_s2(double opening)
{
  const double x = 0.5 * opening;
  return (1 + x * (4.0 / 15)) / (opening * (1 + 0.1 * x));
}

/* 1/(s - tanh s) = 3/s^3 + 6/(5 s) - 0.006 s + ... from 1/s^2; error as above. */
static inline __attribute__((always_inline)) double lubrication_squeeze(double inverse_s2)
{
  return sqrt(inverse_s2) * (3 * inverse_s2 + 1.2);
}

/* The difference of 1/s between a gap and the gap that the lattice resolves. */
static inline __attribute__((always_inline)) double lubrication_shear_defect(double gap, double q, double inverse_a,
                                                                             double inverse_b)
{
  const double exact = lubrication_inverse_s2(lubrication_opening(gap, inverse_a, inverse_b));
  const double resolved = lubrication_inverse_s2(lubrication_opening(sqrt(gap * gap + q), inverse_a, inverse_b));
  return sqrt(exact) - sqrt(resolved);
}

static inline __attribute__((always_inline)) double lubrication_squeeze_defect(double gap, double q, double inverse_a,
                                                                               double inverse_b)
{
  const double exact = lubrication_inverse_s2(lubrication_opening(gap, inverse_a, inverse_b));
  const double resolved = lubrication_inverse_s2(lubrication_opening(sqrt(gap * gap + q), inverse_a, inverse_b));
  return lubrication_squeeze(exact) - lubrication_squeeze(resolved);
}

/* q of approach, slip and entrainment. Cells of a pair smooth both surfaces. A wall lies on faces of cells, where it is
 * exact; only the disc is smoothed, and the difference vanishes above 2 cells in approach and 0.27 cells in entrainment.
 * Slip: in cells between surfaces the damping of at least 1/2 (fluid/weight.h) does not distinguish gaps below f = 3
 * mu/(2 + 3 mu); at larger gaps the lattice resolves slip, by up to 15 % too much at walls. */
struct lubrication_defects {
  double normal, slip, entrainment;
};

static inline __attribute__((always_inline)) struct lubrication_defects
lubrication_defects(double gap, double viscosity, double inverse_b)
{
  const double f = 3 * viscosity / (2 + 3 * viscosity);
  const double wall = inverse_b > 0 ? 0 : 1, pair = 1 - wall;
  const double slip = pair * 0.46 + wall * 0.25, slip_range = (pair * 1.35 + wall * 0.75) * f;
  return (struct lubrication_defects){
      .normal = pair * 0.24 + wall * 0.20 * max_of(0, 1 - gap / 2),
      .slip = slip * f * f * max_of(0, 1 - gap / slip_range),
      .entrainment = pair * 0.10 + wall * 0.085 * max_of(0, 1 - gap / 0.27),
  };
}

/* L(h) - L(H). */
static inline __attribute__((always_inline)) struct lubrication_coefficients
lubrication_unresolved(double gap, double viscosity, double inverse_a, double inverse_b)
{
  const struct lubrication_defects q = lubrication_defects(gap, viscosity, inverse_b);
  return (struct lubrication_coefficients){
      .normal = 4 * M_PI * viscosity * lubrication_squeeze_defect(gap, q.normal, inverse_a, inverse_b),
      .slip = 2 * M_PI * viscosity * lubrication_shear_defect(gap, q.slip, inverse_a, inverse_b),
      .entrainment = 8 * M_PI * viscosity * lubrication_shear_defect(gap, q.entrainment, inverse_a, inverse_b),
  };
}

/* The coefficients at a gap (negative: an overlap) of discs of radius 1/inverse_a and 1/inverse_b (0: a side). */
static inline __attribute__((always_inline)) struct lubrication_coefficients
lubrication_at(const struct lubrication *l, double gap, double inverse_a, double inverse_b)
{
  const double least = l->least_gap / max_of(inverse_a, inverse_b);
  const double open = gap > 0 ? 1 : 0, bounded = min_of(max_of(gap, least), l->cutoff);
  const struct lubrication_coefficients here = lubrication_unresolved(bounded, l->viscosity, inverse_a, inverse_b),
                                        end = lubrication_unresolved(l->cutoff, l->viscosity, inverse_a, inverse_b);
  return (struct lubrication_coefficients){.normal = open * max_of(0, here.normal - end.normal),
                                           .slip = open * max_of(0, here.slip - end.slip),
                                           .entrainment = open * max_of(0, here.entrainment - end.entrainment)};
}

#endif
