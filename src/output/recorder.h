/* The folder of a run: case.yaml, particles.csv, series.csv, fields.h5, frames/, checkpoints and run.json. Locked while a
 * recorder is open. */
#ifndef DELBM_OUTPUT_RECORDER_H
#define DELBM_OUTPUT_RECORDER_H

#include "output/summary.h"

struct recorder;

/* Creates and locks the folder, removes the files of an earlier run (*replaced: there was one), writes case.yaml and
 * starts particles.csv, series.csv and fields.h5. The scene must outlive the recorder. */
bool recorder_open(struct recorder **recorder, const struct scene *scene, const char *directory, bool *replaced,
                   struct status *status);

/* Result of a resume. */
struct resumption {
  struct status refused; /* error of an invalid checkpoint; DELBM_OK: none */
  bool other_kernel;     /* the checkpoint is from another kernel: results may differ in the last bit */
};

/* Resumes the run in the folder from the newer valid checkpoint: restores the simulation, just created from the
 * scene, and truncates the files to the step of the checkpoint. Output due at this step is not recorded yet. The
 * scene may differ in length and output. Fails with DELBM_IO without a valid checkpoint. */
bool recorder_resume(struct recorder **recorder, const struct scene *scene, const char *directory,
                     struct simulation *simulation, struct resumption *resumption, struct status *status);

/* The next step after `step` with output due; at most the last step of the run. */
int64_t recorder_next(const struct recorder *recorder, int64_t step);

/* Records the output due at the simulation's step: at step 0, at multiples of each `every`, and with `last` every
 * output of the scene. No step is recorded twice; a diverged simulation is an error. A checkpoint precedes the other
 * output, so that a resumed run records its step again. */
bool recorder_record(struct recorder *recorder, struct simulation *simulation, bool last, struct status *status);

/* Writes a checkpoint at the simulation's step over the older of the two. */
bool recorder_checkpoint(struct recorder *recorder, struct simulation *simulation, struct status *status);

/* Closes particles.csv, series.csv and fields.xdmf. */
bool recorder_finish(struct recorder *recorder, struct status *status);

/* Writes run.json. */
bool recorder_summarise(const struct recorder *recorder, const struct summary *summary, struct status *status);

/* Seconds of the run, before interruptions included, and seconds of output (STAGE_OUTPUT). */
double recorder_elapsed(const struct recorder *recorder);
double recorder_seconds(const struct recorder *recorder);

void recorder_destroy(struct recorder *recorder);

#endif
