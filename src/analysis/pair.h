/* Sedimentation of two discs, one above the other: drafting, kissing, tumbling. Heights are against gravity along
 * -y; `trailing` is the disc that starts higher. Times are in steps, found between snapshots by a straight line; NAN
 * for an event that does not occur. */
#ifndef DELBM_ANALYSIS_PAIR_H
#define DELBM_ANALYSIS_PAIR_H

#include "analysis/history.h"
#include "model/scene.h"

/* Speeds this close, as a part of the faster, count as equal. */
static const double pair_even = 0.02;

struct pair {
  double draft_time, draft_speed;    /* largest speed of trailing before the kiss; its vy */
  double kiss_time;                  /* centres first less than the sum of the radii apart */
  double even_time;                  /* speeds are equal after drafting */
  double tumble_time, tumble_height; /* trailing first no higher than leading, and where */
  double throw_time, throw_speed;    /* leading moves fastest sideways, of all the run: vx */
  double slow_time, slow_speed;      /* leading falls slowest after it was thrown: vy */
  double offset;                     /* |x_trailing - x_leading| at the kiss, cells */
  double wall_time, wall_distance;   /* leading's centre nearest to a side wall after it was thrown, cells */
};

/* True for two free discs in fluid, one higher than the other, under gravity along -y. */
bool pair_applies(const struct scene *scene);
struct pair pair_analyse(const struct scene *scene, const struct history *history);

#endif
