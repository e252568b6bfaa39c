/* Places of a disc's centre within a cell. What a disc feels depends on where it stands on the grid, most of all on whether
 * its centre lies on a corner of cells, which a scene laid out in whole cells does: an error at one place says little.
 *
 * The places are the 3 x 3 lattice of offsets 0, 1/4 and 1/2 of a cell from a corner of cells. Where mirror images of a place
 * in x and in y have the same error, these are the sixteen places of a 4 x 4 lattice over the cell, of which each place
 * stands for one, two or four: its weight. The lattice has the places of highest symmetry (corner, middle of an edge, middle
 * of the cell), where errors are largest or least. */
#ifndef DELBM_BENCH_PLACES_H
#define DELBM_BENCH_PLACES_H

enum { PLACES = 9 };

struct offset {
  double x, y;   /* cells, from a corner of cells */
  double weight; /* all weights add up to 1 */
};

/* 0 <= k < PLACES; the first is the corner itself. */
struct offset place_offset(int k);

/* Deviations from a known answer over places. */
struct deviations {
  double mean;  /* of the deviations, with their sign: what a disc that crosses cells has on average */
  double error; /* mean of their absolute values */
  double worst; /* the largest absolute value */
};

/* Adds a deviation; NAN makes all of them NAN. */
void deviations_add(struct deviations *all, double deviation, double weight);

#endif
