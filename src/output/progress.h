/* Progress of a run on a stream: a bar redrawn in place on a terminal, plain lines elsewhere. */
#ifndef DELBM_OUTPUT_PROGRESS_H
#define DELBM_OUTPUT_PROGRESS_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum progress_style { PROGRESS_NONE, PROGRESS_LINES, PROGRESS_BAR };

struct progress {
  enum progress_style style;
  FILE *stream;
  int64_t first; /* step from which this run began */
  int64_t steps; /* of the whole run */
  double cells;  /* of the domain */
  double start;  /* clock, s */
  double shown;  /* clock when last shown, and the step */
  int64_t shown_step;
};

/* The style that suits the stream. */
enum progress_style progress_style(FILE *stream);

/* Starts the clock and shows the first step. */
void progress_start(struct progress *progress, enum progress_style style, FILE *stream, int64_t first, int64_t steps,
                    double cells);

/* Shows the step if due: the bar at most ten times a second, a line every 10 s and at each quarter of the run. */
void progress_update(struct progress *progress, int64_t step);

/* Ends the bar's line in its last state. */
void progress_finish(struct progress *progress, int64_t step);

enum { PROGRESS_TIME = 32 };

/* "1:05", "2:00:00" or "3d 04:05:06"; "-" for a time that is not finite or too long. */
void progress_time(char text[PROGRESS_TIME], double seconds);

#endif
