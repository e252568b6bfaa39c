#include "output/fields.h"

#include "base/memory.h"
#include "output/hdf5_file.h"
#include "output/numbered.h"
#include "output/snapshot.h"
#include "output/xdmf.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

struct fields {
  const struct scene *scene;
  struct sample_grid grid;
  struct sample sample;
  struct points points;
  char *path, *folder, *xdmf_path;
  struct snapshot *snapshots; /* by step */
  size_t count, capacity;
  struct xdmf xdmf;
};

static double *allocate(size_t count, struct status *status)
{
  return memory_allocate(count, sizeof(double), "the fields", status);
}

static bool allocate_sample(struct fields *f, struct status *status)
{
  const size_t count = sample_points(&f->grid);
  return (f->sample.rho = allocate(count, status)) && (f->sample.velocity = allocate(3 * count, status)) &&
         (f->sample.vorticity = allocate(count, status)) && (f->sample.pressure = allocate(count, status)) &&
         (f->sample.occupation = allocate(count, status));
}

static bool create(struct fields **fields, const struct scene *scene, const char *directory, struct status *status)
{
  struct fields *f = *fields = memory_allocate(1, sizeof *f, "the fields", status);
  if (!f) return false;
  *f = (struct fields){.scene = scene, .grid = sample_grid_of(scene)};
  return (f->path = file_join(directory, "fields.h5", status)) &&
         (f->folder = file_join(directory, "fields", status)) &&
         (f->xdmf_path = file_join(directory, "fields.xdmf", status));
}

static bool append(struct fields *f, int64_t step, size_t points, struct status *status)
{
  if (!memory_grow(&f->snapshots, &f->capacity, f->count + 1, sizeof *f->snapshots, "the snapshots", status))
    return false;
  f->snapshots[f->count++] = (struct snapshot){step, points};
  return true;
}

/* Commits a file if `written`, else abandons the file. */
static bool finish(struct hdf5_file *file, bool written, struct status *status)
{
  if (written) return hdf5_commit(file, status);
  hdf5_abandon(file);
  return false;
}

static bool write_links(const struct fields *f, hid_t root)
{
  bool written = snapshot_write_grid(root, f->scene->domain.size, &f->grid);
  for (size_t k = 0; written && k < f->count; k++) {
    char name[SNAPSHOT_NAME], file[SNAPSHOT_NAME + 16];
    snapshot_name(name, f->snapshots[k].step);
    snprintf(file, sizeof file, "fields/%s.h5", name);
    written = H5Lcreate_external(file, name, root, name, H5P_DEFAULT, H5P_DEFAULT) >= 0;
  }
  return written;
}

static bool write_index(const struct fields *f, struct status *status)
{
  struct hdf5_file file;
  if (!hdf5_begin(&file, f->path, status)) return false;
  return finish(&file, write_links(f, file.handle) || file_fail(status, "write", f->path, errno), status);
}

/* Copies a snapshot from a joined file into a file of its own. */
static bool extract(const struct fields *f, hid_t all, int64_t step, const char *path, struct status *status)
{
  struct hdf5_file file;
  if (!hdf5_begin(&file, path, status)) return false;
  const bool written =
      snapshot_write_grid(file.handle, f->scene->domain.size, &f->grid) && snapshot_copy(all, file.handle, step);
  return finish(&file, written || file_fail(status, "write", path, errno), status);
}

/* The target of an external link must be a plain file: HDF5 would block on a FIFO. */
static bool check_file(const char *path, struct status *status)
{
  FILE *stream = file_open_stream(path, status);
  return stream && fclose(stream) == 0;
}

/* Checks a snapshot of the earlier fields.h5, an index or a joined file; a snapshot of a joined file is extracted. */
static bool adopt_snapshot(const struct fields *f, hid_t before, struct snapshot *snapshot, struct status *status)
{
  char name[SNAPSHOT_NAME];
  H5L_info_t link;
  snapshot_name(name, snapshot->step);
  char *path = numbered_path(f->folder, snapshot->step, "h5", status);
  const bool external = H5Lget_info(before, name, &link, H5P_DEFAULT) >= 0 && link.type == H5L_TYPE_EXTERNAL;
  const bool kept = path && (!external || check_file(path, status)) &&
                    snapshot_check(before, external ? path : f->path, snapshot, status) &&
                    (external || extract(f, before, snapshot->step, path, status));
  free(path);
  return kept;
}

