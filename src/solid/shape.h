/* The shape of a body. Occupation, coupling and contact geometry access a shape only by the functions of struct
 * shape_kind. Shapes are convex, so that a body has one run of cells in each row.
 *
 * A new shape is one file that defines a struct shape_kind, the fields of struct shape for its measures, and a line in
 * discs.c that chooses it. Estimates before a run (disc_spec_area), pictures and tables know discs only. Lattice units;
 * angles in radians, counter-clockwise. */
#ifndef DELBM_SOLID_SHAPE_H
#define DELBM_SOLID_SHAPE_H

#include <stdbool.h>
#include <stdint.h>

/* Centroid and angle of a body. */
struct pose {
  double x, y, angle;
};

struct shape {
  const struct shape_kind *kind;
  double radius; /* of the smallest circle about the centroid that contains the shape */
};

/* The cells that a body touches: rows row .. row + rows - 1, and columns from `column` on. */
struct shape_box {
  int32_t column, row, rows;
};

enum {
  SHAPE_PAD = 8,  /* elements past the last cell that shape_fractions may write */
  SHAPE_ROWS = 24 /* rows in one call, at most */
};

/* Cells of consecutive rows: cells first .. end - 1 are touched, counted from the box's column; cells full ..
 * full_end - 1 have eps = 1. */
struct row_extents {
  int32_t first[SHAPE_ROWS], end[SHAPE_ROWS], full[SHAPE_ROWS], full_end[SHAPE_ROWS];
};

/* Extents of rows first_row .. first_row + rows - 1 of the lattice, all touched by the body. */
typedef void shape_extents(const struct shape *shape, const struct pose *pose, int first_row, int rows,
                           struct row_extents *extents);

/* Occupation fractions of the touched cells of rows from_row .. end_row - 1 of `extents`, row after row. */
typedef void shape_fractions(const struct shape *shape, const struct pose *pose, int first_row, int from_row,
                             int end_row, const struct row_extents *extents, double *eps);

/* Overlap of two bodies, or of a body and the half plane beyond a side: its area, and its chord, which is the
 * derivative of the area by the distance. */
struct lens {
  double area, chord;
};

enum { BODY_PAIRS = 64 }; /* in one call, at most */

/* Relative places of pairs of bodies 0 and 1, or of bodies 0 and half planes. `count` is a multiple of 8. */
struct body_pairs {
  int count;
  bool with_area;        /* the area is asked for */
  double dx[BODY_PAIRS]; /* from centroid 0 to centroid 1; of a half plane: its unit outward normal */
  double dy[BODY_PAIRS];
  double distance[BODY_PAIRS];  /* of a half plane from centroid 0; negative if the centroid is inside */
  double radius[2][BODY_PAIRS]; /* of the shapes' smallest circles */
};

/* Overlaps as contacts. n: unit normal from body 0 to body 1 or the half plane; t = (-n_y, n_x). The contact point lies at
 * arm[0] n + offset[0] t from centroid 0, at -arm[1] n + offset[1] t from centroid 1. */
struct body_overlaps {
  double depth[BODY_PAIRS]; /* along n; negative: a gap */
  double nx[BODY_PAIRS], ny[BODY_PAIRS];
  double arm[2][BODY_PAIRS];    /* of a half plane, arm[1]: 0 */
  double offset[2][BODY_PAIRS]; /* not written by round shapes: 0 */
  double area[BODY_PAIRS];      /* if asked for */
  double chord[BODY_PAIRS];     /* derivative of the area by the depth */
};
typedef void shape_overlaps(const struct body_pairs *pairs, struct body_overlaps *overlaps);

struct shape_kind {
  const char *name;
  bool round; /* unchanged by rotation: a change of the angle alone leaves all cells as they are */
  double (*area)(const struct shape *shape);
  double (*gyration2)(const struct shape *shape); /* mean of r^2 over the area, about the centroid */
  struct shape_box (*box)(const struct shape *shape, const struct pose *pose);
  shape_extents *extents;
  shape_fractions *fractions;
  shape_overlaps *overlaps; /* two bodies of this kind; coincident centroids have n along x */
  shape_overlaps *overlaps_half_plane;
};

#endif
