#include "accuracy.h"

#include "analysis/fit.h"
#include "base/clock.h"
#include "base/memory.h"
#include "bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct accuracy_case *const cases[] = {&accuracy_taylor_green, &accuracy_shear_layer, &accuracy_poiseuille,
                                                    &accuracy_couette,      &accuracy_spin,        &accuracy_drag,
                                                    &accuracy_settling,     &accuracy_crossing,    &accuracy_impact};

enum { CHOICES = OPERATOR_COUNT * FORM_COUNT * 2 };

/* One choice over all resolutions of its case. */
struct series {
  struct accuracy_choice choice;
  char name[64];
  struct accuracy_outcome outcome[RESOLUTIONS];
  bool cheapest[2][RESOLUTIONS]; /* on the Pareto front, by seconds and by updates */
  double order;                  /* of convergence; NAN without a fit */
};

struct study {
  const struct accuracy_case *one;
  int resolutions;
  int count;
  struct series series[CHOICES];
};

void accuracy_apply(const struct accuracy_choice *choice, struct scene *scene)
{
  static const enum collision collisions[] = {COLLISION_BGK, COLLISION_TRT, COLLISION_MRT,
                                              COLLISION_MRT, COLLISION_MRT, COLLISION_ADAPTIVE};
  struct rates *rates = &scene->fluid.rates;
  if (choice->operator!= OPERATOR_ADAPTIVE) scene_use_paper_rates(scene);
  if (choice->operator== OPERATOR_BGK || choice->operator== OPERATOR_TRT) rates->s_e = rates->s_nu;
  if (choice->operator== OPERATOR_BGK) rates->s_q = rates->s_nu;
  if (choice->operator== OPERATOR_ADAPTIVE) scene_use_adaptive(scene);
  if (choice->operator== OPERATOR_TRT || choice->operator== OPERATOR_MAGIC)
    rates->s_q = rate_from_magic(3.0 / 16, scene->fluid.viscosity);
  if (choice->operator== OPERATOR_TWELFTH) rates->s_q = rate_from_magic(1.0 / 12, scene->fluid.viscosity);
  scene->fluid.collision = collisions[choice->operator];
  scene->fluid.precision = choice->precision;
  scene->coupling.form = choice->form;
  scene->contact.area = choice->area;
}

struct scene accuracy_scene(const struct accuracy_choice *choice, int nx, int ny, double viscosity, enum sides sides)
{
  struct scene scene = scene_box(nx, ny, viscosity, sides);
  accuracy_apply(choice, &scene);
  return scene;
}

bool accuracy_advance(struct simulation *simulation, int64_t steps, struct accuracy_outcome *outcome,
                      struct status *status)
{
  const double start = clock_now();
  const bool ok = simulation_advance(simulation, steps, status);
  outcome->seconds += clock_now() - start;
  outcome->updates += (double)steps * (double)scene_cells(simulation_scene(simulation));
  return ok;
}

bool accuracy_over_places(accuracy_run_at *run, const struct accuracy_choice *choice, int resolution,
                          struct accuracy_outcome *outcome, struct status *status)
{
  struct accuracy_outcome cost = {0};
  struct deviations all = {0};
  for (int k = 0; k < PLACES; k++) {
    const struct offset offset = place_offset(k);
    double deviation = NAN;
    const bool ok = run(choice, resolution, &offset, &deviation, &cost, status);
    deviations_add(&all, deviation, offset.weight);
    *outcome = (struct accuracy_outcome){all.error, all.worst, cost.seconds / (k + 1), cost.updates / (k + 1)};
    if (!ok) return false;
  }
  return true;
}

bool accuracy_field_error(struct simulation *simulation, double *const exact[2], double *error, struct status *status)
{
  const size_t cells = (size_t)scene_cells(simulation_scene(simulation));
  double *u = memory_allocate(2 * cells, sizeof *u, "the velocity", status), off = 0, all = 0;
  if (!u) return false;
  simulation_fields(simulation, NULL, u, u + cells);
  for (size_t k = 0; k < 2 * cells; k++) {
    const double expected = exact[k / cells][k % cells];
    off += (u[k] - expected) * (u[k] - expected);
    all += expected * expected;
  }
  *error = sqrt(off / all);
  free(u);
  return true;
}

