/* fields.h5 and fields.xdmf: the flow on part of the cells, and the discs, at regular steps.
 *
 * fields.h5 has a group for each snapshot, named by its step in eight digits or more, with an attribute `step` and
 *
 *   rho, velocity, vorticity, pressure, occupation      [y][x], velocity [y][x][3]: deflated (sample.h)
 *   discs/ id, position, velocity, radius, angle, spin  [point], position and velocity [point][3]
 *
 * and, as attributes of the root, the grid. Third components are 0: readers of XDMF expect three. Points are the
 * discs by number, then the images of discs across periodic sides, so that discs drawn at the points fill the box.
 * fields.xdmf describes a time series: samples at the centres of their cells, and discs as points. All data and
 * structures have checksums, which HDF5 compares on every read.
 *
 * During a run each snapshot is a file of its own, fields/00000500.h5, and fields.h5 is an index of external links.
 * A complete file is renamed into place, first the snapshot, then the index, so that the index is readable at any
 * time. Resuming from a checkpoint writes an index without the later snapshots. The end of a run joins all snapshots
 * in one fields.h5, renamed over the index, and removes the folder.
 *
 * The content is independent of time and path: the same run, also if killed and resumed, produces the same bytes. */
#ifndef DELBM_OUTPUT_FIELDS_H
#define DELBM_OUTPUT_FIELDS_H

#include "sim/simulation.h"

struct fields;

/* In a build without HDF5 fields_open fails (fields_none.c). */
#ifdef DELBM_HDF5
enum { FIELDS_SUPPORTED = 1 };
#else
enum { FIELDS_SUPPORTED = 0 };
#endif

/* The snapshots at a checkpoint: `count` snapshots before `step`. */
struct fields_mark {
  int64_t step, count;
};

/* Creates the files in the folder, with the snapshots before mark->step if mark->count > 0, after a check of all
 * their data. The grid must be equal to the earlier snapshots' grid (DELBM_INVALID, with the key). The scene must
 * outlive the fields. */
bool fields_open(struct fields **fields, const struct scene *scene, const char *directory,
                 const struct fields_mark *mark, struct status *status);

/* Adds a snapshot at the simulation's step. */
bool fields_write(struct fields *fields, struct simulation *simulation, struct status *status);

/* Number of snapshots. */
int64_t fields_count(const struct fields *fields);

/* Joins all snapshots in one fields.h5, as the last call before fields_close. A failure leaves index and snapshots
 * intact. */
bool fields_join(struct fields *fields, struct status *status);

/* Closes fields.xdmf and sets *fields to NULL; *fields may be NULL. */
bool fields_close(struct fields **fields, struct status *status);

#endif
