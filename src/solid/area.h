/* Areas of the cells that a disc covers, row by row, by line tables (disc_area.h): the arithmetic of the occupation
 * stage, compiled per instruction set from one source (area_kernel.c). Of a disc wider
 * than one line table only the rim is evaluated: cells within it are covered whole. */
#ifndef DELBM_SOLID_AREA_H
#define DELBM_SOLID_AREA_H

#include "fluid/weight.h"

#include <stdint.h>

enum {
  AREA_PAD = 8,   /* elements past the last cell that area_rows may write */
  AREA_ROWS = 24, /* rows in one call, at most */
};

/* Which cells a disc covers in each of some rows: first .. end - 1, counted from the column of its leftmost cell; those
 * from full to full_end - 1 are covered whole. */
struct area_extents {
  int32_t first[AREA_ROWS], end[AREA_ROWS], full[AREA_ROWS], full_end[AREA_ROWS];
};

/* Extents of rows first_row .. first_row + rows - 1 of the lattice, each of which the disc at (x, y) touches. */
typedef void area_extents(double radius, double x, double y, int first_row, int rows, struct area_extents *extents);

/* eps of the cells of the rows from_row .. end_row - 1 of those extents, one row after another. */
typedef void area_rows(double radius, double x, double y, int first_row, int from_row, int end_row,
                       const struct area_extents *extents, double *eps);

/* The weights B of `count` cells. Up to AREA_PAD - 1 elements past them are read and written. */
typedef void area_weights(const double *eps, int count, struct weight_law law, double *weight);

struct area_kernel {
  area_extents *extents;
  area_rows *rows;
  area_weights *weights;
};

/* The kernel of the instruction set that a sweep kernel's name begins with (baseline, avx2, avx512); with NULL the
 * best. */
const struct area_kernel *area_find(const char *name);

#endif
