/* The D2Q9 lattice in the order of the paper's (5): rest, E N W S, NE NW SW SE. */
#ifndef DELBM_LATTICE_D2Q9_H
#define DELBM_LATTICE_D2Q9_H

enum { Q = 9 };

/* Velocities e_i, opposites (e_opposite[i] = -e_i) and weights w_i. c_s^2 = 1/3. */
static const int d2q9_ex[Q] = {0, 1, 0, -1, 0, 1, -1, -1, 1};
static const int d2q9_ey[Q] = {0, 0, 1, 0, -1, 1, 1, -1, -1};
static const int d2q9_opposite[Q] = {0, 3, 4, 1, 2, 7, 8, 5, 6};
static const double d2q9_weight[Q] = {4. / 9, 1. / 9, 1. / 9, 1. / 9, 1. / 9, 1. / 36, 1. / 36, 1. / 36, 1. / 36};

/* Change of population i by bounce-back from a wall of velocity u at density 1: 6 w_i e_i.u. */
static inline double d2q9_wall_momentum(int i, const double u[2])
{
  return 6.0 * d2q9_weight[i] * (d2q9_ex[i] * u[0] + d2q9_ey[i] * u[1]);
}

#endif
