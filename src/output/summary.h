/* The figures of a run at its end: run.json, and one line for grep. */
#ifndef DELBM_OUTPUT_SUMMARY_H
#define DELBM_OUTPUT_SUMMARY_H

#include "sim/simulation.h"

#include <stdio.h>

enum outcome { OUTCOME_DONE, OUTCOME_DIVERGED, OUTCOME_INTERRUPTED, OUTCOME_FAILED };

struct summary {
  enum outcome outcome;
  const char *message; /* why the run is not done; NULL when it is */
  const char *reason;  /* why the run ended, for any outcome */
  const char *warning; /* known fault of the results; NULL: none */
  const struct scene *scene;
  int64_t steps;
  double seconds;                  /* wall time of steps and output */
  struct simulation_report report; /* with STAGE_OUTPUT filled in */
};

/* Both write the figures under the same names; a figure that is not finite is null, or - in the line. */
bool summary_write(const struct summary *summary, const char *path, struct status *status);
void summary_print(const struct summary *summary, FILE *stream);

#endif
