/* Sedimentation of many discs: interface, layers, concentration, mixing. Heights are measured from the bottom of the
 * box; gravity acts along -y.
 *
 *   interface      mean height of the highest sqrt(N) of N discs: about one row of a square packing
 *   fit            line through the interface while it has fallen by 10 % to 70 % of its whole fall
 *   bands          five groups of equal size by initial height: the mean height of each
 *   layers         l = 1 .. N_l from the bottom, four mean radii high, the highest cut off by the box. A disc belongs
 *                  to the layer of its centre
 *   concentration  exact area fraction of discs in a layer
 *   lambda         the mixing index (25) of Zhang et al. (2017): with l_0 a disc's layer at the first snapshot and
 *                  zeta = l_0/N_l, Lambda_l is the mean zeta of the discs now in layer l. At the first snapshot it is
 *                  l/N_l, the diagonal; after complete mixing it is the same in all layers
 *   settled        true if the interface falls over the last tenth of the snapshots (two at least) at no more than
 *                  settling_rest of its fitted speed. Otherwise there is no sediment yet, and bed, front and all
 *                  figures derived from them are NAN
 *   bed            mean concentration of the layers that reach into the second and third quarter of the final
 *                  interface's height
 *   mixing         Lacey's index (S0^2 - S^2)/(S0^2 - SR^2) of the bands, mean over bands: 0 if every square contains
 *                  one band, 1 for a random mixture. S^2: variance of a band's fraction over squares of 10 mean radii,
 *                  weighted by number of discs; S0^2 = p (1 - p): segregated; SR^2 = S0^2/n: random, n discs a square
 *   front          surface of the sediment: the first height, from the interface downwards, at which the concentration
 *                  reaches the mean of initial and bed concentration, linear between the middles of layers */
#ifndef DELBM_ANALYSIS_SETTLING_H
#define DELBM_ANALYSIS_SETTLING_H

#include "analysis/fit.h"
#include "analysis/history.h"
#include "model/scene.h"

/* Speed of the interface over its fitted speed, below which the bed counts as at rest. */
static const double settling_rest = 0.2;

enum { SETTLING_BANDS = 5, SETTLING_MIN = 20 };

struct settling {
  size_t snapshots, layers;
  double layer, box;                  /* heights of a layer and of the box, cells */
  const int64_t *step;                /* of the history, not owned */
  double *interface, *front, *mixing; /* [snapshots] */
  double (*band)[SETTLING_BANDS];     /* [snapshots] mean height, from the lowest */
  double *concentration;              /* [snapshots][layers] */
  double *lambda;                     /* [snapshots][layers]; NAN without discs */
  double initial;                     /* mean concentration of the region filled at the start */
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

/* True for at least SETTLING_MIN discs, all free, under gravity along -y. */
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
