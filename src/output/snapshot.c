#include "output/snapshot.h"

#include "base/memory.h"
#include "output/hdf5_file.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Elements of a chunk, half a megabyte. Deflate level 1: higher levels cost more time for little space. */
enum { CHUNK = 1 << 16, DEFLATE = 1 };

void snapshot_name(char name[SNAPSHOT_NAME], int64_t step)
{
  snprintf(name, SNAPSHOT_NAME, "%08" PRId64, step);
}

/* Writes integers as an attribute. */
static bool write_numbers(hid_t object, const char *name, int count, const int64_t *numbers)
{
  const hsize_t size = (hsize_t)count;
  const hid_t space = count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &size, NULL);
  const hid_t attribute = space < 0 ? -1 : H5Acreate2(object, name, H5T_STD_I64LE, space, H5P_DEFAULT, H5P_DEFAULT);
  const bool written = attribute >= 0 && H5Awrite(attribute, H5T_NATIVE_INT64, numbers) >= 0;
  if (attribute >= 0) H5Aclose(attribute);
  if (space >= 0) H5Sclose(space);
  return written;
}

static bool read_numbers(hid_t object, const char *name, int64_t *numbers)
{
  const hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
  const bool read = attribute >= 0 && H5Aread(attribute, H5T_NATIVE_INT64, numbers) >= 0;
  if (attribute >= 0) H5Aclose(attribute);
  return read;
}

bool snapshot_write_grid(hid_t root, const int domain_size[2], const struct sample_grid *grid)
{
  const int64_t size[2] = {domain_size[0], domain_size[1]};
  const int64_t first[2] = {grid->first[0], grid->first[1]}, stride = grid->stride;
  return write_numbers(root, "domain_size", 2, size) && write_numbers(root, "first_cell", 2, first) &&
         write_numbers(root, "stride", 1, &stride);
}

bool snapshot_read_grid(hid_t root, const struct snapshot *snapshot, struct sample_grid *grid)
{
  char name[SNAPSHOT_NAME], path[2 * SNAPSHOT_NAME];
  int64_t first[2], stride;
  hsize_t size[2];
  snapshot_name(name, snapshot->step);
  snprintf(path, sizeof path, "%s/rho", name);
  const hid_t set = H5Dopen2(root, path, H5P_DEFAULT), space = set < 0 ? -1 : H5Dget_space(set);
  const bool read = space >= 0 && H5Sget_simple_extent_ndims(space) == 2 &&
                    H5Sget_simple_extent_dims(space, size, NULL) == 2 && read_numbers(root, "first_cell", first) &&
                    read_numbers(root, "stride", &stride);
  if (space >= 0) H5Sclose(space);
  if (set >= 0) H5Dclose(set);
  if (read)
    *grid = (struct sample_grid){
        .first = {(int)first[0], (int)first[1]}, .count = {(int)size[1], (int)size[0]}, .stride = (int)stride};
  return read;
}

/* A data set: one or three values per cell or point. */
struct set {
  const char *name;
  int rank;
  hsize_t size[3];
  hid_t file_type, memory_type;
  const void *values;
  bool packed; /* deflated */
};

/* In chunks, since HDF5 computes checksums (Fletcher-32) for chunks only: whole rows, or parts of a long row. */
static bool arrange(hid_t properties, const struct set *set)
{
  const hsize_t rows = set->size[0], row = set->rank > 1 ? set->size[1] : 1;
  const hsize_t width = row < CHUNK ? row : CHUNK, fitting = CHUNK / width;
  const hsize_t chunk[3] = {fitting < rows ? fitting : rows, width, set->size[2]};
  return H5Pset_chunk(properties, set->rank, chunk) >= 0 &&
         (!set->packed || (H5Pset_shuffle(properties) >= 0 && H5Pset_deflate(properties, DEFLATE) >= 0)) &&
         H5Pset_fletcher32(properties) >= 0;
}

static bool write_set(hid_t group, const struct set *set)
{
  const hid_t space = H5Screate_simple(set->rank, set->size, NULL), properties = hdf5_timeless(H5P_DATASET_CREATE);
  const bool described = space >= 0 && properties >= 0 && arrange(properties, set);
  const hid_t made =
      described ? H5Dcreate2(group, set->name, set->file_type, space, H5P_DEFAULT, properties, H5P_DEFAULT) : -1;
  const bool written = made >= 0 && H5Dwrite(made, set->memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, set->values) >= 0;
  const bool closed = made >= 0 && H5Dclose(made) >= 0;
  if (properties >= 0) H5Pclose(properties);
  if (space >= 0) H5Sclose(space);
  return written && closed;
}

