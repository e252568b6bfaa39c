#include "output/fields.h"

#include "base/memory.h"
#include "output/file.h"
#include "output/hdf5_file.h"
#include "output/points.h"
#include "output/xdmf.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* Elements of a chunk, about: half a megabyte. Deflate at its fastest: higher levels cost more than they save. */
enum { CHUNK = 1 << 16, DEFLATE = 1 };

struct fields {
  const struct scene *scene;
  struct sample_grid grid;
  struct sample sample;
  struct points points;
  char *path, *undo_path, *xdmf_path;
  struct reversible file;
  struct xdmf xdmf;
};

/* A snapshot that the file holds. */
struct snapshot {
  int64_t step;
  size_t points;
};

struct snapshots {
  struct snapshot *items;
  size_t count, capacity;
};

static double *allocate(size_t count, struct status *status)
{
  return memory_allocate(count, sizeof(double), "the fields", status);
}

static bool create(struct fields **fields, const struct scene *scene, const char *directory, struct status *status)
{
  struct fields *f = *fields = memory_allocate(1, sizeof *f, "the fields", status);
  if (!f) return false;
  *f = (struct fields){.scene = scene, .grid = sample_grid_of(scene), .file = {.descriptor = -1, .undo = -1}};
  const size_t count = sample_points(&f->grid);
  return (f->path = file_join(directory, "fields.h5", status)) &&
         (f->undo_path = file_join(directory, "fields.h5.undo", status)) &&
         (f->xdmf_path = file_join(directory, "fields.xdmf", status)) && (f->sample.rho = allocate(count, status)) &&
         (f->sample.velocity = allocate(3 * count, status)) && (f->sample.vorticity = allocate(count, status)) &&
         (f->sample.pressure = allocate(count, status)) && (f->sample.occupation = allocate(count, status));
}

/* How many discs and images a snapshot holds; negative when that cannot be read. */
static hssize_t count_points(hid_t root, const char *snapshot)
{
  char group[64], path[80];
  snprintf(group, sizeof group, "%s/discs", snapshot);
  snprintf(path, sizeof path, "%s/id", group);
  const htri_t exists = H5Lexists(root, group, H5P_DEFAULT);
  if (exists <= 0) return exists;
  const hid_t set = H5Dopen2(root, path, H5P_DEFAULT), space = set < 0 ? -1 : H5Dget_space(set);
  const hssize_t count = space < 0 ? -1 : H5Sget_simple_extent_npoints(space);
  if (space >= 0) H5Sclose(space);
  if (set >= 0) H5Dclose(set);
  return count;
}

static herr_t note_snapshot(hid_t root, const char *name, const H5L_info_t *info, void *context)
{
  (void)info;
  struct snapshots *list = context;
  struct status ignored;
  const hssize_t points = count_points(root, name);
  if (points < 0) return -1;
  if (!memory_grow(&list->items, &list->capacity, list->count + 1, sizeof *list->items, "the snapshots", &ignored))
    return -1;
  list->items[list->count++] = (struct snapshot){strtoll(name, NULL, 10), (size_t)points};
  return 0;
}

static int compare_steps(const void *a, const void *b)
{
  const struct snapshot *left = a, *right = b;
  return (left->step > right->step) - (left->step < right->step);
}

static bool read_numbers(hid_t object, const char *name, int64_t *numbers)
{
  const hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
  const bool read = attribute >= 0 && H5Aread(attribute, H5T_NATIVE_INT64, numbers) >= 0;
  if (attribute >= 0) H5Aclose(attribute);
  return read;
}

