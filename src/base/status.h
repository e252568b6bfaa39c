/* Errors. A function that can fail returns true on success; on failure it returns false and fills *status with a code
 * and a message that names the value and its place. Callers pass the status up unchanged; the command reports
 * it once. */
#ifndef DELBM_BASE_STATUS_H
#define DELBM_BASE_STATUS_H

#include "delbm/status.h"

#include <stdbool.h>

enum { STATUS_MESSAGE = 1024 };

struct status {
  enum delbm_code code;
  bool out_of_memory; /* DELBM_FAILED or DELBM_INVALID for lack of memory, not for divergence or a wrong case */
  char message[STATUS_MESSAGE];
};

/* Fills *status; returns false, for use as `return status_fail(...)`. */
bool status_fail(struct status *status, enum delbm_code code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Appends to the message of a failure. */
void status_add(struct status *status, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif
