/* HDF5 files, complete or absent: written as NAME.tmp, synchronised and renamed (struct replacement).
 *
 * Format: HDF5 1.10 with any library, for checksums of structures; without creation times, so that equal content has
 * equal bytes. */
#ifndef DELBM_OUTPUT_HDF5_FILE_H
#define DELBM_OUTPUT_HDF5_FILE_H

#include "output/file.h"

#include <hdf5.h>

struct hdf5_file {
  struct replacement place;
  hid_t handle; /* file of HDF5 */
};

/* Each begin ends with a commit or an abandon; an earlier file of this name remains until a commit succeeds. */
bool hdf5_begin(struct hdf5_file *file, const char *path, struct status *status);
bool hdf5_commit(struct hdf5_file *file, struct status *status);
void hdf5_abandon(struct hdf5_file *file);

/* Opens a plain file for reading, to be closed by H5Fclose; less than 0 on failure. */
hid_t hdf5_open(const char *path, struct status *status);

/* Creation properties without times, to be released by H5Pclose; less than 0 on failure. */
hid_t hdf5_timeless(hid_t class);

#endif
