/* The errors found in a case: one line of text each, in the order found. */
#ifndef DELBM_CASE_CASE_ERRORS_H
#define DELBM_CASE_CASE_ERRORS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

enum { SCENE_ERRORS_KEPT = 1000 };

/* A list; all zero: empty. */
struct case_errors {
  struct case_errors *notes; /* list for notes on rounded values; NULL: none wanted */
  char **lines;              /* [count] */
  size_t count;
  size_t capacity;
  size_t dropped; /* number of errors without a line: past SCENE_ERRORS_KEPT, or no memory */
};

void case_errors_add(struct case_errors *errors, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* True if further errors will only be counted. */
bool case_errors_full(const struct case_errors *errors);

/* Number of errors with and without a line. */
size_t case_errors_total(const struct case_errors *errors);

/* Prints one error a line, and the number of errors without a line. */
void case_errors_print(const struct case_errors *errors, FILE *file);

/* Releases the lines but not the notes; leaves an empty list. */
void case_errors_clear(struct case_errors *errors);

#endif