/* Where the samples of a snapshot lie. */
static bool read_grid(hid_t root, int64_t step, struct sample_grid *grid)
{
  char path[64];
  int64_t first[2], stride;
  hsize_t size[2];
  snprintf(path, sizeof path, "%08" PRId64 "/rho", step);
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

/* Snapshots to come must lie where those before lie: they are one series. */
static bool check_grid(const struct fields *f, hid_t root, int64_t step, struct status *status)
{
  struct sample_grid was;
  const struct sample_grid *is = &f->grid;
  if (!read_grid(root, step, &was))
    return status_fail(status, DELBM_IO, "cannot read %s: HDF5 does not tell the grid of step %" PRId64, f->path, step);
  if (was.stride != is->stride)
    return status_fail(status, DELBM_INVALID, "output.fields.stride is %d, but the snapshots in %s have %d", is->stride,
                       f->path, was.stride);
  if (memcmp(was.first, is->first, sizeof was.first) == 0 && memcmp(was.count, is->count, sizeof was.count) == 0)
    return true;
  return status_fail(
      status, DELBM_INVALID,
      "output.fields.region gives %d x %d samples from cell (%d, %d) on, but the snapshots in %s have %d "
      "x %d from (%d, %d) on",
      is->count[0], is->count[1], is->first[0], is->first[1], f->path, was.count[0], was.count[1], was.first[0],
      was.first[1]);
}

/* Lists the snapshots of fields.h5 in fields.xdmf. */
static bool list_snapshots(struct fields *f, struct status *status)
{
  struct hdf5_file open;
  struct snapshots list = {0};
  if (f->file.length == 0) return true;
  if (!hdf5_open(&open, &f->file, status)) return false;
  bool listed = H5Literate(open.handle, H5_INDEX_NAME, H5_ITER_NATIVE, NULL, note_snapshot, &list) >= 0;
  struct status ignored;
  if (!listed) status_fail(status, DELBM_IO, "cannot read %s: HDF5 does not list it", f->path);
  if (listed && list.count > 0) listed = check_grid(f, open.handle, list.items[0].step, status);
  listed = hdf5_close(&open, listed ? status : &ignored) && listed;
  if (list.count > 0) qsort(list.items, list.count, sizeof *list.items, compare_steps);
  for (size_t k = 0; listed && k < list.count; k++)
    listed = xdmf_add(&f->xdmf, list.items[k].step, list.items[k].points, status);
  free(list.items);
  return listed;
}

static bool start(struct fields *f, const struct reversible_mark *mark, struct status *status)
{
  const bool opened = mark ? reversible_return(&f->file, f->path, f->undo_path, mark, status)
                           : reversible_create(&f->file, f->path, f->undo_path, status);
  return opened && xdmf_open(&f->xdmf, f->xdmf_path, &f->grid, status) && list_snapshots(f, status);
}

bool fields_open(struct fields **fields, const struct scene *scene, const char *directory,
                 const struct reversible_mark *mark, struct status *status)
{
  struct status ignored;
  const bool opened = create(fields, scene, directory, status) && start(*fields, mark, status);
  if (!opened) fields_close(fields, &ignored);
  return opened;
}

/* One value, or three, of each cell or point. */
struct set {
  const char *name;
  int rank;
  hsize_t size[3];
  hid_t stored, held; /* types, in the file and in memory */
  const void *values;
  bool packed; /* in chunks, deflated */
};

/* Chunks are whole rows, or part of one if it is long. */
static bool pack(hid_t properties, const struct set *set)
{
  const hsize_t rows = set->size[0], row = set->size[1];
  const hsize_t width = row < CHUNK ? row : CHUNK, fitting = CHUNK / width;
  const hsize_t chunk[3] = {fitting < rows ? fitting : rows, width, set->size[2]};
  return H5Pset_chunk(properties, set->rank, chunk) >= 0 && H5Pset_shuffle(properties) >= 0 &&
         H5Pset_deflate(properties, DEFLATE) >= 0;
}

static bool write_set(hid_t group, const struct set *set)
{
  const hid_t space = H5Screate_simple(set->rank, set->size, NULL), properties = H5Pcreate(H5P_DATASET_CREATE);
  const bool described = space >= 0 && properties >= 0 && H5Pset_obj_track_times(properties, false) >= 0 &&
                         (!set->packed || pack(properties, set));
  const hid_t made =
      described ? H5Dcreate2(group, set->name, set->stored, space, H5P_DEFAULT, properties, H5P_DEFAULT) : -1;
  const bool written = made >= 0 && H5Dwrite(made, set->held, H5S_ALL, H5S_ALL, H5P_DEFAULT, set->values) >= 0;
  if (made >= 0) H5Dclose(made);
  if (properties >= 0) H5Pclose(properties);
  if (space >= 0) H5Sclose(space);
  return written;
}

static bool write_cells(const struct fields *f, hid_t group)
{
  const hsize_t nx = (hsize_t)f->grid.count[0], ny = (hsize_t)f->grid.count[1];
  const struct {
    const char *name;
    const double *values;
    int components;
  } all[] = {{"rho", f->sample.rho, 1},
             {"velocity", f->sample.velocity, 3},
             {"vorticity", f->sample.vorticity, 1},
             {"pressure", f->sample.pressure, 1},
             {"occupation", f->sample.occupation, 1}};
  for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) {
    const struct set set = {.name = all[k].name,
                            .rank = all[k].components > 1 ? 3 : 2,
                            .size = {ny, nx, (hsize_t)all[k].components},
                            .stored = H5T_IEEE_F64LE,
                            .held = H5T_NATIVE_DOUBLE,
                            .values = all[k].values,
                            .packed = true};
    if (!write_set(group, &set)) return false;
  }
  return true;
}

