/* The sweep: collide, immersed moving boundary and stream of one row at a time, in place (see populations.h).
 *
 * A kernel is one body (sweep_kernel.c) compiled per precision and instruction set; literal arguments make its forms:
 * fluid alone or with discs (unified, owen or midpoint), each with constant or adaptive rates, and without a body
 * force, with one, or with one and the sum of momentum. sweep_find chooses one at start-up.
 * */
#ifndef DELBM_FLUID_SWEEP_H
#define DELBM_FLUID_SWEEP_H

#include "fluid/populations.h"
#include "fluid/runs.h"

/* Constants of a step, the same for every cell. */
struct sweep_constants {
  struct rates rates;
  double force[2];   /* body force per unit mass */
  double uniform[2]; /* force per unit volume (zero_flux) */
};

/* The solid in the cells of a row, in the precision of the populations: b[x] = B (weight.h), and B times the
 * velocity of the solid, the sum over owners of w_p B v_p. Zero where no disc is. */
struct solid_row {
  void *b, *bvx, *bvy;
};

/* Terms of a kernel: no force, a body force, or a body force and the sum of momentum. */
enum sweep_terms { SWEEP_NO_FORCE, SWEEP_FORCE, SWEEP_FORCE_AND_SUM, SWEEP_TERMS };

/* Updates n cells whose populations are read from a[i][0..n-1]. `solid` is NULL for fluid alone. A kernel with the sum
 * sets sum[] to the momentum of the cells: the mean of before and after the collision plus F/2, which is the momentum
 * after the collision in fluid alone and rho v inside discs. Other kernels leave sum[] unchanged; it may be NULL. */
typedef void sweep_row(void *const a[Q], int n, const struct sweep_constants *constants, const struct solid_row *solid,
                       double sum[2]);

/* The same for fluid alone without force, from one set of addresses to another. */
typedef void sweep_row_between(void *const from[Q], void *const to[Q], int n, const struct sweep_constants *constants);

/* The sums of each of `count` runs of a row, with populations read from a[i][x]; owner_weight[] has w_p B of the cells of
 * all runs. Up to seven elements past the end of the populations and of owner_weight[] are read. */
typedef void gather_row(void *const a[Q], const struct run *runs, size_t count, const double *owner_weight,
                        struct moment_sums *sums);

/* Fills the solid row of nx cells with `count` runs, from left to right, of discs that move at surface[disc]; up to
 * seven elements past its end are written. */
typedef void paint_row(const struct solid_row *row, int nx, const struct run *runs, size_t count,
                       const double *owner_weight, const struct surface_velocity *surface);

/* True if the rates depend on the fluid's speed. */
static inline bool rates_are_adaptive(const struct rates *rates)
{
  return rates->s_q_fast > 0;
}

/* Largest |j/rho|^2 of n cells; NAN if a cell has a value that is not finite or a density that is not positive. */
typedef double scan_row(void *const a[Q], int n);

struct sweep_kernel {
  const char *name; /* for example avx512-double */
  enum precision precision;
  sweep_row *fluid[2][SWEEP_TERMS];             /* [adaptive rates?][enum sweep_terms] */
  sweep_row *discs[FORM_COUNT][2][SWEEP_TERMS]; /* [enum coupling_form][adaptive rates?][enum sweep_terms] */
  sweep_row_between *two_arrays[2];             /* [adaptive rates?] */
  gather_row *gather;
  paint_row *paint;
  scan_row *scan;
};

/* The compiled-in kernels, best first; *runs_here: this machine supports it. NULL past the last. */
const struct sweep_kernel *sweep_kernel_at(size_t index, bool *runs_here);

/* The kernel of that name or, for NULL, the best that this machine supports, in this precision. */
const struct sweep_kernel *sweep_find(const char *name, enum precision precision, struct status *status);

#endif