static hid_t create_group(hid_t parent, const char *name)
{
  const hid_t properties = hdf5_timeless(H5P_GROUP_CREATE);
  const hid_t group = properties < 0 ? -1 : H5Gcreate2(parent, name, H5P_DEFAULT, properties, H5P_DEFAULT);
  if (properties >= 0) H5Pclose(properties);
  return group;
}

static bool write_cells(hid_t group, const struct sample_grid *grid, const struct sample *sample)
{
  const hsize_t nx = (hsize_t)grid->count[0], ny = (hsize_t)grid->count[1];
  const struct {
    const char *name;
    const double *values;
    int components;
  } all[] = {{"rho", sample->rho, 1},
             {"velocity", sample->velocity, 3},
             {"vorticity", sample->vorticity, 1},
             {"pressure", sample->pressure, 1},
             {"occupation", sample->occupation, 1}};
  for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) {
    const struct set set = {.name = all[k].name,
                            .rank = all[k].components > 1 ? 3 : 2,
                            .size = {ny, nx, (hsize_t)all[k].components},
                            .file_type = H5T_IEEE_F64LE,
                            .memory_type = H5T_NATIVE_DOUBLE,
                            .values = all[k].values,
                            .packed = true};
    if (!write_set(group, &set)) return false;
  }
  return true;
}

static bool write_points(hid_t snapshot, const struct points *points)
{
  const hid_t group = create_group(snapshot, "discs");
  const hsize_t count = (hsize_t)points->count;
  const hid_t real = H5T_IEEE_F64LE, native = H5T_NATIVE_DOUBLE;
  const struct set sets[] = {{"id", 1, {count}, H5T_STD_I64LE, H5T_NATIVE_INT64, points->id, false},
                             {"position", 2, {count, 3}, real, native, points->position, false},
                             {"velocity", 2, {count, 3}, real, native, points->velocity, false},
                             {"radius", 1, {count}, real, native, points->radius, false},
                             {"angle", 1, {count}, real, native, points->angle, false},
                             {"spin", 1, {count}, real, native, points->spin, false}};
  bool written = group >= 0;
  for (size_t k = 0; written && k < sizeof sets / sizeof sets[0]; k++) written = write_set(group, &sets[k]);
  return group >= 0 && H5Gclose(group) >= 0 && written;
}

bool snapshot_write(hid_t root, int64_t step, const struct sample_grid *grid, const struct sample *sample,
                    const struct points *points)
{
  char name[SNAPSHOT_NAME];
  snapshot_name(name, step);
  const hid_t group = create_group(root, name);
  const bool written = group >= 0 && write_numbers(group, "step", 1, &step) && write_cells(group, grid, sample) &&
                       (points->count == 0 || write_points(group, points));
  return group >= 0 && H5Gclose(group) >= 0 && written;
}

/* Context and results of a check. */
struct check {
  const char *path;
  struct snapshot *snapshot;
  struct status *status;
};

static bool read_set(hid_t set, const char *name, const struct check *check)
{
  const hid_t space = H5Dget_space(set);
  const hssize_t count = space < 0 ? -1 : H5Sget_simple_extent_npoints(space);
  if (space >= 0) H5Sclose(space);
  if (count < 0) return false;
  void *values = memory_allocate((size_t)count, sizeof(double), "the check of a snapshot", check->status);
  const bool read = values && H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
  free(values);
  if (strcmp(name, "id") == 0) check->snapshot->points = (size_t)count;
  return read;
}

/* Reads a data set, or all data sets of a group. */
static herr_t read_object(hid_t group, const char *name, const H5L_info_t *info, void *context)
{
  (void)info;
  const struct check *check = context;
  const hid_t object = H5Oopen(group, name, H5P_DEFAULT);
  const H5I_type_t type = object < 0 ? H5I_BADID : H5Iget_type(object);
  const bool read = type == H5I_DATASET ? read_set(object, name, check)
                                        : type == H5I_GROUP && H5Literate(object, H5_INDEX_NAME, H5_ITER_NATIVE, NULL,
                                                                          read_object, context) >= 0;
  if (object >= 0) H5Oclose(object);
  if (!read && check->status->code == DELBM_OK)
    status_fail(check->status, DELBM_IO, "%s: %s of step %" PRId64 " is damaged or missing: HDF5 cannot read it",
                check->path, name, check->snapshot->step);
  return read ? 0 : -1;
}

