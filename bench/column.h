/* Column of discs that collapses: scene shared by bench grains and tests.
 *
 * Half a column: the side x = 0 is smooth (slip) and thus an axis of symmetry. Discs of radii R (1 +- 0.2), uniform, R = 5,
 * are poured without friction between smooth sides at x = 0 and x_0 and come to rest. Then the side at x_0 is removed at once, and
 * the discs and the ground have friction. */
#ifndef DELBM_BENCH_COLUMN_H
#define DELBM_BENCH_COLUMN_H

#include "model/scene.h"

static const double column_radius = 5;

struct column {
  int discs;
  double aspect; /* wanted H_0/x_0 */
  double friction, rolling_friction, restitution;
  bool rough; /* the ground is a row of fixed discs that touch; else a plane with the friction of the discs */
  uint64_t seed;
  double viscosity;     /* of fluid; 0: dry */
  double width, height; /* x_0, H_0 */
  double run_out;       /* (x - x_0)/x_0, x the front of the mass at the end */
  double final_height;  /* over x_0 */
  double slope;         /* degrees, of the free surface at the end */
  double time;          /* until 0.95 of the run-out, over sqrt(H_0/g), g less buoyancy */
  double end;           /* the same, until rest */
  size_t apart;         /* discs that are no part of the mass at the end */
  double max_overlap;   /* over the smaller radius, after the release */
};

/* Pours and releases the column, and sets the members after `viscosity`. */
bool column_run(struct column *column, struct status *status);

#endif
