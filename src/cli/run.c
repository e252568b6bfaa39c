#include "cli/commands.h"
#include "cli/options.h"
#include "output/file.h"
#include "output/progress.h"
#include "output/recorder.h"
#include "scene/scene_keys.h"
#include "sim/simulation.h"

#include <inttypes.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Set by SIGINT and SIGTERM, read between chunks of steps. A signal handler has no other way to speak. */
static volatile sig_atomic_t stop_requested;

struct run_options {
  const char *path;
  const char *directory; /* NULL: out/NAME */
  struct settings settings;
  char plan[64]; /* the setting that --plan stands for */
  bool quiet;
};

struct run {
  const struct scene *scene;
  struct simulation *simulation;
  struct recorder *recorder;
  struct progress progress;
  double start;         /* clock at step 0 */
  enum outcome outcome; /* with the reason in *status when it is not DONE */
  struct status *status;
};

static void request_stop(int signal_number)
{
  (void)signal_number;
  stop_requested = 1;
}

/* The first signal asks the run to end in order, the second ends the program. */
static void listen_to_signals(void)
{
  struct sigaction action = {.sa_handler = request_stop, .sa_flags = (int)SA_RESETHAND | SA_RESTART};
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, NULL);
  sigaction(SIGTERM, &action, NULL);
}

static void print_help(void)
{
  puts("usage: delbm run CASE [--out DIR] [--set key=value]... [--plan DEPTH] [--quiet]\n"
       "\n"
       "Simulates a case: a YAML file, or a folder that holds case.yaml.\n"
       "\n"
       "  --out DIR        folder for the results (out/NAME, NAME being the case's folder or file);\n"
       "                   files of an earlier run in it are replaced\n"
       "  --set key=value  replaces a value of the case: --set domain.size=[512,512] --set output.every=200\n"
       "  --plan DEPTH     steps in one pass through memory (run.plan.depth); 1 is unblocked, auto the fastest by "
       "trial;\n"
       "                   it changes nothing but the speed\n"
       "  --quiet          no progress on stderr, only errors\n"
       "  --help           this text\n"
       "  --help-keys      every key of a case, what it means and what it may be\n"
       "\n"
       "DIR receives case.yaml (the case as run), particles.csv, frames/*.png and run.json. The last line on stdout\n"
       "has the figures of run.json. An interrupt (Ctrl-C, SIGTERM) ends the run in order at its present step.");
}

/* How far reading the command line got: run the case, or leave with an exit code. */
enum { GO_ON = -1 };

static int parse_options(int argc, char **argv, struct run_options *options)
{
  enum { OPTION_OUT = OPTION_OWN, OPTION_SET, OPTION_PLAN, OPTION_QUIET, OPTION_HELP_KEYS };
  static const struct option known[] = {{"out", required_argument, NULL, OPTION_OUT},
                                        {"set", required_argument, NULL, OPTION_SET},
                                        {"plan", required_argument, NULL, OPTION_PLAN},
                                        {"quiet", no_argument, NULL, OPTION_QUIET},
                                        {"help", no_argument, NULL, OPTION_HELP},
                                        {"help-keys", no_argument, NULL, OPTION_HELP_KEYS},
                                        {0}};
  for (int option; (option = option_next(argc, argv, known)) != OPTION_END;) {
    switch (option) {
    case OPTION_OUT:
      options->directory = optarg;
      break;
    case OPTION_SET:
      if (!settings_add(&options->settings, optarg, argc, argv)) return DELBM_USAGE;
      break;
    case OPTION_PLAN:
      snprintf(options->plan, sizeof options->plan, "run.plan.depth=%s", optarg);
      if (!settings_add(&options->settings, options->plan, argc, argv)) return DELBM_USAGE;
      break;
    case OPTION_QUIET:
      options->quiet = true;
      break;
    case OPTION_HELP:
      print_help();
      return DELBM_OK;
    case OPTION_HELP_KEYS:
      scene_print_keys(stdout);
      return DELBM_OK;
    default:
      return DELBM_USAGE;
    }
  }
  options->path = option_operand(argc, argv, "CASE");
  return options->path ? GO_ON : DELBM_USAGE;
}

/* Records what is due; tells a diverged simulation from a full disk or memory. */
static bool record(struct run *run, bool last)
{
  if (recorder_record(run->recorder, run->simulation, last, run->status)) return true;
  struct status ignored;
  bool diverged = run->status->code == DELBM_FAILED && !simulation_check(run->simulation, &ignored);
  run->outcome = diverged ? OUTCOME_DIVERGED : OUTCOME_FAILED;
  return false;
}

static bool advance(struct run *run, int64_t steps)
{
  if (simulation_advance(run->simulation, steps, run->status)) return true;
  run->outcome = run->status->code == DELBM_FAILED ? OUTCOME_DIVERGED : OUTCOME_FAILED;
  return false;
}

static bool interrupt(struct run *run)
{
  if (!record(run, true)) return false;
  run->outcome = OUTCOME_INTERRUPTED;
  return status_fail(run->status, DELBM_INTERRUPTED, "interrupted at step %" PRId64 " of %" PRId64,
                     simulation_step(run->simulation), run->scene->run.steps);
}

