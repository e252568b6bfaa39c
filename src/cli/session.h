/* A run of a simulation: steps, recording, progress, signals, and report of the outcome. */
#ifndef DELBM_CLI_SESSION_H
#define DELBM_CLI_SESSION_H

#include "output/recorder.h"

struct session {
  const struct scene *scene;
  const char *directory;
  struct simulation *simulation;
  struct recorder *recorder;
  bool quiet;
};

/* Runs from the present step of the simulation to run.steps. SIGINT, SIGTERM and SIGHUP end the run after a checkpoint.
 * Returns the exit code; reports errors. */
int session_run(const struct session *session);

#endif
