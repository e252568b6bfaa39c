#include "base/status.h"

#include <stdarg.h>
#include <stdio.h>

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
