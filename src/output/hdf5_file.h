/* A reversible file as HDF5 reads and writes it.
 *
 * HDF5 appends data, but it also rewrites its own indices, all over the file: one that a killed run leaves cannot be cut to
 * the length that it had at a checkpoint. So a driver of our own stands between the library and a file that can be taken
 * back to a mark (reversible.h). */
#ifndef DELBM_OUTPUT_HDF5_FILE_H
#define DELBM_OUTPUT_HDF5_FILE_H

#include "output/reversible.h"

#include <hdf5.h>

/* An open file. */
struct hdf5_file {
  struct reversible *file;
  hid_t handle; /* for HDF5's calls */
  hid_t driver;
  int error; /* the first that a write has met; nothing is written after it */
};

/* Opens the file, as a new one if it is empty, and closes it, which brings all that was written into it. After a failure
 * of either the file is good for nothing but being taken back. */
bool hdf5_open(struct hdf5_file *open, struct reversible *file, struct status *status);
bool hdf5_close(struct hdf5_file *open, struct status *status);

#endif
