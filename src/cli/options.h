/* Reading of a command line by the table of its command, and the help that follows from the table. */
#ifndef DELBM_CLI_OPTIONS_H
#define DELBM_CLI_OPTIONS_H

#include "cli/commands.h"

/* Fills in operands, settings and the values of options. False where the command is not to run: its help has been printed, or a mistake in the
 * command line; *code is then the exit code. argv[0] is the command's name. */
bool options_read(const struct command *command, int argc, char **argv, struct arguments *arguments, int *code);

void arguments_clear(struct arguments *arguments);

#endif