static void name_choice(const struct accuracy_case *one, const struct accuracy_choice *c, char name[64])
{
  static const char *const operators[] = {"bgk", "trt", "mrt", "mrt + 3/16", "mrt + 1/12", "adaptive"};
  static const char *const forms[] = {"unified, ", "owen, ", "midpoint, "}, *const precisions[] = {"double", "single"};
  if (one->with_areas)
    snprintf(name, 64, "%s", c->area == AREA_LENS ? "lens" : "cells");
  else
    snprintf(name, 64, "%s%s, %s", one->with_forms ? forms[c->form] : "", operators[c->operator],
             precisions[c->precision]);
}

static void add_series(struct study *study, struct accuracy_choice choice)
{
  struct series *series = &study->series[study->count++];
  *series = (struct series){.choice = choice};
  name_choice(study->one, &choice, series->name);
}

/* The program's defaults. */
static const struct accuracy_choice usual = {OPERATOR_ADAPTIVE, FORM_MIDPOINT, PRECISION_DOUBLE, AREA_LENS};

static bool is_usual(const struct accuracy_choice *c)
{
  return c->operator== usual.operator&& c->form == usual.form && c->precision == usual.precision &&
      c->area == usual.area;
}

static void list_choices(struct study *study)
{
  struct accuracy_choice c = usual;
  study->count = 0;
  for (int area = AREA_LENS; study->one->with_areas && area <= AREA_CELLS; area++) {
    c.area = area;
    add_series(study, c);
  }
  if (study->one->with_areas) return;
  for (int form = study->one->with_forms ? FORM_UNIFIED : FORM_MIDPOINT; form < FORM_COUNT; form++)
    for (int operator= 0; operator<OPERATOR_COUNT; operator++)
      for (int precision = PRECISION_DOUBLE; precision <= PRECISION_SINGLE; precision++) {
        c.form = form, c.operator= operator, c.precision = precision;
        add_series(study, c);
      }
}

/* A run that diverged is a result; any other failure ends the benchmark. */
static bool run_series(const struct study *study, void *context, struct series *series, struct status *status)
{
  for (int r = 0; r < study->resolutions; r++) {
    struct accuracy_outcome *outcome = &series->outcome[r];
    const bool ok = study->one->run(context, &series->choice, study->one->resolution[r], outcome, status);
    if (!ok && status->code != DELBM_FAILED) return false;
    if (!ok) outcome->error = NAN;
    if (!ok || study->one->places == 0) outcome->worst = outcome->error;
  }
  return true;
}

static void fit_order(const struct study *study, struct series *series)
{
  double x[RESOLUTIONS], y[RESOLUTIONS];
  size_t count = 0;
  for (int r = 0; r < study->resolutions; r++) {
    if (!(series->outcome[r].error > 0)) continue;
    x[count] = log(study->one->resolution[r]);
    y[count++] = log(series->outcome[r].error);
  }
  series->order = count > 1 ? -fit_line(x, y, count).slope : NAN;
}

static double cost_of(const struct accuracy_outcome *outcome, int by)
{
  return by == 0 ? outcome->seconds : outcome->updates;
}

static bool is_cheapest(const struct study *study, const struct accuracy_outcome *outcome, int by)
{
  if (isnan(outcome->error)) return false;
  for (int s = 0; s < study->count; s++)
    for (int r = 0; r < study->resolutions; r++) {
      const struct accuracy_outcome *other = &study->series[s].outcome[r];
      const double more = cost_of(outcome, by) - cost_of(other, by), worse = outcome->error - other->error;
      if (more >= 0 && worse >= 0 && (more > 0 || worse > 0)) return false;
    }
  return true;
}

static void find_front(struct study *study)
{
  for (int s = 0; s < study->count; s++)
    for (int r = 0; r < study->resolutions; r++)
      for (int by = 0; by < 2; by++)
        study->series[s].cheapest[by][r] = is_cheapest(study, &study->series[s].outcome[r], by);
}

static void print_table(const struct study *study)
{
  const struct accuracy_case *one = study->one;
  printf("\n%s: %s\n", one->name, one->error);
  if (one->places)
    printf("mean of the absolute error over %d places of the centre within a cell, and the worst\n", one->places);
  printf("%-28s", one->axis);
  for (int r = 0; r < study->resolutions; r++) {
    printf(" %10d", one->resolution[r]);
    if (one->places) printf(" %8s", "worst");
  }
  printf(" %7s %9s\n", "order", "seconds");
  for (int s = 0; s < study->count; s++) {
    const struct series *series = &study->series[s];
    printf("%-28s", series->name);
    for (int r = 0; r < study->resolutions; r++) {
      const struct accuracy_outcome *o = &series->outcome[r];
      isnan(o->error) ? printf(" %10s", "diverged") : printf(" %10.3g", o->error);
      if (one->places) isnan(o->worst) ? printf(" %8s", "") : printf(" %8.2g", o->worst);
    }
    isnan(series->order) ? printf(" %7s", "") : printf(" %7.2f", series->order);
    printf(" %9.3g\n", series->outcome[study->resolutions - 1].seconds);
  }
}

