#include "cli/commands.h"
#include "cli/options.h"
#include "cli/session.h"
#include "output/file.h"

#include <stdlib.h>
#include <unistd.h>

struct resume_request {
  const char *directory;
  struct settings settings;
  char steps[64]; /* the setting that --steps stands for */
  bool quiet;
};

enum { OPTION_STEPS = OPTION_OWN, OPTION_QUIET };

const struct option resume_options[] = {{"steps", required_argument, NULL, OPTION_STEPS},
                                        {"quiet", no_argument, NULL, OPTION_QUIET},
                                        {"help", no_argument, NULL, OPTION_HELP},
                                        {0}};

static void print_help(void)
{
  puts("usage: delbm resume DIR [--steps N] [--quiet]\n"
       "\n"
       "Goes on with a run that was interrupted or that failed, from its last checkpoint in DIR, the folder of its "
       "results.\n"
       "Its files become the same, byte for byte, as those of a run that was never stopped (run.json but for times).\n"
       "\n"
       "  --steps N        total length of the run, in place of run.steps in DIR/case.yaml: extends a run\n"
       "  --quiet          no progress on stderr, only warnings and errors\n"
       "  --help           this text\n"
       "\n"
       "A run checkpoints when it is interrupted (Ctrl-C, SIGTERM, SIGHUP) and every output.checkpoint.every\n"
       "steps. Two checkpoints alternate; one that is damaged or of another case is refused, and the other used.");
}

static void report_choice(const struct resumption *resumption, const struct session *session)
{
  if (resumption->refused.code != DELBM_OK)
    fprintf(stderr, "delbm: refused checkpoint %s; using the other one\n", resumption->refused.message);
  if (resumption->other_kernel)
    fprintf(stderr, "delbm: note: going on with kernel %s, another than before; results may differ in the last bit\n",
            simulation_kernel(session->simulation));
  if (!session->quiet)
    fprintf(stderr, "delbm: resuming %s at step %lld\n", session->directory,
            (long long)simulation_step(session->simulation));
}

static int resume_scene(const struct scene *scene, const struct resume_request *options)
{
  struct status status;
  struct resumption resumption;
  struct session session = {.scene = scene, .directory = options->directory, .quiet = options->quiet};
  if (!simulation_create(&session.simulation, scene, &status)) return report_error(&status);
  int code;
  if (recorder_resume(&session.recorder, scene, options->directory, session.simulation, &resumption, &status)) {
    report_choice(&resumption, &session);
    code = session_run(&session);
  } else {
    code = report_error(&status);
  }
  recorder_destroy(session.recorder);
  simulation_destroy(session.simulation);
  return code;
}

static int resume_directory(const struct resume_request *options)
{
  struct scene scene = {0};
  struct case_errors notes = {0};
  struct status status;
  char *path = file_join(options->directory, "case.yaml", &status);
  if (!path) return report_error(&status);
  int code = read_case(&scene, path, &options->settings, &notes);
  if (code == DELBM_OK && !options->quiet) notes_print(&notes, "delbm: note: ", stderr);
  case_errors_clear(&notes);
  if (code == DELBM_OK) code = resume_scene(&scene, options);
  scene_clear(&scene);
  free(path);
  return code;
}

int command_resume(int argc, char **argv)
{
  struct resume_request options = {0};
  for (int option; (option = option_next(argc, argv, resume_options)) != OPTION_END;) {
    if (option == OPTION_QUIET) {
      options.quiet = true;
      continue;
    }
    int code = option == OPTION_HELP ? DELBM_OK : DELBM_USAGE;
    if (option == OPTION_HELP) print_help();
    if (option == OPTION_STEPS) {
      snprintf(options.steps, sizeof options.steps, "run.steps=%s", optarg);
      code = settings_add(&options.settings, options.steps, argc, argv);
      if (code == DELBM_OK) continue;
    }
    free(options.settings.items);
    return code;
  }
  options.directory = option_operand(argc, argv, "DIR");
  const int code = options.directory ? resume_directory(&options) : DELBM_USAGE;
  free(options.settings.items);
  return code;
}
