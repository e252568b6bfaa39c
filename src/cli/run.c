#include "case/case_keys.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "cli/session.h"
#include "output/file.h"

#include <stdlib.h>
#include <sys/stat.h>

struct run_request {
  const char *path;
  const char *directory; /* NULL: out/NAME */
  struct settings settings;
  char plan[64]; /* the setting that --plan stands for */
  bool quiet;
};

enum { OPTION_OUT = OPTION_OWN, OPTION_SET, OPTION_PLAN, OPTION_QUIET, OPTION_HELP_KEYS };

const struct option run_options[] = {{"out", required_argument, NULL, OPTION_OUT},
                                     {"set", required_argument, NULL, OPTION_SET},
                                     {"plan", required_argument, NULL, OPTION_PLAN},
                                     {"quiet", no_argument, NULL, OPTION_QUIET},
                                     {"help", no_argument, NULL, OPTION_HELP},
                                     {"help-keys", no_argument, NULL, OPTION_HELP_KEYS},
                                     {0}};

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
       "  --quiet          no progress on stderr, only warnings and errors\n"
       "  --help           this text\n"
       "  --help-keys      every key of a case, what it means and what it may be\n"
       "\n"
       "DIR receives case.yaml (the case as run), particles.csv, fields.h5, frames/*.png and run.json. The last line\n"
       "on stdout has the figures of run.json. An interrupt (Ctrl-C, SIGTERM, SIGHUP) ends the run after a\n"
       "checkpoint, from which `delbm resume DIR` goes on.");
}

/* How far reading the command line got: run the case, or leave with an exit code. */
enum { GO_ON = -1 };

static int parse_options(int argc, char **argv, struct run_request *options)
{
  int code;
  for (int option; (option = option_next(argc, argv, run_options)) != OPTION_END;) {
    switch (option) {
    case OPTION_OUT:
      options->directory = optarg;
      break;
    case OPTION_SET:
      if ((code = settings_add(&options->settings, optarg, argc, argv)) != DELBM_OK) return code;
      break;
    case OPTION_PLAN:
      snprintf(options->plan, sizeof options->plan, "run.plan.depth=%s", optarg);
      if ((code = settings_add(&options->settings, options->plan, argc, argv)) != DELBM_OK) return code;
      break;
    case OPTION_QUIET:
      options->quiet = true;
      break;
    case OPTION_HELP:
      print_help();
      return DELBM_OK;
    case OPTION_HELP_KEYS:
      case_print_keys(stdout);
      return DELBM_OK;
    default:
      return DELBM_USAGE;
    }
  }
  options->path = option_operand(argc, argv, "CASE");
  return options->path ? GO_ON : DELBM_USAGE;
}

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

/* True if the run would write its case.yaml over the case (a file, or a folder with case.yaml) that the user wrote. */
static bool would_overwrite(const char *path, const char *directory)
{
  struct status ignored;
  char *target = file_join(directory, "case.yaml", &ignored);
  bool same = is_same_file(path, directory) || (target && is_same_file(path, target));
  free(target);
  return same;
}

static int run_in_directory(const struct scene *scene, const struct run_request *options, const char *directory)
{
  if (would_overwrite(options->path, directory))
    return usage_error("run", "the run would overwrite its own case, %s: choose another folder by --out",
                       options->path);
  return run_scene(scene, directory, options->quiet);
}

static int run_case(const struct run_request *options)
{
  struct scene scene = {0};
  struct case_errors notes = {0};
  int code = read_case(&scene, options->path, &options->settings, &notes);
  if (code == DELBM_OK && !options->quiet) notes_print(&notes, "delbm: note: ", stderr);
  case_errors_clear(&notes);
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
  struct run_request options = {0};
  int code = parse_options(argc, argv, &options);
  if (code == GO_ON) code = run_case(&options);
  free(options.settings.items);
  return code;
}
