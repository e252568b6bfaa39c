/* HDF5 files that are whole or absent: written as NAME.tmp, forced to the disk and renamed (struct replacement).
 *
 * The format is that of HDF5 1.10, whatever the library: its structures have checksums, and without times of creation the same
 * content is the same bytes. */
#ifndef DELBM_OUTPUT_HDF5_FILE_H
#define DELBM_OUTPUT_HDF5_FILE_H

#include "output/file.h"

#include <hdf5.h>

struct hdf5_file {
  struct replacement place;
  hid_t handle; /* for HDF5's calls */
};

/* Either of commit and abandon ends what begin has begun; a file of that name stays until a commit has succeeded. */
bool hdf5_begin(struct hdf5_file *file, const char *path, struct status *status);
bool hdf5_commit(struct hdf5_file *file, struct status *status);
void hdf5_abandon(struct hdf5_file *file);

/* Opens a plain file for reading; less than 0 on failure. H5Fclose closes it. */
hid_t hdf5_open(const char *path, struct status *status);

/* Properties of a new object that has no times in it; H5Pclose releases them. */
hid_t hdf5_timeless(hid_t class);

#endif