/* The Pareto front, from the cheapest run on. */
static void print_front(const struct study *study, int by)
{
  double beyond = -1;
  printf("  best for their %s:", by == 0 ? "time" : "updates");
  for (;;) {
    double next = INFINITY;
    for (int s = 0; s < study->count; s++)
      for (int r = 0; r < study->resolutions; r++) {
        const double cost = cost_of(&study->series[s].outcome[r], by);
        if (study->series[s].cheapest[by][r] && cost > beyond) next = fmin(next, cost);
      }
    if (isinf(next)) break;
    for (int s = 0; s < study->count; s++)
      for (int r = 0; r < study->resolutions; r++)
        if (study->series[s].cheapest[by][r] && cost_of(&study->series[s].outcome[r], by) == next)
          printf("%s %s at %d (%.2g)", beyond < 0 ? "" : ";", study->series[s].name, study->one->resolution[r],
                 study->series[s].outcome[r].error);
    beyond = next;
  }
  printf("\n");
}

/* One run a line: bench/accuracy.gp depends on it. */
static void report_study(const struct study *study, bool first, FILE *json)
{
  for (int s = 0; s < study->count; s++) {
    const struct series *series = &study->series[s];
    for (int r = 0; r < study->resolutions; r++) {
      const struct accuracy_outcome *o = &series->outcome[r];
      char error[32] = "null", worst[32] = "null", order[32] = "null";
      if (!isnan(o->error)) snprintf(error, sizeof error, "%.6g", o->error);
      if (!isnan(o->worst)) snprintf(worst, sizeof worst, "%.6g", o->worst);
      if (!isnan(series->order)) snprintf(order, sizeof order, "%.4g", series->order);
      fprintf(json,
              "%s\n{\"case\": \"%s\", \"choice\": \"%s\", \"resolution\": %d, \"error\": %s, \"seconds\": %.4g, "
              "\"updates\": %.6g, \"order\": %s, \"best_for_time\": %s, \"best_for_updates\": %s, \"worst\": %s, "
              "\"places\": %d}",
              first && s == 0 && r == 0 ? "" : ",", study->one->name, series->name, study->one->resolution[r], error,
              o->seconds, o->updates, order, series->cheapest[0][r] ? "true" : "false",
              series->cheapest[1][r] ? "true" : "false", worst, study->one->places ? study->one->places : 1);
    }
  }
}

static bool verify(const struct study *study, struct status *status)
{
  const struct accuracy_case *one = study->one;
  for (int s = 0; s < study->count; s++) {
    const struct series *series = &study->series[s];
    const double error = series->outcome[0].error;
    if (is_usual(&series->choice) && !(error <= one->bound))
      return status_fail(status, DELBM_FAILED, "bench accuracy: %s, %s, at %d: an error of %g is beyond %g", one->name,
                         series->name, one->resolution[0], error, one->bound);
  }
  return true;
}

static bool run_study(struct study *study, bool first, const struct bench_report *report, struct status *status)
{
  const struct accuracy_case *one = study->one;
  list_choices(study);
  study->resolutions = 0;
  while (study->resolutions < (report->quick ? one->quick : RESOLUTIONS) && one->resolution[study->resolutions])
    study->resolutions++;
  void *context = one->prepare ? one->prepare(report->quick, status) : NULL;
  bool ok = context || !one->prepare;
  for (int s = 0; ok && s < study->count; s++) {
    ok = run_series(study, context, &study->series[s], status);
    fit_order(study, &study->series[s]);
  }
  if (context) one->finish(context);
  if (!ok) return false;
  find_front(study);
  print_table(study);
  print_front(study, 0);
  print_front(study, 1);
  fflush(stdout);
  if (report->json) report_study(study, first, report->json);
  return verify(study, status);
}

bool bench_accuracy(const struct bench_report *report, struct status *status)
{
  bench_describe_machine(report);
  if (report->json) fprintf(report->json, ", \"runs\": [");
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
    struct study study = {.one = cases[k]};
    if (!run_study(&study, k == 0, report, status)) return false;
  }
  if (report->json) fprintf(report->json, "\n]");
  return true;
}
