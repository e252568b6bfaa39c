/* Stage timers: monotonic wall time, summed per stage of the step. */
#ifndef DELBM_BASE_CLOCK_H
#define DELBM_BASE_CLOCK_H

/* STAGE_BOUNDARY takes no time of its own: the links to the sides are part of the sweep. run.json keeps its name. */
enum stage { STAGE_OCCUPATION, STAGE_CONTACT, STAGE_EXCHANGE, STAGE_SWEEP, STAGE_BOUNDARY, STAGE_OUTPUT, STAGE_COUNT };

/* Seconds spent in each stage since the simulation was created. */
struct stage_times {
  double seconds[STAGE_COUNT];
};

/* The stage's name as it stands in run.json. */
const char *stage_name(enum stage stage);

/* Seconds of a monotonic clock. */
double clock_now(void);

#endif
