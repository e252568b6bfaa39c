#include "output/hdf5_file.h"

#include <errno.h>

/* Errors by return values only. No exit handler of HDF5: it crashes after failed writes. */
static void start_hdf5(void)
{
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}

hid_t hdf5_timeless(hid_t class)
{
  const hid_t properties = H5Pcreate(class);
  if (properties >= 0) H5Pset_obj_track_times(properties, false);
  return properties;
}

static hid_t create(const char *path)
{
  const hid_t creation = hdf5_timeless(H5P_FILE_CREATE), access = H5Pcreate(H5P_FILE_ACCESS);
  hid_t handle = -1;
  if (creation >= 0 && access >= 0 && H5Pset_fclose_degree(access, H5F_CLOSE_STRONG) >= 0 &&
      H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110) >= 0)
    handle = H5Fcreate(path, H5F_ACC_TRUNC, creation, access);
  if (access >= 0) H5Pclose(access);
  if (creation >= 0) H5Pclose(creation);
  return handle;
}

bool hdf5_begin(struct hdf5_file *file, const char *path, struct status *status)
{
  start_hdf5();
  if (!replacement_begin(&file->place, path, status)) return false;
  errno = 0;
  file->handle = create(file->place.temporary);
  if (file->handle >= 0) return true;
  file_fail(status, "create", path, errno);
  replacement_abandon(&file->place);
  return false;
}

/* HDF5 opened the temporary file by path: the path must still refer to the file to be renamed. */
bool hdf5_commit(struct hdf5_file *file, struct status *status)
{
  struct replacement *place = &file->place;
  if (H5Fclose(file->handle) < 0)
    file_fail(status, "write", place->path, errno);
  else if (file_stays(fileno(place->stream), place->temporary, status))
    return replacement_commit_durably(place, status);
  replacement_abandon(place);
  return false;
}

void hdf5_abandon(struct hdf5_file *file)
{
  H5Fclose(file->handle);
  replacement_abandon(&file->place);
}

hid_t hdf5_open(const char *path, struct status *status)
{
  start_hdf5();
  FILE *plain = file_open_stream(path, status); /* reports missing and special files */
  if (!plain) return -1;
  fclose(plain);
  const hid_t handle = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (handle < 0) status_fail(status, DELBM_IO, "cannot read %s: damaged, or not a file of HDF5", path);
  return handle;
}
