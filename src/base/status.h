/* Errors: each is detected where it happens, carries its code, the offending value and the place in words, and is
 * passed up unchanged to be reported once. A function that can fail returns true on success; on failure it has filled
 * *status. */
#ifndef DELBM_BASE_STATUS_H
#define DELBM_BASE_STATUS_H

#include "delbm/status.h"

#include <stdbool.h>

enum { STATUS_MESSAGE = 1024 };

struct status {
  enum delbm_code code;
  bool out_of_memory; /* the cause is lack of memory, and no divergence */
  char message[STATUS_MESSAGE];
};

/* Fills *status and returns false, so that a caller can write `return status_fail(...)`. */
bool status_fail(struct status *status, enum delbm_code code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Adds words to the message of a failure. */
void status_add(struct status *status, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif
