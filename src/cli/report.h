/* What all commands say in the same way: errors, suggestions, notes. */
#ifndef DELBM_CLI_REPORT_H
#define DELBM_CLI_REPORT_H

#include "base/status.h"
#include "case/case_errors.h"

/* Prints one line about a misused command line; returns DELBM_USAGE. `command` is NULL for `delbm` itself. */
int usage_error(const char *command, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Prints the error; returns its exit code. */
int report_error(const struct status *status);

/* The closest of the words considered to the one typed, if it is close enough to be meant. */
struct suggestion {
  const char *typed;
  const char *nearest; /* NULL: none so far */
  size_t distance;
};
void suggestion_consider(struct suggestion *suggestion, const char *word);

/* Prints each note behind these words, and releases the notes. */
void notes_print(struct case_errors *notes, const char *before, FILE *file);

#endif
