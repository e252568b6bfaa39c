#include "cli/commands.h"
#include "cli/report.h"
#include "cli/session.h"

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

static int resume(struct arguments *arguments)
{
  struct status status;
  struct resumption resumption;
  const struct scene *scene = &arguments->scene;
  struct session session = {.scene = scene, .directory = *arguments->operands, .quiet = arguments->quiet};
  if (!session.quiet) notes_print(&arguments->notes, "delbm: note: ", stderr);
  if (!simulation_create(&session.simulation, scene, &status)) return report_error(&status);
  int code;
  if (recorder_resume(&session.recorder, scene, session.directory, session.simulation, &resumption, &status)) {
    report_choice(&resumption, &session);
    code = session_run(&session);
  } else {
    code = report_error(&status);
  }
  recorder_destroy(session.recorder);
  simulation_destroy(session.simulation);
  return code;
}

const struct command command_resume = {
    .name = "resume",
    .purpose = "go on with a run from its last checkpoint",
    .operand_name = "DIR",
    .operand = OPERAND_RESULTS,
    .about =
        "Goes on with a run that was interrupted or that failed, from its last checkpoint in DIR, the folder of its "
        "results.\n"
        "Its files become the same, byte for byte, as those of a run that was never stopped (run.json but for "
        "times).",
    .options = {{"steps", "N", "total length of the run, in place of run.steps in DIR/case.yaml: extends a run",
                 .kind = OPTION_SETTING, .key = "run.steps"},
                {"quiet", NULL, "no progress on stderr, only warnings and errors", .kind = OPTION_FLAG,
                 .target = offsetof(struct arguments, quiet)},
                {"help", NULL, "this text", .kind = OPTION_HELP}},
    .notes = "A run checkpoints when it is interrupted (Ctrl-C, SIGTERM, SIGHUP) and every output.checkpoint.every\n"
             "steps. Two checkpoints alternate; one that is damaged or of another case is refused, and the other used.",
    .run = resume,
};