static bool write_points(const struct points *points, hid_t snapshot)
{
  const hid_t group = H5Gcreate2(snapshot, "discs", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  const hsize_t count = (hsize_t)points->count;
  const hid_t real = H5T_IEEE_F64LE, held = H5T_NATIVE_DOUBLE;
  const struct set sets[] = {{"id", 1, {count}, H5T_STD_I64LE, H5T_NATIVE_INT64, points->id, false},
                             {"position", 2, {count, 3}, real, held, points->position, false},
                             {"velocity", 2, {count, 3}, real, held, points->velocity, false},
                             {"radius", 1, {count}, real, held, points->radius, false},
                             {"angle", 1, {count}, real, held, points->angle, false},
                             {"spin", 1, {count}, real, held, points->spin, false}};
  bool written = group >= 0;
  for (size_t k = 0; written && k < sizeof sets / sizeof sets[0]; k++) written = write_set(group, &sets[k]);
  return group >= 0 && H5Gclose(group) >= 0 && written;
}

/* Whole numbers as an attribute. */
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

static bool write_grid(const struct fields *f, hid_t root)
{
  const int64_t size[2] = {f->scene->domain.size[0], f->scene->domain.size[1]};
  const int64_t first[2] = {f->grid.first[0], f->grid.first[1]}, stride = f->grid.stride;
  return write_numbers(root, "domain_size", 2, size) && write_numbers(root, "first_cell", 2, first) &&
         write_numbers(root, "stride", 1, &stride);
}

static bool write_snapshot(const struct fields *f, hid_t root, int64_t step, bool first)
{
  char name[32];
  snprintf(name, sizeof name, "%08" PRId64, step);
  if (first && !write_grid(f, root)) return false;
  const hid_t group = H5Gcreate2(root, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  const bool written = group >= 0 && write_numbers(group, "step", 1, &step) && write_cells(f, group) &&
                       (f->points.count == 0 || write_points(&f->points, group));
  return group >= 0 && H5Gclose(group) >= 0 && written;
}

bool fields_write(struct fields *f, struct simulation *simulation, struct status *status)
{
  struct hdf5_file open;
  const int64_t step = simulation_step(simulation);
  const bool first = f->file.length == 0;
  if (!file_stays(f->file.descriptor, f->path, status) ||
      !simulation_sample(simulation, &f->grid, &f->sample, status) ||
      !points_take(&f->points, f->scene, simulation_discs(simulation), status) || !hdf5_open(&open, &f->file, status))
    return false;
  const bool written = write_snapshot(f, open.handle, step, first);
  if (!hdf5_close(&open, status)) return false;
  if (!written) return status_fail(status, DELBM_IO, "cannot write %s: HDF5 fails at step %" PRId64, f->path, step);
  return xdmf_add(&f->xdmf, step, f->points.count, status);
}

bool fields_set_mark(struct fields *f, struct reversible_mark *mark, struct status *status)
{
  return reversible_set_mark(&f->file, mark, status);
}

bool fields_close(struct fields **fields, struct status *status)
{
  struct fields *f = *fields;
  if (!f) return true;
  const bool closed = xdmf_close(&f->xdmf, status);
  reversible_close(&f->file);
  points_clear(&f->points);
  void *const blocks[] = {f->sample.rho,      f->sample.velocity,   f->sample.vorticity,
                          f->sample.pressure, f->sample.occupation, f->path,
                          f->undo_path,       f->xdmf_path};
  for (size_t k = 0; k < sizeof blocks / sizeof blocks[0]; k++) free(blocks[k]);
  free(f);
  *fields = NULL;
  return closed;
}
