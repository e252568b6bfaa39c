/* fields.h5 and fields.xdmf: the flow on part of the cells, and the discs, every so many steps.
 *
 * fields.h5 has a group for each snapshot, named by its step in eight digits or more, with an attribute `step` and
 *
 *   rho, velocity, vorticity, pressure, occupation      [y][x], velocity [y][x][3]: deflated (sample.h)
 *   discs/ id, position, velocity, radius, angle, spin  [point], position and velocity [point][3]
 *
 * and, as attributes of the root, the grid. Third components are 0: what reads XDMF wants three. Points are the discs,
 * in the order of their numbers, and after them the images of those that reach across a periodic side, so that what is
 * drawn at the points fills the box. fields.xdmf shows all this as a series in time: samples at the centres of their
 * cells, and discs as points. All data and structures have checksums, which HDF5 compares whenever they are read.
 *
 * While a run goes on, each snapshot is a file of its own, fields/00000500.h5, and fields.h5 is an index of external links to
 * them. Each file is renamed into its place once it is whole, first the snapshot, then the index, so that the index can be read
 * at any time. To go back to a checkpoint is to write an index without the later snapshots. The end of a run
 * joins all snapshots in one fields.h5, renamed over the index, and removes the folder.
 *
 * Nothing in these files depends on when or where they were written: the same run gives the same bytes, and so does one that was
 * killed and resumed. */
#ifndef DELBM_OUTPUT_FIELDS_H
#define DELBM_OUTPUT_FIELDS_H

#include "sim/simulation.h"

struct fields;

/* A build without HDF5 has these too (fields_none.c), and they refuse. */
#ifdef DELBM_HDF5
enum { FIELDS_SUPPORTED = 1 };
#else
enum { FIELDS_SUPPORTED = 0 };
#endif

/* What a checkpoint says of the snapshots: how many are of steps before its own. */
struct fields_mark {
  int64_t step, count;
};

/* Starts the files in the folder: anew if mark->count is 0; else with the snapshots before mark->step, which are read whole.
 * Snapshots to come must have the samples of those before (DELBM_INVALID, naming the key). The scene must outlive the
 * fields. */
bool fields_open(struct fields **fields, const struct scene *scene, const char *directory,
                 const struct fields_mark *mark, struct status *status);

/* Adds a snapshot of the simulation at its step. */
bool fields_write(struct fields *fields, struct simulation *simulation, struct status *status);

/* How many snapshots there are. */
int64_t fields_count(const struct fields *fields);

/* Joins all snapshots in one fields.h5; nothing may be written after it. On failure the index and the snapshots stay. */
bool fields_join(struct fields *fields, struct status *status);

/* Closes fields.xdmf and sets *fields to NULL; *fields may be NULL. */
bool fields_close(struct fields **fields, struct status *status);

#endif