/* New snapshots must have the grid of the earlier snapshots of the series. */
static bool check_grid(const struct fields *f, hid_t before, struct status *status)
{
  struct sample_grid was;
  const struct sample_grid *is = &f->grid;
  if (!snapshot_read_grid(before, &f->snapshots[0], &was))
    return status_fail(status, DELBM_IO, "cannot read %s: HDF5 does not tell the grid of step %" PRId64, f->path,
                       f->snapshots[0].step);
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

/* Context of note_snapshot; snapshots from step `before` on are discarded. */
struct listing {
  struct fields *fields;
  int64_t before;
};

static herr_t note_snapshot(hid_t root, const char *name, const H5L_info_t *info, void *context)
{
  (void)root, (void)info;
  struct listing *listing = context;
  struct status ignored;
  const int64_t step = strtoll(name, NULL, 10);
  return step >= listing->before || append(listing->fields, step, 0, &ignored) ? 0 : -1;
}

static int compare_steps(const void *a, const void *b)
{
  const struct snapshot *left = a, *right = b;
  return (left->step > right->step) - (left->step < right->step);
}

static bool list_snapshots(struct fields *f, hid_t before, const struct fields_mark *mark, struct status *status)
{
  struct listing listing = {f, mark->step};
  if (H5Literate(before, H5_INDEX_NAME, H5_ITER_NATIVE, NULL, note_snapshot, &listing) < 0)
    return status_fail(status, DELBM_IO, "cannot read %s: HDF5 does not list it", f->path);
  if ((int64_t)f->count != mark->count)
    return status_fail(status, DELBM_IO,
                       "%s has %zu snapshots before step %" PRId64 ", and had %" PRId64
                       " at the checkpoint: it was changed",
                       f->path, f->count, mark->step, mark->count);
  qsort(f->snapshots, f->count, sizeof *f->snapshots, compare_steps);
  return true;
}

static bool read_earlier(struct fields *f, const struct fields_mark *mark, struct status *status)
{
  if (mark->count == 0) return true;
  const hid_t before = hdf5_open(f->path, status);
  if (before < 0) return false;
  bool taken = list_snapshots(f, before, mark, status) && check_grid(f, before, status);
  for (size_t k = 0; taken && k < f->count; k++) taken = adopt_snapshot(f, before, &f->snapshots[k], status);
  return H5Fclose(before) >= 0 && taken;
}

/* Later files are removed after the index, so that the index refers to existing files at any time. */
static bool start(struct fields *f, const struct fields_mark *mark, struct status *status)
{
  if (!file_make_directory(f->folder, status) || !read_earlier(f, mark, status) || !write_index(f, status) ||
      !numbered_remove(f->folder, mark->count > 0 ? mark->step : 0, "h5", status) ||
      !xdmf_open(&f->xdmf, f->xdmf_path, &f->grid, status))
    return false;
  bool listed = true;
  for (size_t k = 0; listed && k < f->count; k++)
    listed = xdmf_add(&f->xdmf, f->snapshots[k].step, f->snapshots[k].points, status);
  return listed;
}

bool fields_open(struct fields **fields, const struct scene *scene, const char *directory,
                 const struct fields_mark *mark, struct status *status)
{
  struct status ignored;
  const bool opened =
      create(fields, scene, directory, status) && start(*fields, mark, status) && allocate_sample(*fields, status);
  if (!opened) fields_close(fields, &ignored);
  return opened;
}

static bool write_snapshot(const struct fields *f, int64_t step, struct status *status)
{
  struct hdf5_file file;
  char *path = numbered_path(f->folder, step, "h5", status);
  bool written = path && hdf5_begin(&file, path, status);
  if (written)
    written = finish(&file,
                     (snapshot_write_grid(file.handle, f->scene->domain.size, &f->grid) &&
                      snapshot_write(file.handle, step, &f->grid, &f->sample, &f->points)) ||
                         file_fail(status, "write", path, errno),
                     status);
  free(path);
  return written;
}

bool fields_write(struct fields *f, struct simulation *simulation, struct status *status)
{
  const int64_t step = simulation_step(simulation);
  return simulation_sample(simulation, &f->grid, &f->sample, status) &&
         points_take(&f->points, f->scene, simulation_discs(simulation), status) && write_snapshot(f, step, status) &&
         append(f, step, f->points.count, status) && write_index(f, status) &&
         xdmf_add(&f->xdmf, step, f->points.count, status);
}

int64_t fields_count(const struct fields *f)
{
  return (int64_t)f->count;
}

static bool copy_file(const struct fields *f, hid_t to, int64_t step, struct status *status)
{
  char *path = numbered_path(f->folder, step, "h5", status);
  const hid_t from = path ? hdf5_open(path, status) : -1;
  errno = 0;
  const bool copied = from >= 0 && (snapshot_copy(from, to, step) || file_fail(status, "write", f->path, errno));
  if (from >= 0) H5Fclose(from);
  free(path);
  return copied;
}

static bool write_joined(const struct fields *f, struct status *status)
{
  struct hdf5_file file;
  if (!hdf5_begin(&file, f->path, status)) return false;
  bool written =
      snapshot_write_grid(file.handle, f->scene->domain.size, &f->grid) || file_fail(status, "write", f->path, errno);
  for (size_t k = 0; written && k < f->count; k++) written = copy_file(f, file.handle, f->snapshots[k].step, status);
  return finish(&file, written, status);
}

bool fields_join(struct fields *f, struct status *status)
{
  if (write_joined(f, status)) return numbered_remove_folder(f->folder, "h5", status);
  status_add(status, "; the snapshots are whole, but not in one file: %s refers to those in %s", f->path, f->folder);
  return false;
}

bool fields_close(struct fields **fields, struct status *status)
{
  struct fields *f = *fields;
  if (!f) return true;
  const bool closed = xdmf_close(&f->xdmf, status);
  points_clear(&f->points);
  void *const blocks[] = {f->sample.rho,      f->sample.velocity,   f->sample.vorticity,
                          f->sample.pressure, f->sample.occupation, f->path,
                          f->folder,          f->xdmf_path,         f->snapshots};
  for (size_t k = 0; k < sizeof blocks / sizeof blocks[0]; k++) free(blocks[k]);
  free(f);
  *fields = NULL;
  return closed;
}
