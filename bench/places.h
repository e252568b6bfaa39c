/* Places of a disc's centre within a cell. The force on a disc depends on its place on the grid, most on whether its
 * centre is on a corner of cells, as in scenes designed in whole cells. An error at one place is therefore not
 * representative.
 *
 * The places are the 3 x 3 lattice of offsets 0, 1/4 and 1/2 of a cell from a corner of cells. If mirror images of a
 * place in x and in y have the same error, they represent the 4 x 4 lattice over the cell; the weight of a place is
 * the number of its images (1, 2 or 4) over 16. The lattice has the places of highest symmetry (corner, middle of an
 * edge, middle of the cell), where errors are extreme. */
#ifndef DELBM_BENCH_PLACES_H
#define DELBM_BENCH_PLACES_H

enum { PLACES = 9 };

struct offset {
  double x, y;   /* cells, from a corner of cells */
  double weight; /* all weights add up to 1 */
};

/* 0 <= k < PLACES; place 0 is the corner. */
struct offset place_offset(int k);

/* Statistics of deviations from a known solution over places. */
struct deviations {
  double mean;  /* of deviations with sign: the mean error of a disc that crosses cells */
  double error; /* mean absolute deviation */
  double worst; /* largest absolute deviation */
};

/* Adds a deviation; after a NAN all statistics are NAN. */
void deviations_add(struct deviations *all, double deviation, double weight);

#endif
