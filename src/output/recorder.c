#include "output/recorder.h"

#include "base/memory.h"
#include "output/csv.h"
#include "output/file.h"
#include "output/picture.h"
#include "scene/scene_write.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* What is recorded at regular steps. */
struct series {
  int64_t every;    /* 0: never */
  int64_t recorded; /* the step last recorded, -1 before the first */
};

struct recorder {
  const struct scene *scene;
  char *case_path, *table_path, *frames_path, *summary_path;
  struct csv *table; /* particles.csv */
  struct series rows, frames;
  double *ux, *uy; /* fields of a frame; NULL without frames */
  double seconds;
};

static bool series_is_due(const struct series *series, int64_t step, bool last)
{
  return series->every > 0 && step != series->recorded && (last || step % series->every == 0);
}

static int64_t series_next(const struct series *series, int64_t step, int64_t end)
{
  int64_t left = series->every > 0 ? series->every - step % series->every : end;
  return left < end - step ? step + left : end;
}

/* True for NNNNNNNN.png (eight digits, more in long runs) and for what an interrupted replacement of one left. */
static bool is_frame(const char *name)
{
  size_t digits = 0;
  while (isdigit((unsigned char)name[digits])) digits++;
  return digits >= 8 && (strcmp(name + digits, ".png") == 0 || strcmp(name + digits, ".png.tmp") == 0);
}

static bool remove_named(const char *directory, const char *name, struct status *status)
{
  char *path = file_join(directory, name, status);
  bool removed = path && file_remove(path, status);
  free(path);
  return removed;
}

static bool remove_frames(const char *directory, struct status *status)
{
  DIR *listing = opendir(directory);
  if (!listing) return errno == ENOENT || file_fail(status, "read folder", directory, errno);
  bool removed = true;
  for (struct dirent *entry; removed && (entry = readdir(listing));)
    if (is_frame(entry->d_name)) removed = remove_named(directory, entry->d_name, status);
  closedir(listing);
  return removed;
}

static bool remove_earlier_run(const struct recorder *recorder, bool *replaced, struct status *status)
{
  *replaced = access(recorder->summary_path, F_OK) == 0 || access(recorder->table_path, F_OK) == 0;
  return file_remove(recorder->summary_path, status) && file_remove(recorder->table_path, status) &&
         remove_frames(recorder->frames_path, status);
}

static bool write_case(const struct recorder *recorder, struct status *status)
{
  struct replacement file;
  if (!replacement_begin(&file, recorder->case_path, status)) return false;
  errno = 0;
  if (scene_write(recorder->scene, file.stream)) return replacement_commit(&file, status);
  file_fail(status, "write", recorder->case_path, errno);
  replacement_abandon(&file);
  return false;
}

static bool prepare_table(struct recorder *recorder, struct status *status)
{
  return recorder->rows.every == 0 || csv_open(&recorder->table, recorder->table_path, status);
}

static double *allocate_field(const struct recorder *recorder, struct status *status)
{
  const int *size = recorder->scene->domain.size;
  return memory_allocate((size_t)size[0] * (size_t)size[1], sizeof(double), "the velocities of a frame", status);
}

static bool prepare_fields(struct recorder *recorder, struct status *status)
{
  if (recorder->frames.every == 0) return true;
  recorder->ux = allocate_field(recorder, status);
  if (recorder->ux) recorder->uy = allocate_field(recorder, status);
  return recorder->uy;
}

static bool prepare_frames(const struct recorder *recorder, struct status *status)
{
  return recorder->frames.every == 0 || file_make_directory(recorder->frames_path, status);
}

static bool prepare_paths(struct recorder *recorder, const char *directory, struct status *status)
{
  recorder->case_path = file_join(directory, "case.yaml", status);
  recorder->table_path = file_join(directory, "particles.csv", status);
  recorder->frames_path = file_join(directory, "frames", status);
  recorder->summary_path = file_join(directory, "run.json", status);
  return recorder->case_path && recorder->table_path && recorder->frames_path && recorder->summary_path;
}

