#include "cli/session.h"

#include "base/clock.h"
#include "cli/report.h"
#include "output/progress.h"

#include <inttypes.h>
#include <math.h>
#include <signal.h>

/* Set by the signal handler, read between chunks of steps. */
static volatile sig_atomic_t stop_requested;

struct session_state {
  const struct scene *scene;
  const char *directory;
  struct simulation *simulation;
  struct recorder *recorder;
  struct progress progress;
  enum outcome outcome; /* other than DONE: reason in status */
  struct status status;
};

/* The first of several signals determines the exit code. */
static void request_stop(int signal_number)
{
  if (!stop_requested) stop_requested = signal_number;
}

/* The first SIGINT or SIGTERM ends the run after a checkpoint, a second one ends the program at once. SIGHUP never
 * ends the program at once, since a closing terminal may send it twice (itself and by its shell); where it is ignored
 * (nohup), it stays ignored. */
static void listen_to_signals(void)
{
  struct sigaction action = {.sa_handler = request_stop, .sa_flags = (int)SA_RESETHAND | SA_RESTART}, before;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, NULL);
  sigaction(SIGTERM, &action, NULL);
  action.sa_flags = SA_RESTART;
  if (sigaction(SIGHUP, NULL, &before) == 0 && before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, NULL);
}

/* 128 + n for signal n, as shells report it. */
static enum delbm_code code_of_signal(int signal_number)
{
  return signal_number == SIGHUP ? DELBM_HUNG_UP : signal_number == SIGTERM ? DELBM_TERMINATED : DELBM_INTERRUPTED;
}

/* Sets the outcome: divergence, or failure of a file or of memory. */
static bool fail(struct session_state *run)
{
  struct status ignored;
  bool diverged =
      run->status.code == DELBM_FAILED && !run->status.out_of_memory && !simulation_check(run->simulation, &ignored);
  run->outcome = diverged ? OUTCOME_DIVERGED : OUTCOME_FAILED;
  return false;
}

static bool record(struct session_state *run, bool last)
{
  return recorder_record(run->recorder, run->simulation, last, &run->status) || fail(run);
}

static bool advance(struct session_state *run, int64_t steps)
{
  if (simulation_advance(run->simulation, steps, &run->status)) return true;
  const bool diverged = run->status.code == DELBM_FAILED && !run->status.out_of_memory;
  run->outcome = diverged ? OUTCOME_DIVERGED : OUTCOME_FAILED;
  return false;
}

/* Writes a checkpoint and no other output of this step: the files are then a prefix of the files of an unbroken run. */
static bool interrupt(struct session_state *run)
{
  if (!recorder_checkpoint(run->recorder, run->simulation, &run->status)) return fail(run);
  run->outcome = OUTCOME_INTERRUPTED;
  return status_fail(&run->status, code_of_signal(stop_requested),
                     "interrupted at step %" PRId64 " of %" PRId64 "; `delbm resume %s` goes on from there",
                     simulation_step(run->simulation), run->scene->run.steps, run->directory);
}

/* Number of steps that take about 0.2 s, the interval of progress bar and signals. Results do not depend on it. */
static int64_t next_chunk(int64_t chunk, int64_t steps, double seconds)
{
  const double wanted = 0.2;
  int64_t max_steps = chunk < INT64_MAX / 8 ? 8 * chunk : chunk;
  double fitting = seconds > 0 ? wanted * (double)steps / seconds : (double)max_steps;
  return fitting < 1 ? 1 : fitting < (double)max_steps ? (int64_t)fitting : max_steps;
}

static bool run_steps(struct session_state *run)
{
  int64_t end = run->scene->run.steps, step = simulation_step(run->simulation), chunk = 1;
  for (;;) {
    if (stop_requested) return interrupt(run);
    if (!record(run, step == end)) return false;
    if (step > 0) progress_update(&run->progress, step);
    if (step == end) return true;
    int64_t steps = recorder_next(run->recorder, step) - step;
    if (steps > chunk) steps = chunk;
    double start = clock_now();
    if (!advance(run, steps)) return false;
    chunk = next_chunk(chunk, steps, clock_now() - start);
    step += steps;
  }
}

