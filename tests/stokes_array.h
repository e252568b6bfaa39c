/* Exact drag K = F/(mu U) of a disc in a periodic array in slow flow: the reference for arrays of any solid fraction.
 *
 * The stream function is a series of biharmonic functions about a disc that satisfy no slip on it; its coefficients
 * follow from periodicity between opposite edges of the lattice's cell (least squares). F is the pressure gradient times
 * the area of the cell, U the mean velocity over the cell. */
#ifndef DELBM_TESTS_STOKES_ARRAY_H
#define DELBM_TESTS_STOKES_ARRAY_H

enum stokes_lattice { STOKES_SQUARE, STOKES_HEXAGONAL };

double stokes_array_drag(enum stokes_lattice lattice, double solid_fraction);

/* Solid fraction of discs that touch. */
double stokes_array_touching(enum stokes_lattice lattice);

#endif
