/* fields.h5 and fields.xdmf: the flow on part of the cells, and the discs, every so many steps.
 *
 * fields.h5 holds a group for each snapshot, named by its step in eight digits or more, with an attribute `step` and
 *
 *   rho, velocity, vorticity, pressure, occupation      [y][x], velocity [y][x][3]: chunked, deflated (sample.h)
 *   discs/ id, position, velocity, radius, angle, spin  [point], position and velocity [point][3]
 *
 * and, as attributes of the root, the grid. Third components are 0: what reads XDMF wants three. Points are the discs,
 * in the order of their numbers, and after them the images of those that reach across a periodic side, so that what is
 * drawn at the points fills the box. fields.xdmf shows all this as a series in time: samples at the centres of their
 * cells, and discs as points.
 *
 * Nothing in either file depends on when or where it was written: the same run gives the same bytes, and so does one that
 * was killed and resumed, for fields.h5 goes back to what it was at the checkpoint (hdf5_file.h). */
#ifndef DELBM_OUTPUT_FIELDS_H
#define DELBM_OUTPUT_FIELDS_H

#include "output/reversible.h"
#include "sim/simulation.h"

struct fields;

/* A build without HDF5 has these too (fields_none.c), and they refuse. */
#ifdef DELBM_HDF5
enum { FIELDS_SUPPORTED = 1 };
#else
enum { FIELDS_SUPPORTED = 0 };
#endif

/* Starts both files in the folder, anew or, where `mark` is not NULL, from a mark of fields.h5: then snapshots to come
 * must have the samples of those before (DELBM_INVALID, naming the key). The scene must outlive the fields. */
bool fields_open(struct fields **fields, const struct scene *scene, const char *directory,
                 const struct reversible_mark *mark, struct status *status);

/* Adds a snapshot of the simulation at its step. */
bool fields_write(struct fields *fields, struct simulation *simulation, struct status *status);

/* Forces fields.h5 to the disk and marks it. */
bool fields_set_mark(struct fields *fields, struct reversible_mark *mark, struct status *status);

/* Closes the files and sets *fields to NULL; *fields may be NULL. */
bool fields_close(struct fields **fields, struct status *status);

#endif
