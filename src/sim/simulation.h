/* The simulation: a scene set in motion. One step is four stages, each one function (exchange, which the motion of the
 * discs ends behind the contacts; contact; occupation; sweep), run by all threads of one parallel region that spans many
 * steps. */
#ifndef DELBM_SIM_SIMULATION_H
#define DELBM_SIM_SIMULATION_H

#include "base/store.h"
#include "base/threads.h"
#include "model/scene.h"
#include "sim/initial.h"
#include "sim/sample.h"
#include "sim/stages.h"
#include "solid/discs.h"

struct occupation;
struct simulation;

/* Sets up fluid at rest (density 1) and the scene's discs. The scene must outlive the simulation. */
bool simulation_create(struct simulation **simulation, const struct scene *scene, struct status *status);
void simulation_destroy(struct simulation *simulation);

/* Memory of a simulation of the scene, bytes. Measured: all tables are created, and the discs take one step, through fluid at
 * rest to which nothing is written, so that its pages are only promised. Costs one step without its sweep. */
struct simulation_memory {
  double populations;
  double tables; /* all other arrays; lists that grow while they are copied count twice, as at the peak */
};
bool simulation_measure(const struct scene *scene, struct simulation_memory *memory, struct status *status);

/* Before the first step: starts from another state of the fluid than rest. */
void simulation_start(struct simulation *simulation, flow_initial *initial, const void *context);

/* Advances by `steps` steps. Fails (DELBM_FAILED) when the run has diverged: a value that is not finite, or a Mach
 * number above 0.6, found at the latest run.check steps after it arose; the message says which, where and when. */
bool simulation_advance(struct simulation *simulation, int64_t steps, struct status *status);

/* False, with the reason of its failure, for a simulation that has failed. */
bool simulation_usable(const struct simulation *simulation, struct status *status);

/* Looks for divergence now. To be called before anything is written, so that no file holds a NaN. */
bool simulation_check(struct simulation *simulation, struct status *status);

/* Saves the state, or restores it into a simulation of the same scene: all that makes the coming steps the same bits as
 * those of a run that was never stopped, on any number of threads. What has diverged is not saved (DELBM_FAILED). After
 * a failed restoring the simulation can only be destroyed. */
bool simulation_save(struct simulation *simulation, struct store *store, struct status *status);
bool simulation_restore(struct simulation *simulation, struct store *store, struct status *status);

/* Name of the kernel that the processor and the scene allow: others may differ in the last bit. */
const char *simulation_kernel(const struct simulation *simulation);

int64_t simulation_step(const struct simulation *simulation);
const struct scene *simulation_scene(const struct simulation *simulation);
const struct discs *simulation_discs(const struct simulation *simulation);

/* Changes from outside: what stands in the arrays of the discs, and the fluid of all cells, brought to equilibrium at this
 * density and velocity, arrays as those of simulation_fields. To be called between steps; after all of them, and before
 * the next step, simulation_changed follows up. It fails for want of memory, or if the simulation had failed before. */
void simulation_set_fluid(struct simulation *simulation, const double *density, const double *ux, const double *uy);
bool simulation_changed(struct simulation *simulation, struct status *status);

/* Undoes a simulation_changed that lacked memory, once the arrays of the discs are as they were. False if that lacks memory,
 * too: then the simulation can only be destroyed. */
bool simulation_unchanged(struct simulation *simulation);

/* Who covers what now; NULL in a scene without discs. */
const struct occupation *simulation_occupation(const struct simulation *simulation);

/* Density and velocity of every cell, row by row from the bottom: arrays of size[0] * size[1]. Any may be NULL. */
void simulation_fields(struct simulation *simulation, double *density, double *ux, double *uy);

/* Samples on part of the cells (sample.h). */
bool simulation_sample(struct simulation *simulation, const struct sample_grid *grid, const struct sample *sample,
                       struct status *status);

/* The figures of run.json. */
struct simulation_report {
  int threads;
  const char *kernel;
  struct stage_times times; /* STAGE_OUTPUT is the caller's to fill */
  double mass_drift;        /* |mass - initial mass| / initial mass */
  double momentum_drift; /* largest of the two components of the change of the conserved momentum not explained by body
                               forces, over the fluid's mass; NAN where walls, inlets or outlets exchange momentum */
  double mean_velocity[2];    /* momentum of the fluid over its mass, cells inside discs included, cells/step */
  double max_mach;            /* largest seen at the checks for divergence, and where it diverged */
  char blocking[32];          /* blocking of the sweep in time: off, its depth, or depth x width */
  char binding[THREADS_TEXT]; /* of threads to processors */
  int max_substeps;           /* most sub-steps that a step has taken */
};
void simulation_report(struct simulation *simulation, struct simulation_report *report);

#endif
