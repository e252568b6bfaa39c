/* The commands of `delbm`. Each takes the command line from its own name on (argv[0] is "run") and returns an exit code
 * of delbm/status.h. Results go to stdout, which main checks afterwards; all else goes to stderr. */
#ifndef DELBM_CLI_COMMANDS_H
#define DELBM_CLI_COMMANDS_H

#include <getopt.h>
#include <stddef.h>

struct command {
  const char *name;
  int (*run)(int argc, char **argv);
  const char *purpose;
  const struct option *options; /* ended by a zero entry */
};

/* The commands, in the order of the help; NULL past the last. */
const struct command *command_at(size_t k);

int command_run(int argc, char **argv);
int command_resume(int argc, char **argv);
int command_info(int argc, char **argv);
int command_analyse(int argc, char **argv);
int command_plot(int argc, char **argv);
int command_bench(int argc, char **argv);
int command_completion(int argc, char **argv);

extern const struct option run_options[];
extern const struct option resume_options[];
extern const struct option info_options[];
extern const struct option analyse_options[];
extern const struct option plot_options[];
extern const struct option bench_options[];
extern const struct option completion_options[];

#endif
