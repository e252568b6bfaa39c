#include "base/status.h"

#include "base/c_locale.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Threads of OpenMP are in the locale of the process. */
static void print(char *text, size_t size, const char *format, va_list arguments)
{
  const locale_t before = c_locale_enter();
  vsnprintf(text, size, format, arguments);
  c_locale_leave(before);
}

bool status_fail(struct status *status, enum delbm_code code, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  status->code = code;
  status->out_of_memory = false;
  print(status->message, sizeof status->message, format, arguments);
  va_end(arguments);
  return false;
}

void status_add(struct status *status, const char *format, ...)
{
  const size_t length = strlen(status->message);
  va_list arguments;
  va_start(arguments, format);
  print(status->message + length, sizeof status->message - length, format, arguments);
  va_end(arguments);
}