bool snapshot_check(hid_t root, const char *path, struct snapshot *snapshot, struct status *status)
{
  char name[SNAPSHOT_NAME];
  struct check check = {path, snapshot, status};
  snapshot_name(name, snapshot->step);
  snapshot->points = 0;
  status->code = DELBM_OK;
  return read_object(root, name, NULL, &check) >= 0;
}

/* Copies the compressed bytes of a chunk. */
static bool copy_chunk(hid_t from, hid_t to, const hsize_t *at)
{
  struct status ignored;
  hsize_t size = 0;
  uint32_t filters = 0;
  if (H5Dget_chunk_storage_size(from, at, &size) < 0) return false;
  void *bytes = memory_allocate((size_t)size, 1, "a chunk of a snapshot", &ignored);
  const bool copied = bytes && H5Dread_chunk(from, H5P_DEFAULT, at, &filters, bytes) >= 0 &&
                      H5Dwrite_chunk(to, H5P_DEFAULT, filters, at, (size_t)size, bytes) >= 0;
  free(bytes);
  return copied;
}

/* Copies all chunks. Components, the third index of cells and the second of points, are not divided. */
static bool copy_chunks(hid_t from, hid_t to, hid_t space, hid_t properties)
{
  hsize_t size[3] = {1, 1, 1}, chunk[3] = {1, 1, 1}, at[3] = {0};
  if (H5Sget_simple_extent_dims(space, size, NULL) < 0 || H5Pget_chunk(properties, 3, chunk) < 0) return false;
  for (at[0] = 0; at[0] < size[0]; at[0] += chunk[0])
    for (at[1] = 0; at[1] < size[1]; at[1] += chunk[1])
      if (!copy_chunk(from, to, at)) return false;
  return true;
}

static bool copy_set(hid_t from, hid_t group, const char *name)
{
  const hid_t type = H5Dget_type(from), space = H5Dget_space(from), properties = H5Dget_create_plist(from);
  const hid_t to = type < 0 || space < 0 || properties < 0
                       ? -1
                       : H5Dcreate2(group, name, type, space, H5P_DEFAULT, properties, H5P_DEFAULT);
  const bool copied = to >= 0 && copy_chunks(from, to, space, properties);
  const bool closed = to >= 0 && H5Dclose(to) >= 0;
  if (properties >= 0) H5Pclose(properties);
  if (space >= 0) H5Sclose(space);
  if (type >= 0) H5Tclose(type);
  return copied && closed;
}

static herr_t copy_object(hid_t group, const char *name, const H5L_info_t *info, void *to);

static bool copy_group(hid_t from, hid_t parent, const char *name)
{
  int64_t step;
  hid_t to = create_group(parent, name);
  const bool copied =
      to >= 0 &&
      (!H5Aexists(from, "step") || (read_numbers(from, "step", &step) && write_numbers(to, "step", 1, &step))) &&
      H5Literate(from, H5_INDEX_NAME, H5_ITER_INC, NULL, copy_object, &to) >= 0;
  return to >= 0 && H5Gclose(to) >= 0 && copied;
}

static herr_t copy_object(hid_t group, const char *name, const H5L_info_t *info, void *to)
{
  (void)info;
  const hid_t *into = to;
  const hid_t object = H5Oopen(group, name, H5P_DEFAULT);
  const H5I_type_t type = object < 0 ? H5I_BADID : H5Iget_type(object);
  const bool copied =
      type == H5I_DATASET ? copy_set(object, *into, name) : type == H5I_GROUP && copy_group(object, *into, name);
  if (object >= 0) H5Oclose(object);
  return copied ? 0 : -1;
}

bool snapshot_copy(hid_t from, hid_t to, int64_t step)
{
  char name[SNAPSHOT_NAME];
  snapshot_name(name, step);
  return copy_object(from, name, NULL, &to) >= 0;
}
