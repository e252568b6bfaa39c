/* The choice of blocking (blocked.h) by measurement, a plan as in FFTW. The first blocks of a run are trials of
 * different depths and widths; trials are steps of the run, with the same results for any choice. The key run.plan
 * fixes the choice. */
#ifndef DELBM_SIM_TUNING_H
#define DELBM_SIM_TUNING_H

#include "sim/blocked.h"

enum { TUNING_TEXT = 32 };

struct tuning {
  struct blocking best;
  bool decided;     /* no more trials */
  int trial;        /* number of the next trial */
  int max_width;    /* width of the box: tiles are narrower */
  int max_depth;    /* maximum depth, from box, threads and zero_flux */
  double best_time; /* seconds a step */
};

/* Starts with trials, or without: with a depth from run.plan, or with discs. No block is longer than an interval of
 * zero_flux. */
void tuning_start(struct tuning *tuning, const struct scene *scene, int threads);

/* Blocking of the next block of at most `steps`. */
struct blocking tuning_next(const struct tuning *tuning, int64_t steps);

/* Records the duration of a block with the blocking of tuning_next. */
void tuning_note(struct tuning *tuning, const struct blocking *blocking, double seconds_per_step);

/* The choice as text: off, 16 or 16x512. */
void tuning_text(const struct tuning *tuning, char text[TUNING_TEXT]);

#endif
