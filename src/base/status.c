#include "base/status.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

bool status_fail(struct status *status, enum delbm_code code, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  status->code = code;
  status->out_of_memory = false;
  vsnprintf(status->message, sizeof status->message, format, arguments);
  va_end(arguments);
  return false;
}

void status_add(struct status *status, const char *format, ...)
{
  const size_t length = strlen(status->message);
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(status->message + length, sizeof status->message - length, format, arguments);
  va_end(arguments);
}
