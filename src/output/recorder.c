#include "output/recorder.h"

#include "base/clock.h"
#include "base/memory.h"
#include "case/case_write.h"
#include "output/checkpoint.h"
#include "output/csv.h"
#include "output/fields.h"
#include "output/file.h"
#include "output/numbered.h"
#include "output/picture.h"
#include "output/series.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

/* An output at regular steps. */
struct schedule {
  int64_t every;    /* 0: never */
  int64_t recorded; /* last recorded step; -1 before the first */
};

enum { CHECKPOINTS = 2 };

struct recorder {
  const struct scene *scene;
  char *case_path, *discs_path, *series_path, *frames_path, *snapshots_path, *summary_path,
      *checkpoint_path[CHECKPOINTS];
  char *directory;
  int lock;             /* descriptor of the locked folder; -1: not open */
  struct table *discs;  /* particles.csv */
  struct table *series; /* series.csv */
  struct fields *fields;
  struct schedule rows, series_rows, frames, snapshots, checkpoints;
  int next_checkpoint;  /* index of the checkpoint to be written next */
  uint32_t fingerprint; /* of the case */
  double *ux, *uy;      /* fields of a frame; NULL without frames or without fluid */
  double *values;       /* colour values of discs; NULL: plain discs */
  double start;         /* clock at step 0, less interruptions */
  double seconds;       /* time of output */
};

static bool is_due(const struct schedule *schedule, int64_t step, bool last)
{
  return schedule->every > 0 && step != schedule->recorded && (last || step % schedule->every == 0);
}

static int64_t next_due(const struct schedule *schedule, int64_t step, int64_t end)
{
  int64_t left = schedule->every > 0 ? schedule->every - step % schedule->every : end;
  return left < end - step ? step + left : end;
}

static bool remove_named(const char *directory, const char *name, struct status *status)
{
  char *path = file_join(directory, name, status);
  bool removed = path && file_remove(path, status);
  free(path);
  return removed;
}

static bool remove_checkpoints(const struct recorder *recorder, struct status *status)
{
  for (int k = 0; k < CHECKPOINTS; k++)
    if (!file_remove(recorder->checkpoint_path[k], status)) return false;
  return true;
}

static bool remove_earlier_run(const struct recorder *recorder, bool *replaced, struct status *status)
{
  *replaced = access(recorder->summary_path, F_OK) == 0 || access(recorder->discs_path, F_OK) == 0 ||
              access(recorder->series_path, F_OK) == 0;
  return remove_checkpoints(recorder, status) && file_remove(recorder->summary_path, status) &&
         file_remove(recorder->discs_path, status) && file_remove(recorder->series_path, status) &&
         remove_named(recorder->directory, "fields.h5", status) &&
         remove_named(recorder->directory, "fields.xdmf", status) &&
         numbered_remove_folder(recorder->snapshots_path, "h5", status) &&
         numbered_remove(recorder->frames_path, 0, "png", status);
}