/* Steps that take about as long as a person will wait for the bar or for an interrupt; results do not depend on it. */
static int64_t next_chunk(int64_t chunk, int64_t steps, double seconds)
{
  const double wanted = 0.2;
  int64_t most = chunk < INT64_MAX / 8 ? 8 * chunk : chunk;
  double fitting = seconds > 0 ? wanted * (double)steps / seconds : (double)most;
  return fitting < 1 ? 1 : fitting < (double)most ? (int64_t)fitting : most;
}

static bool run_steps(struct run *run)
{
  int64_t end = run->scene->run.steps, chunk = 1;
  if (!record(run, end == 0)) return false;
  for (int64_t step = 0; step < end;) {
    if (stop_requested) return interrupt(run);
    int64_t steps = recorder_next(run->recorder, step) - step;
    if (steps > chunk) steps = chunk;
    double start = clock_now();
    if (!advance(run, steps)) return false;
    chunk = next_chunk(chunk, steps, clock_now() - start);
    step += steps;
    if (!record(run, step == end)) return false;
    progress_update(&run->progress, step);
  }
  return true;
}

/* An error after the steps: it decides the outcome unless an earlier one did. */
static void note_failure(struct run *run, const struct status *status)
{
  if (run->outcome != OUTCOME_DONE) return;
  run->outcome = OUTCOME_FAILED;
  *run->status = *status;
}

/* Closes the files and tells how the run ended: in run.json, on stdout and on stderr. */
static void conclude(struct run *run)
{
  struct status status;
  struct summary summary = {
      .scene = run->scene, .steps = simulation_step(run->simulation), .seconds = clock_now() - run->start};
  progress_finish(&run->progress, summary.steps);
  if (!recorder_finish(run->recorder, &status)) note_failure(run, &status);
  simulation_report(run->simulation, &summary.report);
  summary.report.times.seconds[STAGE_OUTPUT] = recorder_seconds(run->recorder);
  summary.outcome = run->outcome;
  summary.message = run->outcome == OUTCOME_DONE ? NULL : run->status->message;
  if (!recorder_summarise(run->recorder, &summary, &status)) note_failure(run, &status);
  summary.outcome = run->outcome;
  summary_print(&summary, stdout);
  if (run->outcome != OUTCOME_DONE) report_error(run->status);
}

/* What the run's speed depends on. */
static void announce(const struct scene *scene)
{
  char binding[THREADS_TEXT];
  threads_binding(binding);
  fprintf(stderr, "delbm: %d threads, %s\n", threads_for(scene_cells(scene)), binding);
}

static void simulate(struct run *run, bool quiet)
{
  const int *size = run->scene->domain.size;
  enum progress_style style = quiet ? PROGRESS_NONE : progress_style(stderr);
  if (!quiet) announce(run->scene);
  listen_to_signals();
  run->start = clock_now();
  progress_start(&run->progress, style, stderr, run->scene->run.steps, (double)size[0] * size[1]);
  run_steps(run);
  conclude(run);
}

static bool run_scene(const struct scene *scene, const char *directory, bool quiet, struct status *status)
{
  struct run run = {.scene = scene, .status = status};
  bool replaced = false;
  if (!simulation_create(&run.simulation, scene, status)) {
    report_error(status);
    return false;
  }
  bool opened = recorder_open(&run.recorder, scene, directory, &replaced, status);
  if (replaced && !quiet) fprintf(stderr, "delbm: replacing the earlier run in %s\n", directory);
  if (opened)
    simulate(&run, quiet);
  else
    report_error(status);
  recorder_destroy(run.recorder);
  simulation_destroy(run.simulation);
  return opened && run.outcome == OUTCOME_DONE;
}

static bool is_same_file(const char *a, const char *b)
{
  struct stat first, second;
  return stat(a, &first) == 0 && stat(b, &second) == 0 && first.st_dev == second.st_dev &&
         first.st_ino == second.st_ino;
}

/* True if the run would write its case.yaml over the case (a file, or a folder with case.yaml) that the user wrote. */
static bool would_overwrite(const char *path, const char *directory)
{
  struct status ignored;
  char *target = file_join(directory, "case.yaml", &ignored);
  bool same = is_same_file(path, directory) || (target && is_same_file(path, target));
  free(target);
  return same;
}

static int run_in_directory(const struct scene *scene, const struct run_options *options, const char *directory)
{
  if (would_overwrite(options->path, directory))
    return usage_error("run", "the run would overwrite its own case, %s: choose another folder by --out",
                       options->path);
  struct status status;
  return run_scene(scene, directory, options->quiet, &status) ? DELBM_OK : (int)status.code;
}

static int run_case(const struct run_options *options)
{
  struct scene scene = {0};
  int code = case_read(&scene, options->path, &options->settings);
  if (code != DELBM_OK) return code;
  struct status status;
  char *standard = file_join("out", scene.name, &status);
  if (standard)
    code = run_in_directory(&scene, options, options->directory ? options->directory : standard);
  else
    code = report_error(&status);
  free(standard);
  scene_clear(&scene);
  return code;
}

int command_run(int argc, char **argv)
{
  struct run_options options = {0};
  int code = parse_options(argc, argv, &options);
  if (code == GO_ON) code = run_case(&options);
  free(options.settings.items);
  return code;
}
