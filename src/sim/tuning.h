/* The choice of blocking (blocked.h) by measurement: what FFTW calls a plan. The first blocks of a run are its trials,
 * each with another depth and width; every block does real steps, and all give the same results, so that nothing is
 * lost and nothing depends on the choice but time. A case fixes it by run.plan. */
#ifndef DELBM_SIM_TUNING_H
#define DELBM_SIM_TUNING_H

#include "sim/blocked.h"

enum { TUNING_TEXT = 32 };

struct tuning {
  struct blocking best;
  bool settled;     /* no more trials */
  int trial;        /* number of the next one */
  int widest;       /* no tile need be as wide */
  int deepest;      /* that the box, the threads and zero_flux allow */
  double best_time; /* seconds a step */
};

/* Starts with trials, or settled as run.plan says or where discs leave nothing to try. No block is longer than an interval of
 * zero_flux. */
void tuning_start(struct tuning *tuning, const struct scene *scene, int threads);

/* The blocking for the next block, of at most `steps` steps. */
struct blocking tuning_next(const struct tuning *tuning, int64_t steps);

/* Takes note of how long the block that tuning_next asked for has taken. */
void tuning_note(struct tuning *tuning, const struct blocking *blocking, double seconds_per_step);

/* The choice in words: off, 16 or 16x512. */
void tuning_text(const struct tuning *tuning, char text[TUNING_TEXT]);

#endif
