#include "cli/commands.h"

const struct command *const commands[] = {&command_run,  &command_resume, &command_info,       &command_analyse,
                                          &command_plot, &command_bench,  &command_completion, NULL};
