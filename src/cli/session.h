/* A run from its first step to its last line: steps, what is recorded, progress, signals, and how it ended. */
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

/* Runs to the end of the scene, from the simulation's present step. SIGINT, SIGTERM and SIGHUP end it after a checkpoint.
 * Returns the exit code; what went wrong has been reported. */
int session_run(const struct session *session);

#endif
