/* The drag of square arrays over solid fraction and viscosity, for every form of the coupling and choice of rates. */
#include "base/memory.h"
#include "bench.h"
#include "square_array.h"
#include "steady.h"

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
  const double viscosity = scene->fluid.viscosity;
  const int64_t interval = (int64_t)fmax(250, (double)cells / (100 * viscosity));
  struct steady steady = {.enough = scene->fluid.precision == PRECISION_DOUBLE ? 1e-6 : 1e-5};
  struct simulation *simulation = NULL;
  double *ux = memory_allocate(cells, sizeof *ux, "the velocity", status);
  bool ok = ux && simulation_create(&simulation, scene, status), known = false;
  while (ok && !known) {
    ok = accuracy_advance(simulation, interval, cost, status);
    if (!ok) break;
    simulation_fields(simulation, NULL, ux, NULL);
    known = steady_add(&steady, mean(ux, cells));
  }
  if (ok) *drag = scene->fluid.force[0] * (double)cells / (viscosity * steady.limit);
  simulation_destroy(simulation);
  free(ux);
  return ok;
}

bool square_array_error(const struct square_array *array, const struct accuracy_choice *choice, double radius,
                        double viscosity, const struct offset *offset, double *error, struct accuracy_outcome *cost,
                        struct status *status)
{
  /* so small that neither inertia nor the slope of density counts */
  const double force = viscosity * fmin(1e-6, 2e-5 * viscosity);
  struct scene scene = scene_square_array(radius, array->fraction, viscosity, force);
  double *position = scene.particles.discs[0].position, drag = NAN;
  accuracy_apply(choice, &scene);
  position[0] = floor(position[0]) + offset->x;
  position[1] = floor(position[1]) + offset->y;
  const bool ok = square_array_drag(&scene, &drag, cost, status);
  *error = drag / array->drag - 1;
  scene_clear(&scene);
  return ok;
}

/* Errors over all places, in per cent; NAN if a run diverged. */
static bool drag_errors(const struct choice *choice, const struct square_array *array, double viscosity,
                        struct deviations *all, struct status *status)
{
  *all = (struct deviations){0};
  for (int k = 0; k < PLACES; k++) {
    const struct offset offset = place_offset(k);
    struct accuracy_outcome cost = {0};
    double error;
    if (!square_array_error(array, &choice->choice, RADIUS, viscosity, &offset, &error, &cost, status) &&
        status->code != DELBM_FAILED)
      return false;
    deviations_add(all, 100 * error, offset.weight);
  }
  return true;
}

/* A list of numbers, null for NAN. */
static void write_list(FILE *json, const char *name, const double *values, int count)
{
  fprintf(json, ", \"%s\": [", name);
  for (int k = 0; k < count; k++)
    isfinite(values[k]) ? fprintf(json, "%s%.5g", k ? ", " : "", values[k]) : fprintf(json, "%snull", k ? ", " : "");
  fprintf(json, "]");
}

/* midpoint with two rates: the drag is independent of viscosity. The program's defaults: near the exact drag unless
 * discs are close to each other. */
static bool verify(const struct choice *choice, const struct square_array *array, const double *percent_off,
                   struct status *status)
{
  const bool usual = choice->choice.form == FORM_MIDPOINT && choice->choice.operator== OPERATOR_ADAPTIVE;
  const bool same = choice->choice.form == FORM_MIDPOINT && choice->choice.operator== OPERATOR_TRT;
  for (int v = 0; v < VISCOSITIES; v++) {
    if (same && !(fabs(percent_off[v] - percent_off[0]) < 0.002))
      return status_fail(status, DELBM_FAILED,
                         "bench drag: %s, solid fraction %g: %g and %g %% off at viscosities %g and %g", choice->name,
                         array->fraction, percent_off[0], percent_off[v], viscosities[0], viscosities[v]);
    if (usual && array->fraction < 0.35 && !(fabs(percent_off[v]) < 3))
      return status_fail(status, DELBM_FAILED, "bench drag: %s, solid fraction %g: %g %% off at viscosity %g",
                         choice->name, array->fraction, percent_off[v], viscosities[v]);
  }
  return true;
}

static bool report_row(const struct choice *choice, const struct square_array *array, bool first,
                       const struct bench_report *report, struct status *status)
{
  double means[VISCOSITIES], worst[VISCOSITIES];
  printf("%-22s %6.2f", choice->name, array->fraction);
  for (int v = 0; v < VISCOSITIES; v++) {
    struct deviations all;
    if (!drag_errors(choice, array, viscosities[v], &all, status)) return false;
    means[v] = all.mean;
    worst[v] = all.worst;
    isnan(all.mean) ? printf(" %9s %6s", "diverged", "") : printf(" %+9.2f %6.2f", all.mean, all.worst);
  }
  printf("\n");
  fflush(stdout);
  if (!verify(choice, array, means, status)) return false;
  if (!report->json) return true;
  fprintf(report->json, "%s\n{\"choice\": \"%s\", \"fraction\": %g", first ? "" : ",", choice->name, array->fraction);
  write_list(report->json, "percent_off", means, VISCOSITIES);
  write_list(report->json, "worst_percent_off", worst, VISCOSITIES);
  fprintf(report->json, "}");
  return true;
}

bool bench_drag(const struct bench_report *report, struct status *status)
{
  const int first = report->quick ? 2 : 0, end = report->quick ? 3 : SQUARE_ARRAYS;
  printf("drag K = F/(mu U) of a square array, R = %d: per cent off the exact one, for each viscosity; mean over %d\n"
         "places of the centre within a cell, and the largest\n",
         RADIUS, PLACES);
  printf("%-22s %6s", "form and rates", "solid");
  for (int v = 0; v < VISCOSITIES; v++) printf(" %9.4g %6s", viscosities[v], "worst");
  printf("\n");
  if (report->json) fprintf(report->json, "\"rows\": [");
  for (size_t c = 0; c < sizeof choices / sizeof choices[0]; c++)
    for (int a = first; a < end; a++)
      if (!report_row(&choices[c], &square_arrays[a], c == 0 && a == first, report, status)) return false;
  if (report->json) fprintf(report->json, "]");
  return true;
}

/* The largest error of three viscosities. */
static bool drag_at(const struct accuracy_choice *choice, int radius, const struct offset *offset, double *deviation,
                    struct accuracy_outcome *cost, struct status *status)
{
  static const double worst_of[] = {0.005, 0.05, 1.0 / 6};
  *deviation = 0;
  for (int v = 0; v < 3; v++) {
    double error;
    if (!square_array_error(&square_arrays[2], choice, radius, worst_of[v], offset, &error, cost, status)) return false;
    if (fabs(error) > fabs(*deviation)) *deviation = error;
  }
  return true;
}

static bool run_drag(void *context, const struct accuracy_choice *choice, int radius, struct accuracy_outcome *outcome,
                     struct status *status)
{
  (void)context;
  return accuracy_over_places(drag_at, choice, radius, outcome, status);
}

const struct accuracy_case accuracy_drag = {
    .name = "drag",
    .error = "drag of a square array, solid fraction 0.2, worst of viscosities 0.005, 0.05 and 1/6, relative",
    .axis = "cells in R",
    .resolution = {3, 5, 10},
    .quick = 1,
    .bound = 0.03,
    .places = PLACES,
    .with_forms = true,
    .run = run_drag};
