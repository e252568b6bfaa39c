#include "edge.h"

#include "output/file.h"
#include "output/recorder.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const files[] = {"case.yaml", "particles.csv", "run.json"};
enum { FILES = sizeof files / sizeof files[0] };

const struct edge_operator edge_operators[EDGE_OPERATORS] = {
    {.name = "bgk"},
    {.name = "trt 3/16", .magic = 3.0 / 16},
    {.name = "mrt 1.4 1.2", .e = 1.4, .q = 1.2},
    {.name = "mrt s_nu 1.2", .q = 1.2},
    {.name = "mrt 1.4 magic 3/16", .e = 1.4, .magic = 3.0 / 16},
    {.name = "adaptive", .e = 1.4, .magic = 1.0 / 12, .fast = 1.2}};

struct rates edge_rates(const struct edge_operator *choice, double viscosity)
{
  const double nu = rate_from_viscosity(viscosity), given = choice->q > 0 ? choice->q : nu;
  const double q = choice->magic > 0 ? rate_from_magic(choice->magic, viscosity) : given;
  return (struct rates){
      .s_nu = nu, .s_e = choice->e > 0 ? choice->e : nu, .s_q = q, .s_q_fast = q < choice->fast ? choice->fast : 0};
}

bool edge_open(struct edge *edge, const struct bench_report *report, struct status *status)
{
  *edge = (struct edge){.report = report, .folder = "/tmp/delbm-edge-XXXXXX"};
  return mkdtemp(edge->folder) || file_fail(status, "make folder", edge->folder, errno);
}

void edge_close(struct edge *edge)
{
  char path[128];
  for (int k = 0; k < FILES; k++) {
    snprintf(path, sizeof path, "%s/%s", edge->folder, files[k]);
    unlink(path);
  }
  rmdir(edge->folder);
}

static bool is_number(const char *word)
{
  return !strcasestr(word, "nan") && !strcasestr(word, "inf");
}

/* Fails if a table or the summary contains "nan" or "inf" outside of messages. */
static bool check_files(const struct edge *edge, struct status *status)
{
  for (int k = 1; k < FILES; k++) {
    char path[128], line[1024];
    snprintf(path, sizeof path, "%s/%s", edge->folder, files[k]);
    FILE *file = fopen(path, "r");
    if (!file) return file_fail(status, "open", path, errno);
    bool good = true;
    while (good && fgets(line, sizeof line, file)) good = strstr(line, "\"message\"") || is_number(line);
    fclose(file);
    if (!good) return status_fail(status, DELBM_FAILED, "%s holds what is not a number: %s", files[k], line);
  }
  return true;
}

static bool advance(struct recorder *recorder, struct simulation *simulation, struct edge_run *run,
                    struct status *status)
{
  for (;;) {
    run->end = simulation_step(simulation);
    const bool on = run->watch(simulation, run->context) && run->end < run->steps;
    if (!recorder_record(recorder, simulation, !on, status)) return false;
    if (!on) return true;
    const int64_t left = run->steps - run->end;
    if (!simulation_advance(simulation, left < run->every ? left : run->every, status)) return false;
  }
}

static bool conclude(struct recorder *recorder, struct simulation *simulation, struct edge_run *run,
                     const struct scene *scene, const struct status *failure, struct status *status)
{
  run->end = simulation_step(simulation);
  simulation_report(simulation, &run->last);
  const struct summary summary = {.outcome = run->diverged ? OUTCOME_DIVERGED : OUTCOME_DONE,
                                  .message = run->diverged ? failure->message : NULL,
                                  .scene = scene,
                                  .steps = run->end,
                                  .seconds = recorder_elapsed(recorder),
                                  .report = run->last};
  return recorder_finish(recorder, status) && recorder_summarise(recorder, &summary, status);
}

static bool run_recorded(struct edge *edge, const struct scene *scene, struct simulation *simulation,
                         struct edge_run *run, struct status *status)
{
  struct recorder *recorder;
  struct status failure;
  bool replaced;
  if (!recorder_open(&recorder, scene, edge->folder, &replaced, status)) return false;
  run->diverged = !advance(recorder, simulation, run, &failure);
  bool ok = !run->diverged || failure.code == DELBM_FAILED;
  if (!ok) *status = failure;
  ok = ok && conclude(recorder, simulation, run, scene, &failure, status);
  recorder_destroy(recorder);
  return ok && check_files(edge, status);
}

bool edge_run(struct edge *edge, struct scene *scene, struct edge_run *run, struct status *status)
{
  struct simulation *simulation;
  scene->run.steps = run->steps;
  scene->output.every = run->every;
  if (!simulation_create(&simulation, scene, status)) return false;
  const bool ok = run_recorded(edge, scene, simulation, run, status);
  simulation_destroy(simulation);
  edge->runs++;
  edge->diverged += run->diverged;
  return ok;
}
