/* Messages common to all commands: errors, suggestions, notes. */
#ifndef DELBM_CLI_REPORT_H
#define DELBM_CLI_REPORT_H

#include "base/status.h"
#include "case/case_errors.h"

/* Prints one line on an error in the command line; returns DELBM_USAGE. `command`: NULL for `delbm` itself. */
int usage_error(const char *command, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Prints the error; returns its exit code. */
int report_error(const struct status *status);

/* The considered word nearest to the typed one, if it is near enough (words.h). */
struct suggestion {
  const char *typed;
  const char *nearest; /* NULL: none so far */
  size_t distance;
};
void suggestion_consider(struct suggestion *suggestion, const char *word);

/* Prints each note, preceded by `before`, and releases the notes. */
void notes_print(struct case_errors *notes, const char *before, FILE *file);

#endif
