/* What the commands share: reading the command line, reading the case it names, and reporting errors. */
#ifndef DELBM_CLI_OPTIONS_H
#define DELBM_CLI_OPTIONS_H

#include "case/case_errors.h"
#include "model/scene.h"

#include <getopt.h>

/* Every option has a long name and a `val` of OPTION_FIRST or more. option_next also returns END and BAD. */
enum { OPTION_END = -1, OPTION_BAD = 0, OPTION_FIRST = 256, OPTION_HELP = OPTION_FIRST, OPTION_OWN };

/* The next option of the command argv[0]. OPTION_BAD when it is not one of `options` (ended by a zero entry), its
 * argument is missing or it has one too many, which has then been reported. */
int option_next(int argc, char **argv, const struct option *options);

/* After OPTION_END: the one word that is left, named `what` in messages. NULL, reported, when there is none or
 * another. */
const char *option_operand(int argc, char **argv, const char *what);

/* The words given by --set. */
struct settings {
  char **items;
  size_t count;
};

/* Adds a word given by --set to the command argv[0]. Returns DELBM_OK, or the exit code of what it has reported: that it
 * is not key=value, or that there is no memory. */
int settings_add(struct settings *settings, char *setting, int argc, char **argv);

/* Reads the case; prints all errors found. Returns DELBM_OK with the scene filled in, or the exit code. What is taken
 * otherwise than it is written goes into the notes. */
int read_case(struct scene *scene, const char *path, const struct settings *settings, struct case_errors *notes);

/* Prints each note behind these words, and releases them. */
void notes_print(struct case_errors *notes, const char *before, FILE *file);

/* Prints one line about a misused command line; returns DELBM_USAGE. `command` is NULL for `delbm` itself. */
int usage_error(const char *command, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Prints the error; returns its exit code. */
int report_error(const struct status *status);

/* The closest of the words considered to the one given, if it is close enough to be meant. */
struct suggestion {
  const char *given;
  const char *nearest; /* NULL: none so far */
  size_t distance;
};
void suggestion_consider(struct suggestion *suggestion, const char *word);

#endif
