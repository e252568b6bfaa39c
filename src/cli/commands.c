#include "cli/commands.h"

static const struct command commands[] = {
    {"run", command_run, "simulate a case", run_options},
    {"resume", command_resume, "go on with a run from its last checkpoint", resume_options},
    {"info", command_info, "show a case and the plan of its run", info_options},
    {"analyse", command_analyse, "report what the discs of a finished run did", analyse_options},
    {"plot", command_plot, "draw a run by gnuplot", plot_options},
    {"bench", command_bench, "measure speed on this machine", bench_options},
    {"completion", command_completion, "print what completes command lines in bash or zsh", completion_options},
};

const struct command *command_at(size_t k)
{
  return k < sizeof commands / sizeof commands[0] ? &commands[k] : NULL;
}
