/* Error against cost: cases with a known solution, run at several resolutions for each choice of operator, form,
 * precision and area. A case defines one run; accuracy.c does the rest. */
#ifndef DELBM_BENCH_ACCURACY_H
#define DELBM_BENCH_ACCURACY_H

#include "places.h"
#include "scenes.h"
#include "sim/simulation.h"

/* MAGIC and TWELFTH are mrt with the rate q from the magic parameter, 3/16 and 1/12. */
enum accuracy_operator {
  OPERATOR_BGK,
  OPERATOR_TRT,
  OPERATOR_MRT,
  OPERATOR_MAGIC,
  OPERATOR_TWELFTH,
  OPERATOR_ADAPTIVE,
  OPERATOR_COUNT
};

struct accuracy_choice {
  enum accuracy_operator operator;
  enum coupling_form form;
  enum precision precision;
  enum contact_area area;
};

/* Outcome of one run, or of runs over several places of the disc within a cell. */
struct accuracy_outcome {
  double error;            /* the mean over the places; NAN where a run diverged */
  double worst;            /* largest over the places */
  double seconds, updates; /* of the steps alone; the mean over the places */
};

/* `context`: the result of `prepare`. */
typedef bool accuracy_run(void *context, const struct accuracy_choice *choice, int resolution,
                          struct accuracy_outcome *outcome, struct status *status);

enum { RESOLUTIONS = 5 };

struct accuracy_case {
  const char *name;
  const char *error;           /* definition of the error */
  const char *axis;            /* meaning of the resolution */
  int resolution[RESOLUTIONS]; /* ends with 0 if there are fewer */
  int quick;                   /* number of resolutions in a quick run */
  double bound; /* of the error of the program's defaults at the coarsest resolution: beyond it the benchmark fails */
  int places;   /* number of places within a cell over which a run averages; 0: no average */
  bool with_forms, with_areas; /* false: only the defaults; contacts are independent of the operator */
  accuracy_run *run;
  void *(*prepare)(bool quick, struct status *status); /* context of all runs; NULL: none */
  void (*finish)(void *context);
};

extern const struct accuracy_case accuracy_taylor_green, accuracy_poiseuille, accuracy_couette, accuracy_shear_layer,
    accuracy_spin, accuracy_drag, accuracy_settling, accuracy_crossing, accuracy_impact;

/* scene_box with the settings of the choice. */
struct scene accuracy_scene(const struct accuracy_choice *choice, int nx, int ny, double viscosity, enum sides sides);
void accuracy_apply(const struct accuracy_choice *choice, struct scene *scene);

/* Runs a case at one place: *deviation is its error with sign; adds its cost to `cost`. */
typedef bool accuracy_run_at(const struct accuracy_choice *choice, int resolution, const struct offset *offset,
                             double *deviation, struct accuracy_outcome *cost, struct status *status);

/* Runs a case at all places (places.h). */
bool accuracy_over_places(accuracy_run_at *run, const struct accuracy_choice *choice, int resolution,
                          struct accuracy_outcome *outcome, struct status *status);

/* Advances, adding to the cost. */
bool accuracy_advance(struct simulation *simulation, int64_t steps, struct accuracy_outcome *outcome,
                      struct status *status);

/* |u - exact| / |exact|, both in the mean square over all cells; exact is [0] ux and [1] uy, row by row. */
bool accuracy_field_error(struct simulation *simulation, double *const exact[2], double *error, struct status *status);

#endif