/* What can fail without harm comes before an earlier run is removed. */
static bool prepare(struct recorder *recorder, const char *directory, bool *replaced, struct status *status)
{
  return prepare_paths(recorder, directory, status) && prepare_fields(recorder, status) &&
         file_make_directory(directory, status) && remove_earlier_run(recorder, replaced, status) &&
         write_case(recorder, status) && prepare_table(recorder, status) && prepare_frames(recorder, status);
}

bool recorder_open(struct recorder **recorder, const struct scene *scene, const char *directory, bool *replaced,
                   struct status *status)
{
  *recorder = NULL;
  *replaced = false;
  if (scene->output.frames.every > 0 && !PICTURE_SUPPORTED)
    return status_fail(status, DELBM_INVALID,
                       "output.frames.every is %" PRId64 ", but this build has no libpng: only 0",
                       scene->output.frames.every);
  *recorder = memory_allocate(1, sizeof **recorder, "the record of the run", status);
  if (!*recorder) return false;
  **recorder = (struct recorder){.scene = scene,
                                 .rows = {.every = scene->output.every, .recorded = -1},
                                 .frames = {.every = scene->output.frames.every, .recorded = -1}};
  if (prepare(*recorder, directory, replaced, status)) return true;
  recorder_destroy(*recorder);
  *recorder = NULL;
  return false;
}

int64_t recorder_next(const struct recorder *recorder, int64_t step)
{
  int64_t end = recorder->scene->run.steps;
  int64_t rows = series_next(&recorder->rows, step, end), frames = series_next(&recorder->frames, step, end);
  return rows < frames ? rows : frames;
}

static bool record_frame(struct recorder *recorder, struct simulation *simulation, struct status *status)
{
  const struct scene *scene = recorder->scene;
  char name[32];
  snprintf(name, sizeof name, "%08" PRId64 ".png", simulation_step(simulation));
  char *path = file_join(recorder->frames_path, name, status);
  if (!path) return false;
  simulation_fields(simulation, NULL, recorder->ux, recorder->uy);
  struct picture picture = {.size = {scene->domain.size[0], scene->domain.size[1]},
                            .ux = recorder->ux,
                            .uy = recorder->uy,
                            .periodic = {scene_is_periodic(scene, 0), scene_is_periodic(scene, 1)},
                            .discs = simulation_discs(simulation),
                            .quantity = scene->output.frames.quantity,
                            .maximum = scene->output.frames.maximum};
  bool written = picture_write(&picture, path, status);
  free(path);
  return written;
}

static bool record_due(struct recorder *recorder, struct simulation *simulation, bool last, struct status *status)
{
  int64_t step = simulation_step(simulation);
  bool rows = series_is_due(&recorder->rows, step, last), frame = series_is_due(&recorder->frames, step, last);
  if (!rows && !frame && !last) return true;
  /* a table refuses what is not finite by itself; a look at all cells costs more than its rows */
  if ((frame || last) && !simulation_check(simulation, status)) return false;
  if (rows && !csv_write(recorder->table, step, simulation_discs(simulation), status)) return false;
  if (rows) recorder->rows.recorded = step;
  if (frame && !record_frame(recorder, simulation, status)) return false;
  if (frame) recorder->frames.recorded = step;
  return true;
}

bool recorder_record(struct recorder *recorder, struct simulation *simulation, bool last, struct status *status)
{
  double start = clock_now();
  bool recorded = record_due(recorder, simulation, last, status);
  recorder->seconds += clock_now() - start;
  return recorded;
}

bool recorder_finish(struct recorder *recorder, struct status *status)
{
  return csv_close(&recorder->table, status);
}

bool recorder_summarise(const struct recorder *recorder, const struct summary *summary, struct status *status)
{
  return summary_write(summary, recorder->summary_path, status);
}

double recorder_seconds(const struct recorder *recorder)
{
  return recorder->seconds;
}

void recorder_destroy(struct recorder *recorder)
{
  if (!recorder) return;
  struct status ignored;
  csv_close(&recorder->table, &ignored);
  free(recorder->ux);
  free(recorder->uy);
  free(recorder->case_path);
  free(recorder->table_path);
  free(recorder->frames_path);
  free(recorder->summary_path);
  free(recorder);
}
