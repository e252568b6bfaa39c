/* The folder of a run: case.yaml, particles.csv, fields.h5, frames/, checkpoints and run.json, each written when it is
 * due. It is locked while a recorder is open on it. */
#ifndef DELBM_OUTPUT_RECORDER_H
#define DELBM_OUTPUT_RECORDER_H

#include "output/summary.h"

struct recorder;

/* Makes the folder ready: removes the files of an earlier run (*replaced tells whether there was one), writes case.yaml
 * and starts particles.csv. The scene must outlive the recorder. */
bool recorder_open(struct recorder **recorder, const struct scene *scene, const char *directory, bool *replaced,
                   struct status *status);

/* How a run was taken up again. */
struct resumption {
  struct status refused; /* why a checkpoint was passed over; DELBM_OK: none was */
  bool other_kernel;     /* the run began with another kernel, whose results may differ in the last bit */
};

/* Takes up the run in the folder from the newer of its good checkpoints: restores the simulation, just created from the
 * scene, and cuts the files back to what they were then. What is due at that step is yet to be recorded. The scene may
 * differ in its length and in what it records. Fails with DELBM_IO if no checkpoint can be used. */
bool recorder_resume(struct recorder **recorder, const struct scene *scene, const char *directory,
                     struct simulation *simulation, struct resumption *resumption, struct status *status);

/* The next step after `step` at which something is to be recorded; the last step of the run if nothing is due
 * before. */
int64_t recorder_next(const struct recorder *recorder, int64_t step);

/* Records what is due at the simulation's step: at step 0, at multiples of each `every`, and with `last` everything
 * that the scene records at all. Nothing is recorded twice, and nothing of a simulation that has diverged. A checkpoint
 * comes first: the run that it is taken up from records that step again. */
bool recorder_record(struct recorder *recorder, struct simulation *simulation, bool last, struct status *status);

/* Writes a checkpoint at the simulation's step, in place of the older of the two. */
bool recorder_checkpoint(struct recorder *recorder, struct simulation *simulation, struct status *status);

/* closes particles.csv and fields.xdmf. */
bool recorder_finish(struct recorder *recorder, struct status *status);

/* Writes run.json. */
bool recorder_summarise(const struct recorder *recorder, const struct summary *summary, struct status *status);

/* Seconds of the run, before it was interrupted too, and those of them spent on output: STAGE_OUTPUT. */
double recorder_elapsed(const struct recorder *recorder);
double recorder_seconds(const struct recorder *recorder);

void recorder_destroy(struct recorder *recorder);

#endif
