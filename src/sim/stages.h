/* The stages of the step: names, timers, and the stages that a scene needs. Other stages are neither run nor
 * allocated. */
#ifndef DELBM_SIM_STAGES_H
#define DELBM_SIM_STAGES_H

#include "model/scene.h"

/* STAGE_BOUNDARY: always 0 seconds, since links to sides are part of the sweep; run.json lists it. */
enum stage { STAGE_OCCUPATION, STAGE_CONTACT, STAGE_EXCHANGE, STAGE_SWEEP, STAGE_BOUNDARY, STAGE_OUTPUT, STAGE_COUNT };

/* Wall time of each stage since the creation of the simulation, seconds. */
struct stage_times {
  double seconds[STAGE_COUNT];
};

/* Name of the stage, as in run.json. */
const char *stage_name(enum stage stage);

enum occupation_need { OCCUPATION_NEVER, OCCUPATION_ONCE, OCCUPATION_EVERY_STEP };

struct stages {
  enum occupation_need occupation;
  bool fluid;    /* there is fluid: the sweep */
  bool discs;    /* there are discs */
  bool exchange; /* there are both */
  bool pairs;    /* contacts of discs are possible: two discs or more, one of them free */
  bool walls;    /* contacts with sides are possible: a free disc and a side that is not periodic */
  bool substeps; /* stiffness may require several contact sub-steps */
  bool force;    /* fluid.force or zero_flux: the kernel with a body force */
};

struct stages stages_of(const struct scene *scene);

/* Threads of the parallel region of a step. */
int stages_threads(const struct scene *scene);

#endif
