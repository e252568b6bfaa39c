/* Samples of the flow: every `stride`-th cell of a region of the box, in x and in y. */
#ifndef DELBM_SIM_SAMPLE_H
#define DELBM_SIM_SAMPLE_H

#include "base/status.h"
#include "model/scene.h"

struct sample_grid {
  int first[2]; /* cell of the first sample */
  int count[2]; /* samples in x and in y */
  int stride;   /* cells from one to the next */
};

/* One value a sample, row by row from the bottom: arrays of count[0] * count[1]; any may be NULL. */
struct sample {
  double *rho;        /* density; 1 at rest */
  double *velocity;   /* three numbers each: ux, uy, 0 */
  double *vorticity;  /* d(uy)/dx - d(ux)/dy, from the neighbouring cells at any stride */
  double *pressure;   /* above the pressure at rest: (rho - 1)/3 */
  double *occupation; /* occupation fraction: part of the cell's area inside discs, of the hydraulic radius */
};

/* The grid of output.fields. */
struct sample_grid sample_grid_of(const struct scene *scene);

static inline size_t sample_points(const struct sample_grid *grid)
{
  return (size_t)grid->count[0] * (size_t)grid->count[1];
}

struct populations;
struct fluid_force;
struct occupation;
struct discs;

/* Outside of parallel regions. `periodic`: of each axis. `occupation`: of `discs`; NULL in a scene without discs.
 * Fails only for want of memory. */
bool sample_take(const struct populations *populations, const bool periodic[2], const struct fluid_force *force,
                 const struct occupation *occupation, const struct discs *discs, const struct sample_grid *grid,
                 const struct sample *sample, struct status *status);

#endif
