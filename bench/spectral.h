/* A pseudo-spectral solver of the incompressible Navier-Stokes equations in the unit square, periodic: the reference
 * for flows without an exact solution.
 *
 * The vorticity w obeys w_t + u . grad w = nu lap w, with u from the stream function -lap psi = w. Derivatives are
 * taken of Fourier coefficients (FFTW) and products at n x n points; coefficients beyond n/3 are dropped, so that no
 * product is aliased. Time steps are fourth-order Runge-Kutta in exp(nu k^2 t) w, which makes the viscous part
 * exact. */
#ifndef DELBM_BENCH_SPECTRAL_H
#define DELBM_BENCH_SPECTRAL_H

#include "base/status.h"

struct spectral;

bool spectral_create(struct spectral **spectral, int n, double viscosity, struct status *status);
void spectral_destroy(struct spectral *spectral);

/* The initial vorticity, of zero mean. */
void spectral_start(struct spectral *spectral, double (*vorticity)(double x, double y));

bool spectral_advance(struct spectral *spectral, double step, int steps, struct status *status);

/* Pressure: at density 1, with zero mean. */
enum spectral_quantity { SPECTRAL_UX, SPECTRAL_UY, SPECTRAL_UX_X, SPECTRAL_UX_Y, SPECTRAL_UY_X, SPECTRAL_PRESSURE };

/* Values of the Fourier series at the centres of count x count cells, row by row from the bottom. */
bool spectral_sample(struct spectral *spectral, enum spectral_quantity quantity, int count, double *values,
                     struct status *status);

#endif
