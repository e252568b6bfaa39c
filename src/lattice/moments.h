/* The paper's moments (2) and their equilibria (4), written out: the reference for tests of the fast kernel. */
#ifndef DELBM_LATTICE_MOMENTS_H
#define DELBM_LATTICE_MOMENTS_H

#include "lattice/d2q9.h"

/* rho, e, eps, jx, qx, jy, qy, pxx, pxy */
enum moment { M_RHO, M_E, M_EPS, M_JX, M_QX, M_JY, M_QY, M_PXX, M_PXY };

/* Rows are orthogonal; moments_norm is the square of each row's length. */
static const double moments_matrix[Q][Q] = {
    {1, 1, 1, 1, 1, 1, 1, 1, 1},    {-4, -1, -1, -1, -1, 2, 2, 2, 2}, {4, -2, -2, -2, -2, 1, 1, 1, 1},
    {0, 1, 0, -1, 0, 1, -1, -1, 1}, {0, -2, 0, 2, 0, 1, -1, -1, 1},   {0, 0, 1, 0, -1, 1, 1, -1, -1},
    {0, 0, -2, 0, 2, 1, 1, -1, -1}, {0, 1, -1, 1, -1, 0, 0, 0, 0},    {0, 0, 0, 0, 0, 1, -1, 1, -1}};
static const double moments_norm[Q] = {9, 36, 36, 6, 12, 6, 12, 4, 4};

static inline void moments_from_populations(const double f[Q], double m[Q])
{
  for (int k = 0; k < Q; k++) {
    m[k] = 0;
    for (int i = 0; i < Q; i++) m[k] += moments_matrix[k][i] * f[i];
  }
}

static inline void populations_from_moments(const double m[Q], double f[Q])
{
  for (int i = 0; i < Q; i++) {
    f[i] = 0;
    for (int k = 0; k < Q; k++) f[i] += moments_matrix[k][i] * m[k] / moments_norm[k];
  }
}

static inline void moments_equilibrium(double rho, double jx, double jy, double m[Q])
{
  const double j2 = (jx * jx + jy * jy) / rho;
  m[M_RHO] = rho;
  m[M_E] = -2 * rho + 3 * j2;
  m[M_EPS] = rho - 3 * j2;
  m[M_JX] = jx;
  m[M_QX] = -jx;
  m[M_JY] = jy;
  m[M_QY] = -jy;
  m[M_PXX] = (jx * jx - jy * jy) / rho;
  m[M_PXY] = jx * jy / rho;
}

#endif