/* Prevents two runs in one folder. No lock on file systems without locks. */
static bool lock_folder(struct recorder *recorder, struct status *status)
{
  recorder->lock = open(recorder->directory, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (recorder->lock < 0) return file_fail(status, "open folder", recorder->directory, errno);
  if (flock(recorder->lock, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return true;
  return status_fail(status, DELBM_IO, "another delbm is running in %s", recorder->directory);
}

static bool write_case(const struct recorder *recorder, struct status *status)
{
  struct replacement file;
  if (!replacement_begin(&file, recorder->case_path, status)) return false;
  errno = 0;
  if (case_write(recorder->scene, file.stream)) return replacement_commit(&file, status);
  file_fail(status, "write", recorder->case_path, errno);
  replacement_abandon(&file);
  return false;
}

static bool prepare_frames(const struct recorder *recorder, struct status *status)
{
  return recorder->frames.every == 0 || file_make_directory(recorder->frames_path, status);
}

/* Opens a table with rows at `schedule`, truncated to `length` bytes; 0: with its header alone. */
static bool open_table(const struct recorder *recorder, struct table **table, const struct schedule *schedule,
                       const char *path, const struct table_layout *layout, int64_t length, struct status *status)
{
  const struct units *units = &recorder->scene->units;
  if (schedule->every == 0) return true;
  if (length == 0) return table_open(table, path, layout, units, status);
  return table_reopen(table, path, layout, units, length, status);
}

static bool open_tables(struct recorder *recorder, const struct run_record *record, struct status *status)
{
  return open_table(recorder, &recorder->discs, &recorder->rows, recorder->discs_path, &csv_layout, record->discs_bytes,
                    status) &&
         open_table(recorder, &recorder->series, &recorder->series_rows, recorder->series_path, &series_layout,
                    record->series_bytes, status);
}

static bool start_files(struct recorder *recorder, struct status *status)
{
  return open_tables(recorder, &(struct run_record){0}, status) &&
         (recorder->snapshots.every == 0 ||
          fields_open(&recorder->fields, recorder->scene, recorder->directory, &(struct fields_mark){0}, status)) &&
         prepare_frames(recorder, status);
}

static double *allocate_field(const struct recorder *recorder, struct status *status)
{
  const int *size = recorder->scene->domain.size;
  return memory_allocate((size_t)size[0] * (size_t)size[1], sizeof(double), "the velocities of a frame", status);
}

static bool prepare_velocities(struct recorder *recorder, struct status *status)
{
  if (recorder->frames.every == 0) return true;
  if (!recorder->scene->fluid.none &&
      !((recorder->ux = allocate_field(recorder, status)) && (recorder->uy = allocate_field(recorder, status))))
    return false;
  if (recorder->scene->output.frames.discs == FRAME_DISCS_PLAIN) return true;
  const size_t discs = recorder->scene->particles.count;
  recorder->values = memory_allocate(discs > 0 ? discs : 1, sizeof(double), "the colours of a frame", status);
  return recorder->values;
}

static bool prepare_paths(struct recorder *recorder, const char *directory, struct status *status)
{
  const struct {
    char **path;
    const char *name;
  } paths[] = {{&recorder->case_path, "case.yaml"},
               {&recorder->discs_path, "particles.csv"},
               {&recorder->series_path, "series.csv"},
               {&recorder->frames_path, "frames"},
               {&recorder->snapshots_path, "fields"},
               {&recorder->summary_path, "run.json"},
               {&recorder->checkpoint_path[0], "checkpoint.0"},
               {&recorder->checkpoint_path[1], "checkpoint.1"}};
  for (size_t k = 0; k < sizeof paths / sizeof paths[0]; k++)
    if (!(*paths[k].path = file_join(directory, paths[k].name, status))) return false;
  recorder->directory = strdup(directory);
  return recorder->directory || status_fail(status, DELBM_FAILED, "out of memory: a path");
}

/* Paths and memory of a recorder, without access to the disk. */
static bool create(struct recorder **recorder, const struct scene *scene, const char *directory, struct status *status)
{
  *recorder = NULL;
  if (scene->output.frames.every > 0 && !PICTURE_SUPPORTED)
    return status_fail(status, DELBM_INVALID,
                       "output.frames.every is %" PRId64 ", but this build has no libpng: only 0",
                       scene->output.frames.every);
  if (scene->output.fields.every > 0 && !FIELDS_SUPPORTED)
    return status_fail(status, DELBM_INVALID, "output.fields.every is %" PRId64 ", but this build has no HDF5: only 0",
                       scene->output.fields.every);
  *recorder = memory_allocate(1, sizeof **recorder, "the record of the run", status);
  if (!*recorder) return false;
  **recorder = (struct recorder){.scene = scene,
                                 .lock = -1,
                                 .rows = {.every = scene->output.every, .recorded = -1},
                                 .series_rows = {.every = scene->output.series.every, .recorded = -1},
                                 .frames = {.every = scene->output.frames.every, .recorded = -1},
                                 .snapshots = {.every = scene->output.fields.every, .recorded = -1},
                                 .checkpoints = {.every = scene->output.checkpoint.every, .recorded = -1}};
  return prepare_paths(*recorder, directory, status) && prepare_velocities(*recorder, status) &&
         case_fingerprint(scene, &(*recorder)->fingerprint, status);
}

static bool destroy_unless(bool good, struct recorder **recorder)
{
  if (good) return true;
  recorder_destroy(*recorder);
  *recorder = NULL;
  return false;
}

/* The earlier run is removed after the checks. */
static bool begin(struct recorder *recorder, bool *replaced, struct status *status)
{
  if (!file_make_directory(recorder->directory, status) || !lock_folder(recorder, status) ||
      !remove_earlier_run(recorder, replaced, status) || !write_case(recorder, status) ||
      !start_files(recorder, status))
    return false;
  recorder->start = clock_now();
  return true;
}

bool recorder_open(struct recorder **recorder, const struct scene *scene, const char *directory, bool *replaced,
                   struct status *status)
{
  *replaced = false;
  return destroy_unless(create(recorder, scene, directory, status) && begin(*recorder, replaced, status), recorder);
}

/* Index of the newer valid checkpoint; `refused`: error of an invalid checkpoint. */
static bool choose_checkpoint(const struct recorder *recorder, int *chosen, struct checkpoint_head *head,
                              struct status *refused)
{
  *chosen = -1;
  refused->code = DELBM_OK;
  for (int k = 0; k < CHECKPOINTS; k++) {
    struct checkpoint_head found;
    const char *path = recorder->checkpoint_path[k];
    if (access(path, F_OK) != 0 || !checkpoint_examine(path, recorder->fingerprint, &found, refused)) continue;
    if (*chosen >= 0 && found.step <= head->step) continue;
    *chosen = k;
    *head = found;
  }
  return *chosen >= 0;
}

/* Also without further snapshots: the earlier snapshots are joined at the end of the run. */
static bool reopen_fields(struct recorder *recorder, int64_t step, int64_t count, struct status *status)
{
  if (recorder->snapshots.every == 0 && (count == 0 || !FIELDS_SUPPORTED)) return true;
  const struct fields_mark mark = {step, count};
  return fields_open(&recorder->fields, recorder->scene, recorder->directory, &mark, status);
}

static bool resume(struct recorder *recorder, struct simulation *simulation, struct resumption *resumption,
                   struct status *status)
{
  int chosen;
  struct checkpoint_head head;
  struct run_record record;
  if (!lock_folder(recorder, status)) return false;
  if (!choose_checkpoint(recorder, &chosen, &head, &resumption->refused)) {
    if (resumption->refused.code == DELBM_OK)
      return status_fail(status, DELBM_IO, "nothing to resume: %s contains no checkpoint", recorder->directory);
    *status = resumption->refused;
    resumption->refused.code = DELBM_OK;
    return false;
  }
  if (head.step > recorder->scene->run.steps)
    return status_fail(status, DELBM_INVALID, "the checkpoint is of step %" PRId64 ", beyond run.steps = %" PRId64,
                       head.step, recorder->scene->run.steps);
  resumption->other_kernel = strcmp(head.kernel, simulation_kernel(simulation)) != 0;
  if (!checkpoint_read(recorder->checkpoint_path[chosen], simulation, &record, status) ||
      !file_remove(recorder->summary_path, status) || !write_case(recorder, status) ||
      !open_tables(recorder, &record, status) || !reopen_fields(recorder, head.step, record.snapshots, status) ||
      !prepare_frames(recorder, status) || !numbered_remove(recorder->frames_path, head.step, "png", status))
    return false;
  recorder->next_checkpoint = !chosen;
  recorder->checkpoints.recorded = head.step;
  recorder->seconds = record.output;
  recorder->start = clock_now() - record.seconds;
  return true;
}

bool recorder_resume(struct recorder **recorder, const struct scene *scene, const char *directory,
                     struct simulation *simulation, struct resumption *resumption, struct status *status)
{
  *resumption = (struct resumption){0};
  return destroy_unless(create(recorder, scene, directory, status) && resume(*recorder, simulation, resumption, status),
                        recorder);
}

static int64_t earlier(int64_t a, int64_t b)
{
  return a < b ? a : b;
}

int64_t recorder_next(const struct recorder *recorder, int64_t step)
{
  int64_t end = recorder->scene->run.steps;
  const struct schedule *const all[] = {&recorder->rows, &recorder->series_rows, &recorder->frames,
                                        &recorder->snapshots, &recorder->checkpoints};
  int64_t next = end;
  for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) next = earlier(next, next_due(all[k], step, end));
  return next;
}

/* Sets the colour values of the discs; returns the end of the scale (struct picture). The height at step 0 comes
 * from the case, so that a resumed run draws the same pictures. */
static double set_values(const struct recorder *recorder, const struct discs *discs)
{
  const struct scene *scene = recorder->scene;
  const enum frame_discs kind = scene->output.frames.discs;
  double largest = 0;
  for (size_t i = 0; i < discs->count; i++) {
    recorder->values[i] = kind == FRAME_DISCS_HEIGHT  ? scene->particles.discs[i].position[1]
                          : kind == FRAME_DISCS_SPEED ? hypot(discs->vx[i], discs->vy[i])
                                                      : discs->radius[i];
    largest = fmax(largest, recorder->values[i]);
  }
  if (kind == FRAME_DISCS_HEIGHT) return scene->domain.size[1];
  if (kind == FRAME_DISCS_SPEED && scene->output.frames.quantity == FRAME_SPEED) {
    if (!scene->fluid.none) return 0;
    if (scene->output.frames.maximum > 0) return scene->output.frames.maximum;
  }
  return largest > 0 ? largest : 1;
}

static bool record_frame(struct recorder *recorder, struct simulation *simulation, struct status *status)
{
  const struct scene *scene = recorder->scene;
  char *path = numbered_path(recorder->frames_path, simulation_step(simulation), "png", status);
  if (!path) return false;
  if (!scene->fluid.none) simulation_fields(simulation, NULL, recorder->ux, recorder->uy);
  struct picture picture = {.size = {scene->domain.size[0], scene->domain.size[1]},
                            .ux = recorder->ux,
                            .uy = recorder->uy,
                            .periodic = {scene_is_periodic(scene, 0), scene_is_periodic(scene, 1)},
                            .discs = simulation_discs(simulation),
                            .quantity = scene->output.frames.quantity,
                            .maximum = scene->output.frames.maximum,
                            .values = recorder->values};
  if (recorder->values) picture.values_end = set_values(recorder, picture.discs);
  bool written = picture_write(&picture, path, status);
  free(path);
  return written;
}

static bool write_checkpoint(struct recorder *recorder, struct simulation *simulation, struct status *status)
{
  struct run_record record = {.seconds = recorder_elapsed(recorder), .output = recorder->seconds};
  if (recorder->discs && !table_sync(recorder->discs, &record.discs_bytes, status)) return false;
  if (recorder->series && !table_sync(recorder->series, &record.series_bytes, status)) return false;
  if (recorder->fields) record.snapshots = fields_count(recorder->fields);
  if (!file_stays(recorder->lock, recorder->directory, status)) return false; /* last check before the path is used */
  if (!checkpoint_write(recorder->checkpoint_path[recorder->next_checkpoint], recorder->fingerprint, simulation,
                        &record, status))
    return false;
  recorder->next_checkpoint = !recorder->next_checkpoint;
  recorder->checkpoints.recorded = simulation_step(simulation);
  return true;
}

/* Replaces an error of the system by the reason that the folder was moved or removed, if so. */
static bool explain(const struct recorder *recorder, bool good, struct status *status)
{
  struct status other;
  if (good || status->code != DELBM_IO) return good;
  if (!file_stays(recorder->lock, recorder->directory, &other)) *status = other;
  return false;
}

bool recorder_checkpoint(struct recorder *recorder, struct simulation *simulation, struct status *status)
{
  if (recorder->checkpoints.recorded == simulation_step(simulation)) return true;
  const double start = clock_now();
  const bool written = write_checkpoint(recorder, simulation, status);
  recorder->seconds += clock_now() - start;
  return explain(recorder, written, status);
}

static bool record_instant(struct recorder *recorder, struct simulation *simulation, struct status *status)
{
  struct instant instant;
  return simulation_instant(simulation, &instant, status) &&
         series_write(recorder->series, simulation_step(simulation), &instant, status);
}

static bool record_due(struct recorder *recorder, struct simulation *simulation, bool last, struct status *status)
{
  int64_t step = simulation_step(simulation);
  if (step > 0 && is_due(&recorder->checkpoints, step, last) && !write_checkpoint(recorder, simulation, status))
    return false;
  bool rows = is_due(&recorder->rows, step, last), frame = is_due(&recorder->frames, step, last);
  bool series = is_due(&recorder->series_rows, step, last), snapshot = is_due(&recorder->snapshots, step, last);
  if (!rows && !series && !frame && !snapshot && !last) return true;
  if (!file_stays(recorder->lock, recorder->directory, status)) return false;
  /* csv_write checks its rows by itself; a check of all cells costs more than the rows */
  if ((series || frame || snapshot || last) && !simulation_check(simulation, status)) return false;
  if (rows && !csv_write(recorder->discs, step, simulation_discs(simulation), status)) return false;
  if (rows) recorder->rows.recorded = step;
  if (series && !record_instant(recorder, simulation, status)) return false;
  if (series) recorder->series_rows.recorded = step;
  if (frame && !record_frame(recorder, simulation, status)) return false;
  if (frame) recorder->frames.recorded = step;
  if (snapshot && !fields_write(recorder->fields, simulation, status)) return false;
  if (snapshot) recorder->snapshots.recorded = step;
  if (last && recorder->fields && !fields_join(recorder->fields, status)) return false;
  /* without `every` a checkpoint exists only after an interruption and is obsolete at the end */
  return !last || recorder->checkpoints.every > 0 || remove_checkpoints(recorder, status);
}

bool recorder_record(struct recorder *recorder, struct simulation *simulation, bool last, struct status *status)
{
  double start = clock_now();
  bool recorded = record_due(recorder, simulation, last, status);
  recorder->seconds += clock_now() - start;
  return explain(recorder, recorded, status);
}

bool recorder_finish(struct recorder *recorder, struct status *status)
{
  struct status ignored;
  const bool discs = table_close(&recorder->discs, status);
  const bool tables = table_close(&recorder->series, discs ? status : &ignored) && discs;
  return fields_close(&recorder->fields, tables ? status : &ignored) && tables;
}

bool recorder_summarise(const struct recorder *recorder, const struct summary *summary, struct status *status)
{
  return file_stays(recorder->lock, recorder->directory, status) &&
         summary_write(summary, recorder->summary_path, status);
}

double recorder_elapsed(const struct recorder *recorder)
{
  return clock_now() - recorder->start;
}

double recorder_seconds(const struct recorder *recorder)
{
  return recorder->seconds;
}

void recorder_destroy(struct recorder *recorder)
{
  if (!recorder) return;
  struct status ignored;
  table_close(&recorder->discs, &ignored);
  table_close(&recorder->series, &ignored);
  fields_close(&recorder->fields, &ignored);
  free(recorder->directory);
  free(recorder->ux);
  free(recorder->uy);
  free(recorder->values);
  free(recorder->case_path);
  free(recorder->discs_path);
  free(recorder->series_path);
  free(recorder->frames_path);
  free(recorder->snapshots_path);
  free(recorder->summary_path);
  for (int k = 0; k < CHECKPOINTS; k++) free(recorder->checkpoint_path[k]);
  if (recorder->lock >= 0) close(recorder->lock);
  free(recorder);
}
