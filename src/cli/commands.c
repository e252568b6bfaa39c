#include "cli/commands.h"

static const struct command *const commands[] = {&command_run,  &command_resume, &command_info,      &command_analyse,
                                                 &command_plot, &command_bench,  &command_completion};

const struct command *command_at(size_t k)
{
  return k < sizeof commands / sizeof commands[0] ? commands[k] : NULL;
}
