/* Parsing of a command line, and its help, by the table of the command. */
#ifndef DELBM_CLI_OPTIONS_H
#define DELBM_CLI_OPTIONS_H

#include "cli/commands.h"

/* Fills in operands, settings and values of options. False if the command is not to run: its help has been printed, or
 * the command line has an error; *code is then the exit code. argv[0]: name of the command. */
bool options_read(const struct command *command, int argc, char **argv, struct arguments *arguments, int *code);

void arguments_clear(struct arguments *arguments);

#endif
