/* The commands of `delbm`. Each takes the command line from its own name on (argv[0] is "run") and returns an exit code
 * of delbm/status.h. Results go to stdout, which main checks afterwards; all else goes to stderr. */
#ifndef DELBM_CLI_COMMANDS_H
#define DELBM_CLI_COMMANDS_H

int command_run(int argc, char **argv);
int command_resume(int argc, char **argv);
int command_info(int argc, char **argv);
int command_analyse(int argc, char **argv);
int command_plot(int argc, char **argv);
int command_bench(int argc, char **argv);

#endif
