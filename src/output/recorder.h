/* The folder of a run: case.yaml, particles.csv, frames/ and run.json, each written when it is due. */
#ifndef DELBM_OUTPUT_RECORDER_H
#define DELBM_OUTPUT_RECORDER_H

#include "output/summary.h"

struct recorder;

/* Makes the folder ready: removes the files of an earlier run (*replaced tells whether there was one), writes case.yaml
 * and starts particles.csv. The scene must outlive the recorder. */
bool recorder_open(struct recorder **recorder, const struct scene *scene, const char *directory, bool *replaced,
                   struct status *status);

/* The next step after `step` at which something is to be recorded; the last step of the run if nothing is due
 * before. */
int64_t recorder_next(const struct recorder *recorder, int64_t step);

/* Records what is due at the simulation's step: at step 0, at multiples of each `every`, and with `last` everything
 * that the scene records at all. Nothing is recorded twice, and nothing of a simulation that has diverged. */
bool recorder_record(struct recorder *recorder, struct simulation *simulation, bool last, struct status *status);

/* Closes particles.csv. */
bool recorder_finish(struct recorder *recorder, struct status *status);

/* Writes run.json. */
bool recorder_summarise(const struct recorder *recorder, const struct summary *summary, struct status *status);

/* Seconds spent in recorder_record so far: STAGE_OUTPUT. */
double recorder_seconds(const struct recorder *recorder);

void recorder_destroy(struct recorder *recorder);

#endif
