/* Many discs settling: interface, layers, concentration, mixing. Heights are against gravity's axis y, from the bottom
 * of the box.
 *
 *   interface      mean height of the highest sqrt(N) of N discs: about one row of a square packing
 *   fit            line through the interface while it has fallen by 10 % to 70 % of its whole fall
 *   layers         five groups of equal size by initial height: the mean height of each
 *   concentration  share of the area of a slab of the box, one slab four mean radii high, that discs cover: exact
 *   bed            mean concentration between a quarter and three quarters of the final interface's height
 *   mixing         of the layers, 0 where slabs one mean layer high hold one layer each and 1 where the shares of the
 *                  layers in them are as even as chance leaves them: Lacey's (S0^2 - S^2)/(S0^2 - SR^2), with S^2 the
 *                  variance of a layer's share over squares of 10 mean radii, each weighted by its discs, S0^2 = p (1 -
 *                  p) that of full segregation and SR^2 = S0^2/n that of chance with n discs a square; mean over layers
 *   front          where, coming from below, concentration first falls under half-way from the bed to the initial one:
 *                  the surface of the sediment */
#ifndef DELBM_ANALYSIS_SETTLING_H
#define DELBM_ANALYSIS_SETTLING_H

#include "analysis/fit.h"
#include "analysis/history.h"
#include "scene/scene.h"

enum { SETTLING_LAYERS = 5, SETTLING_LEAST = 20 };

struct settling {
  size_t snapshots, slabs;
  double slab;                        /* height of a slab, cells */
  const int64_t *step;                /* the history's */
  double *interface, *front, *mixing; /* [snapshots] */
  double (*layer)[SETTLING_LAYERS];   /* [snapshots] mean height, from the lowest */
  double *concentration;              /* [snapshots][slabs] */
  double initial;                     /* mean concentration of the region that the discs fill at first */
  double bed;                         /* of the last snapshot */
  struct line fall;                   /* interface over steps, in the fitted part */
  struct line rise;                   /* sediment's surface over steps, in the same part */
  double sharpness;                   /* height over which concentration goes from 25 % to 75 % of the way between the
                                              initial and the bed's, mean over the fitted part, cells */
  double restless;                    /* fastest disc of the last snapshot, cells/step */
};

/* True where gravity acts along -y on enough free discs for this to make sense. */
bool settling_applies(const struct scene *scene);
bool settling_create(struct settling *settling, const struct scene *scene, const struct history *history,
                     struct status *status);
void settling_destroy(struct settling *settling);

#endif
