#include "case/case_reference.h"
#include "cli/commands.h"
#include "cli/report.h"
#include "cli/session.h"
#include "output/file.h"

#include <stdlib.h>
#include <sys/stat.h>

static int run_scene(const struct scene *scene, const char *directory, bool quiet)
{
  struct status status;
  struct session session = {.scene = scene, .directory = directory, .quiet = quiet};
  bool replaced = false;
  if (!simulation_create(&session.simulation, scene, &status)) return report_error(&status);
  const bool opened = recorder_open(&session.recorder, scene, directory, &replaced, &status);
  if (replaced && !quiet) fprintf(stderr, "delbm: replacing the earlier run in %s\n", directory);
  const int code = opened ? session_run(&session) : report_error(&status);
  recorder_destroy(session.recorder);
  simulation_destroy(session.simulation);
  return code;
}

static bool is_same_file(const char *a, const char *b)
{
  struct stat first, second;
  return stat(a, &first) == 0 && stat(b, &second) == 0 && first.st_dev == second.st_dev &&
         first.st_ino == second.st_ino;
}

/* True if the case.yaml of the run would replace the user's case (a file, or a folder with case.yaml). */
static bool would_overwrite(const char *path, const char *directory)
{
  struct status ignored;
  char *target = file_join(directory, "case.yaml", &ignored);
  bool same = is_same_file(path, directory) || (target && is_same_file(path, target));
  free(target);
  return same;
}

static int run_in_directory(const struct arguments *arguments, const char *directory)
{
  const char *path = *arguments->operands;
  if (would_overwrite(path, directory))
    return usage_error("run", "the run would overwrite its own case, %s: choose another folder by --out", path);
  return run_scene(&arguments->scene, directory, arguments->quiet);
}

static int run_case(struct arguments *arguments)
{
  struct status status;
  if (!arguments->quiet) notes_print(&arguments->notes, "delbm: note: ", stderr);
  char *standard = file_join("out", arguments->scene.name, &status);
  if (!standard) return report_error(&status);
  const int code = run_in_directory(arguments, arguments->out ? arguments->out : standard);
  free(standard);
  return code;
}

static void print_keys(void)
{
  case_print_keys(stdout);
}

const struct command command_run = {
    .name = "run",
    .purpose = "simulate a case",
    .operand_name = "CASE",
    .operand = OPERAND_CASE,
    .about = "Simulates a case: a YAML file, or a folder with case.yaml.",
    .options = {{"out", "DIR",
                 "folder for the results (out/NAME, NAME being the case's folder or file);\n"
                 "files of an earlier run in it are replaced",
                 .kind = OPTION_TEXT, .target = offsetof(struct arguments, out)},
                {"set", "key=value", "replaces a value of the case: --set domain.size=[512,512] --set output.every=200",
                 .kind = OPTION_SETTING},
                {"plan", "DEPTH",
                 "steps in one pass through memory (run.plan.depth); 1 is unblocked, auto the fastest by trial;\n"
                 "it changes nothing but the speed",
                 .kind = OPTION_SETTING, .key = "run.plan.depth"},
                {"quiet", NULL, "no progress on stderr, only warnings and errors", .kind = OPTION_FLAG,
                 .target = offsetof(struct arguments, quiet)},
                {"help", NULL, "this text", .kind = OPTION_HELP},
                {"help-keys", NULL, "every key of a case, with its meaning and allowed values", .kind = OPTION_PRINT,
                 .print = print_keys}},
    .notes = "DIR receives case.yaml (the case as run), particles.csv, series.csv, fields.h5, frames/*.png and "
             "run.json.\n"
             "The last line on stdout has the figures of run.json. An interrupt (Ctrl-C, SIGTERM, SIGHUP) ends the run "
             "after a\n"
             "checkpoint, from which `delbm resume DIR` goes on.",
    .run = run_case,
};
