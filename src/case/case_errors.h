/* The errors found in a case: one line of text each, in the order found. */
#ifndef DELBM_CASE_CASE_ERRORS_H
#define DELBM_CASE_CASE_ERRORS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

enum { SCENE_ERRORS_KEPT = 1000 };

/* All zero is an empty list. */
struct case_errors {
  struct case_errors *notes; /* for lines on what is taken otherwise than it is written; NULL: not wanted */
  char **lines;              /* [count] */
  size_t count;
  size_t capacity;
  size_t dropped; /* further errors, past SCENE_ERRORS_KEPT or for want of memory, of which only the number is known */
};

void case_errors_add(struct case_errors *errors, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* True once further errors are only counted. */
bool case_errors_full(const struct case_errors *errors);

/* Kept and dropped ones. */
size_t case_errors_total(const struct case_errors *errors);

/* One error a line, and a last line with the number of those dropped. */
void case_errors_print(const struct case_errors *errors, FILE *file);

/* Releases the lines and leaves an empty list; the notes are the caller's. */
void case_errors_clear(struct case_errors *errors);

#endif
