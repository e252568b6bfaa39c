/* Areas of a whole disc by line tables (disc_area.h), a row at a time: the arithmetic of the occupation stage, compiled
 * per instruction set from one source (area_kernel.c). Arrays are padded to whole vectors: AREA_PAD elements past their
 * count may be read and written. */
#ifndef DELBM_SOLID_AREA_H
#define DELBM_SOLID_AREA_H

enum { AREA_PAD = 16 };

/* Grid lines k = 0 .. count - 1 at integer places first + k, seen from a centre at `centre`: distance t, half chord h
 * (0 beyond the disc) and D(t). */
typedef void area_lines(double radius, double centre, int first, int count, double *t, double *h, double *area);

/* area(a, b) of the corners of lines a = 0 .. count - 1 (t, area) and the one line b. */
typedef void area_corners(double radius, double t_b, double h_b, double area_b, int count, const double *t,
                          const double *area, double *corner);

/* eps of cells first .. end - 1 between two lines of corners; those from full to full_end - 1 are covered. */
typedef void area_cells(const double *low, const double *high, int first, int end, int full, int full_end, double *eps);

/* B(eps) (19) of `count` cells. */
typedef void area_weights(const double *eps, int count, double three_nu, double *weight);

struct area_kernel {
  area_lines *lines;
  area_corners *corners;
  area_cells *cells;
  area_weights *weights;
};

/* The kernel of the instruction set that a sweep kernel's name begins with (baseline, avx2, avx512); with NULL the
 * best. */
const struct area_kernel *area_find(const char *name);

#endif
