/* The stages of the step: their names and timers, and which of them a scene needs. What a scene does not need is neither run nor
 * allocated. */
#ifndef DELBM_SIM_PLAN_H
#define DELBM_SIM_PLAN_H

#include "model/scene.h"

/* STAGE_BOUNDARY takes no time of its own: the links to the sides are part of the sweep. run.json keeps its name. */
enum stage { STAGE_OCCUPATION, STAGE_CONTACT, STAGE_EXCHANGE, STAGE_SWEEP, STAGE_BOUNDARY, STAGE_OUTPUT, STAGE_COUNT };

/* Seconds of wall time spent in each stage since the simulation was created. */
struct stage_times {
  double seconds[STAGE_COUNT];
};

/* Name of the stage, as in run.json. */
const char *stage_name(enum stage stage);

enum occupation_need { OCCUPATION_NEVER, OCCUPATION_ONCE, OCCUPATION_EVERY_STEP };

struct stages {
  enum occupation_need occupation;
  bool exchange; /* there are discs */
  bool pairs;    /* two discs, one of them moving, can meet */
  bool walls;    /* a free disc can meet a side */
  bool substeps; /* contacts may be stiff enough to need several sub-steps */
  bool force;    /* the kernel with a body force */
};

struct stages stages_of(const struct scene *scene);

#endif
