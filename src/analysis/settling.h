/* Many discs settling: interface, layers, concentration, mixing. Heights are against gravity's axis y, from the bottom
 * of the box.
 *
 *   interface      mean height of the highest sqrt(N) of N discs: about one row of a square packing
 *   fit            line through the interface while it has fallen by 10 % to 70 % of its whole fall
 *   bands          five groups of equal size by initial height: the mean height of each
 *   layers         l = 1 .. N_l from the bottom, four mean radii high, the highest cut off by the box. A disc is in the
 *                  layer of its centre
 *   concentration  share of the area of a layer that discs cover: exact
 *   lambda         the mixing index (25) of Zhang et al. (2017): with l_0 a disc's layer at the first snapshot and
 *                  zeta = l_0/N_l, Lambda_l is the mean zeta of the discs that are in layer l now. At the first snapshot
 *                  it is l/N_l, the diagonal; where discs of every height are mixed it does not depend on l
 *   settled        the interface falls over the last tenth of the snapshots (two at least) at no more than settling_rest
 *                  of its fitted speed. Else there is no sediment yet: bed, front and what depends on them are NAN
 *   bed            mean concentration of the layers that reach into the second and third quarter of the final
 *                  interface's height
 *   mixing         of the bands, 0 where every square holds discs of one band and 1 where the shares of the bands in the
 *                  squares are as even as chance leaves them: Lacey's (S0^2 - S^2)/(S0^2 - SR^2), with S^2 the variance
 *                  of a band's share over squares of 10 mean radii, each weighted by its discs, S0^2 = p (1 - p) that of
 *                  full segregation and SR^2 = S0^2/n that of chance with n discs a square; mean over bands
 *   front          surface of the sediment: where, from the interface downwards, concentration first reaches the mean of
 *                  the initial one and the bed's, linear between the middles of layers */
#ifndef DELBM_ANALYSIS_SETTLING_H
#define DELBM_ANALYSIS_SETTLING_H

#include "analysis/fit.h"
#include "analysis/history.h"
#include "model/scene.h"

/* Part of the speed of the interface at which a bed may still give way. */
static const double settling_rest = 0.2;

enum { SETTLING_BANDS = 5, SETTLING_LEAST = 20 };

struct settling {
  size_t snapshots, layers;
  double layer, box;                  /* heights of a layer and of the box, cells */
  const int64_t *step;                /* the history's */
  double *interface, *front, *mixing; /* [snapshots] */
  double (*band)[SETTLING_BANDS];     /* [snapshots] mean height, from the lowest */
  double *concentration;              /* [snapshots][layers] */
  double *lambda;                     /* [snapshots][layers]; NAN without discs */
  double initial;                     /* mean concentration of the region that the discs fill at first */
  bool settled;
  double bed;               /* of the last snapshot */
  struct line fall;         /* interface over steps, in the fitted part */
  struct line rise;         /* sediment's surface over steps, in the same part */
  double sharpness;         /* height over which concentration goes from 25 % to 75 % of the way between the
                                              initial and the bed's, mean over the fitted part, cells */
  struct line lambda_bed;   /* Lambda over height/box height in the sediment, last snapshot */
  struct line lambda_above; /* likewise between sediment and interface, when the interface has fallen half */
  double restless;          /* fastest disc of the last snapshot, cells/step */
};

/* True where gravity acts along -y on enough free discs for this to make sense. */
bool settling_applies(const struct scene *scene);
bool settling_create(struct settling *settling, const struct scene *scene, const struct history *history,
                     struct status *status);
/* Height of the middle of layer `layer`, counted from 0. */
static inline double settling_height(const struct settling *s, size_t layer)
{
  return ((double)layer + 0.5) * s->layer;
}

void settling_destroy(struct settling *settling);

#endif
