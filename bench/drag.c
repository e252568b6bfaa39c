/* The drag of square arrays over solid fraction and viscosity, for every form of the coupling and choice of rates. */
#include "base/memory.h"
#include "bench.h"
#include "square_array.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct choice {
  const char *name;
  struct accuracy_choice choice;
} choices[] = {{"unified, mrt", {OPERATOR_MRT, FORM_UNIFIED, PRECISION_DOUBLE, AREA_LENS}},
               {"unified, mrt + 3/16", {OPERATOR_MAGIC, FORM_UNIFIED, PRECISION_DOUBLE, AREA_LENS}},
               {"owen, mrt", {OPERATOR_MRT, FORM_OWEN, PRECISION_DOUBLE, AREA_LENS}},
               {"owen, trt", {OPERATOR_TRT, FORM_OWEN, PRECISION_DOUBLE, AREA_LENS}},
               {"owen, mrt + 3/16", {OPERATOR_MAGIC, FORM_OWEN, PRECISION_DOUBLE, AREA_LENS}},
               {"owen, mrt + 1/12", {OPERATOR_TWELFTH, FORM_OWEN, PRECISION_DOUBLE, AREA_LENS}},
               {"midpoint, mrt", {OPERATOR_MRT, FORM_MIDPOINT, PRECISION_DOUBLE, AREA_LENS}},
               {"midpoint, trt", {OPERATOR_TRT, FORM_MIDPOINT, PRECISION_DOUBLE, AREA_LENS}},
               {"midpoint, adaptive", {OPERATOR_ADAPTIVE, FORM_MIDPOINT, PRECISION_DOUBLE, AREA_LENS}}};

static const double viscosities[] = {0.005, 0.02, 0.05, 1.0 / 6};
enum { VISCOSITIES = sizeof viscosities / sizeof viscosities[0], RADIUS = 5 };

static double mean(const double *values, size_t count)
{
  double sum = 0;
  for (size_t k = 0; k < count; k++) sum += values[k];
  return sum / (double)count;
}

bool square_array_drag(const struct scene *scene, double *drag, struct accuracy_outcome *cost, struct status *status)
{
  const size_t cells = (size_t)scene_cells(scene);
  const double enough = scene->fluid.precision == PRECISION_DOUBLE ? 1e-7 : 1e-5; /* change over `look` steps */
  const int64_t look = (int64_t)cells / 4 + 200;
  struct simulation *simulation = NULL;
  double *ux = memory_allocate(cells, sizeof *ux, "the velocity", status), before = 0;
  bool ok = ux && simulation_create(&simulation, scene, status);
  *drag = 1;
  while (ok && fabs(*drag - before) > enough * fabs(*drag)) {
    before = *drag;
    ok = accuracy_advance(simulation, look, cost, status);
    if (!ok) break;
    simulation_fields(simulation, NULL, ux, NULL);
    *drag = scene->fluid.force[0] * (double)cells / (scene->fluid.viscosity * mean(ux, cells));
  }
  simulation_destroy(simulation);
  free(ux);
  return ok;
}

/* Per cent off; NAN where it diverged. */
static bool drag_error(const struct choice *choice, const struct square_array *array, double viscosity, double *error,
                       struct status *status)
{
  struct scene scene = scene_square_array(RADIUS, array->fraction, viscosity, 1e-6 * viscosity);
  struct accuracy_outcome cost = {0};
  double drag;
  accuracy_apply(&choice->choice, &scene);
  bool ok = square_array_drag(&scene, &drag, &cost, status);
  *error = ok ? 100 * (drag / array->drag - 1) : NAN;
  scene_clear(&scene);
  return ok || status->code == DELBM_FAILED;
}

static bool report_row(const struct choice *choice, const struct square_array *array, bool first,
                       const struct bench_report *report, struct status *status)
{
  printf("%-22s %6.2f", choice->name, array->fraction);
  if (report->json)
    fprintf(report->json, "%s\n{\"choice\": \"%s\", \"fraction\": %g, \"percent_off\": [", first ? "" : ",",
            choice->name, array->fraction);
  for (int v = 0; v < VISCOSITIES; v++) {
    double error;
    if (!drag_error(choice, array, viscosities[v], &error, status)) return false;
    isnan(error) ? printf(" %9s", "diverged") : printf(" %+9.2f", error);
    if (report->json)
      isnan(error) ? fprintf(report->json, "%snull", v ? ", " : "")
                   : fprintf(report->json, "%s%.5g", v ? ", " : "", error);
  }
  printf("\n");
  fflush(stdout);
  if (report->json) fprintf(report->json, "]}");
  return true;
}

bool bench_drag(const struct bench_report *report, struct status *status)
{
  const int first = report->quick ? 2 : 0, end = report->quick ? 3 : SQUARE_ARRAYS;
  printf("drag K = F/(mu U) of a square array, R = %d: per cent off the exact one, for each viscosity\n", RADIUS);
  printf("%-22s %6s", "form and rates", "solid");
  for (int v = 0; v < VISCOSITIES; v++) printf(" %9.4g", viscosities[v]);
  printf("\n");
  if (report->json) fprintf(report->json, "\"rows\": [");
  for (size_t c = 0; c < sizeof choices / sizeof choices[0]; c++)
    for (int a = first; a < end; a++)
      if (!report_row(&choices[c], &square_arrays[a], c == 0 && a == first, report, status)) return false;
  if (report->json) fprintf(report->json, "]");
  return true;
}

/* The worst of three viscosities. */
static bool run_drag(void *context, const struct accuracy_choice *choice, int radius, struct accuracy_outcome *outcome,
                     struct status *status)
{
  static const double worst_of[] = {0.005, 0.05, 1.0 / 6};
  const struct square_array *array = &square_arrays[2];
  bool ok = true;
  (void)context;
  for (int v = 0; ok && v < 3; v++) {
    struct scene scene = scene_square_array(radius, array->fraction, worst_of[v], 1e-6 * worst_of[v]);
    double drag = NAN;
    accuracy_apply(choice, &scene);
    ok = square_array_drag(&scene, &drag, outcome, status);
    outcome->error = fmax(outcome->error, fabs(drag / array->drag - 1));
    scene_clear(&scene);
  }
  return ok;
}

const struct accuracy_case accuracy_drag = {
    .name = "drag",
    .error = "drag of a square array, solid fraction 0.2, worst of viscosities 0.005, 0.05 and 1/6, relative",
    .axis = "cells in R",
    .resolution = {3, 5, 10},
    .quick = 2,
    .with_forms = true,
    .run = run_drag};
