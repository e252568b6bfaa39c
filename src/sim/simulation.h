/* A simulation of a scene. Between two calls all rows and all discs are at the same step, and the state is complete:
 * fluid, discs, their occupation, and the sums of the coming exchange. After a failed simulation_advance the
 * simulation can be reported and destroyed, no more (simulation_usable). Calls are for one thread at a time; threads
 * are started inside. Order of the step: simulation.c. */
#ifndef DELBM_SIM_SIMULATION_H
#define DELBM_SIM_SIMULATION_H

#include "base/store.h"
#include "base/threads.h"
#include "model/scene.h"
#include "sim/initial.h"
#include "sim/instant.h"
#include "sim/sample.h"
#include "sim/stages.h"
#include "solid/discs.h"

struct occupation;
struct simulation;

/* Creates fluid at rest (density 1), unless fluid.none, and the discs of the scene. The scene must outlive the
 * simulation. */
bool simulation_create(struct simulation **simulation, const struct scene *scene, struct status *status);
void simulation_destroy(struct simulation *simulation);

/* Memory of a simulation of the scene, bytes. Measured: all tables are created, and the discs take one step in fluid at
 * rest whose pages are mapped but not written, hence not resident. Costs one step without its sweep. */
struct simulation_memory {
  double populations; /* 0 without fluid */
  double tables;      /* all other arrays; growing lists count twice, as old and new copies exist at the peak */
};
bool simulation_measure(const struct scene *scene, struct simulation_memory *memory, struct status *status);

/* Replaces the initial state of the fluid, of which there must be some. To be called before the first step. */
void simulation_start(struct simulation *simulation, flow_initial *initial, const void *context);

/* Advances by `steps` steps. Fails (DELBM_FAILED) when the run has diverged: a value that is not finite, or a Mach
 * number above 0.6, detected within run.check steps; the message names the value, the cell or disc, and the step. */
bool simulation_advance(struct simulation *simulation, int64_t steps, struct status *status);

/* False after a failure, with its reason in *status. */
bool simulation_usable(const struct simulation *simulation, struct status *status);

/* Checks for divergence now. To be called before output, so that no file contains a NaN. */
bool simulation_check(struct simulation *simulation, struct status *status);

/* Saves the state, or restores it into a simulation of the same scene. Steps after a restoration are bit-identical to
 * steps of an unbroken run, on any number of threads. Saving checks for divergence first and then fails with
 * DELBM_FAILED. After a failed restoration the simulation can only be destroyed. */
bool simulation_save(struct simulation *simulation, struct store *store, struct status *status);
bool simulation_restore(struct simulation *simulation, struct store *store, struct status *status);

/* Name of the sweep kernel, chosen by the processor and the scene, or "none"; results of two kernels may differ in the
 * last bit. */
const char *simulation_kernel(const struct simulation *simulation);

int64_t simulation_step(const struct simulation *simulation);
const struct scene *simulation_scene(const struct simulation *simulation);
const struct discs *simulation_discs(const struct simulation *simulation);

/* Changes by the caller between steps: to the arrays of the discs directly, and to the fluid, if there is any, by
 * simulation_set_fluid, which sets all cells to the equilibrium of a density and velocity (arrays as in
 * simulation_fields). After the last change and before the next step, simulation_changed updates all derived state. It fails if memory runs out, or if
 * the simulation has failed before. */
void simulation_set_fluid(struct simulation *simulation, const double *density, const double *ux, const double *uy);
bool simulation_changed(struct simulation *simulation, struct status *status);

/* Reverts a simulation_changed that ran out of memory, after the caller has reset the arrays of the discs. False if
 * memory runs out again: the simulation can then only be destroyed. */
bool simulation_unchanged(struct simulation *simulation);

/* Occupation at the present step; NULL in a scene without discs or without fluid. */
const struct occupation *simulation_occupation(const struct simulation *simulation);

/* In a scene with fluid: density and velocity of every cell, row by row from the bottom: arrays of size[0] * size[1].
 * Any may be NULL. */
void simulation_fields(struct simulation *simulation, double *density, double *ux, double *uy);

/* In a scene with fluid: samples on part of the cells (sample.h). */
bool simulation_sample(struct simulation *simulation, const struct sample_grid *grid, const struct sample *sample,
                       struct status *status);

/* The figures of the present step. Fails only for want of memory. */
bool simulation_instant(struct simulation *simulation, struct instant *instant, struct status *status);

/* The figures of run.json. */
struct simulation_report {
  int threads;
  const char *kernel;
  struct stage_times times;   /* STAGE_OUTPUT: 0, measured by the caller */
  double mass_drift;          /* |mass - initial mass| / initial mass, of the fluid; 0 without fluid */
  double momentum_drift;      /* change of the conserved momentum less the impulse of body forces, over the mass of the
                               fluid, without fluid of the discs; larger component; NAN where sides, or discs that are
                               not free, exchange momentum */
  double mean_velocity[2];    /* momentum of the fluid over its mass, cells inside discs included, cells/step; 0 without
                               fluid */
  double max_mach;            /* largest at the checks for divergence, and at a divergence */
  char blocking[32];          /* blocking of the sweep in time: off, its depth, or depth x width */
  char binding[THREADS_TEXT]; /* of threads to processors */
  int max_substeps;           /* largest number of contact sub-steps of a step so far */
  double max_overlap;         /* largest overlap of a contact so far, over the smaller radius; NAN if memory ran out */
};
void simulation_report(struct simulation *simulation, struct simulation_report *report);

#endif
