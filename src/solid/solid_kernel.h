/* The arithmetic of the occupation stage, compiled per instruction set from one source (disc_kernel.c). */
#ifndef DELBM_SOLID_SOLID_KERNEL_H
#define DELBM_SOLID_SOLID_KERNEL_H

#include "fluid/weight.h"
#include "solid/shape.h"

/* The weights B of `count` cells of occupation fraction eps. Up to SHAPE_PAD - 1 elements past them are read and
 * written. */
typedef void solid_weights(const double *eps, int count, struct weight_law law, double *weight);

struct solid_kernel {
  struct shape_kind disc;
  solid_weights *weights;
};

/* The kernel for the instruction set at the start of a sweep kernel's name (baseline, avx2, avx512); for NULL the
 * best that the processor supports. */
const struct solid_kernel *solid_kernel_find(const char *name);

#endif