/* Records a failure after the last step, unless an earlier one is recorded. */
static void note_failure(struct session_state *run, const struct status *status)
{
  if (run->outcome != OUTCOME_DONE) return;
  run->outcome = OUTCOME_FAILED;
  run->status = *status;
}

/* Reason of the end of the run, for run.json. */
static const char *reason_of(const struct session_state *run)
{
  if (run->outcome == OUTCOME_DONE) return "all of run.steps are done";
  if (run->outcome != OUTCOME_INTERRUPTED) return run->status.message;
  return run->status.code == DELBM_HUNG_UP      ? "interrupted by SIGHUP"
         : run->status.code == DELBM_TERMINATED ? "interrupted by SIGTERM"
                                                : "interrupted by SIGINT";
}

enum { WARNING = 384 };

/* Warnings on the accuracy of the results, joined by "; "; "" if there are none. */
static void warn(const struct scene *scene, const struct simulation_report *report, char warning[WARNING])
{
  const double advised = sqrt(3) * scene_advised_speed, max_overlap = 0.1;
  const bool soft = report->max_overlap > max_overlap && scene->contact.stiffness > 0;
  int length = 0;
  *warning = '\0';
  if (report->max_mach > advised)
    length = snprintf(
        warning, WARNING,
        "fluid moved at up to Mach %.2g, above %.2g (%g cells/step): errors of compressibility grow with its square",
        report->max_mach, advised, scene_advised_speed);
  if (soft)
    snprintf(warning + length, WARNING - (size_t)length,
             "%sdiscs overlapped by up to %.2g %% of the smaller radius, more than %g %%; better: a larger "
             "contact.stiffness, or auto",
             length > 0 ? "; " : "", 100 * report->max_overlap, 100 * max_overlap);
}

/* Closes the files and reports the outcome in run.json, on stdout and on stderr. */
static void conclude(struct session_state *run)
{
  struct status status;
  struct summary summary = {
      .scene = run->scene, .steps = simulation_step(run->simulation), .seconds = recorder_elapsed(run->recorder)};
  progress_finish(&run->progress, summary.steps);
  if (!recorder_finish(run->recorder, &status)) note_failure(run, &status);
  simulation_report(run->simulation, &summary.report);
  summary.report.times.seconds[STAGE_OUTPUT] = recorder_seconds(run->recorder);
  summary.outcome = run->outcome;
  summary.message = run->outcome == OUTCOME_DONE ? NULL : run->status.message;
  summary.reason = reason_of(run);
  char warning[WARNING];
  warn(run->scene, &summary.report, warning);
  summary.warning = *warning ? warning : NULL;
  if (!recorder_summarise(run->recorder, &summary, &status)) note_failure(run, &status);
  summary.outcome = run->outcome;
  summary_print(&summary, stdout);
  if (*warning && run->outcome != OUTCOME_DIVERGED) fprintf(stderr, "delbm: warning: %s\n", warning);
  if (run->outcome != OUTCOME_DONE) report_error(&run->status);
}

/* Prints number and binding of threads. */
static void announce(const struct scene *scene)
{
  char binding[THREADS_TEXT];
  threads_binding(binding);
  fprintf(stderr, "delbm: %d threads, %s\n", stages_threads(scene), binding);
}

int session_run(const struct session *session)
{
  struct session_state run = {.scene = session->scene,
                              .directory = session->directory,
                              .simulation = session->simulation,
                              .recorder = session->recorder};
  const enum progress_style style = session->quiet ? PROGRESS_NONE : progress_style(stderr);
  if (!session->quiet) announce(session->scene);
  listen_to_signals();
  progress_start(&run.progress, style, stderr, simulation_step(run.simulation), run.scene->run.steps,
                 run.scene->fluid.none ? 0 : (double)scene_cells(run.scene));
  run_steps(&run);
  conclude(&run);
  return run.outcome == OUTCOME_DONE ? DELBM_OK : (int)run.status.code;
}
