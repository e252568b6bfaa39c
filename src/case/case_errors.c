#include "case/case_errors.h"

#include "base/memory.h"

#include <stdarg.h>
#include <stdlib.h>

bool case_errors_full(const struct case_errors *errors)
{
  return errors->count >= SCENE_ERRORS_KEPT;
}

static bool append(struct case_errors *errors, char *line)
{
  struct status ignored; /* the line is counted in `dropped` */
  if (case_errors_full(errors)) return false;
  if (!memory_grow(&errors->lines, &errors->capacity, errors->count + 1, sizeof *errors->lines, "errors", &ignored))
    return false;
  errors->lines[errors->count++] = line;
  return true;
}

void case_errors_add(struct case_errors *errors, const char *format, ...)
{
  char *line;
  va_list arguments;
  va_start(arguments, format);
  int length = vasprintf(&line, format, arguments);
  va_end(arguments);
  if (length >= 0 && append(errors, line)) return;
  if (length >= 0) free(line);
  errors->dropped++;
}

size_t case_errors_total(const struct case_errors *errors)
{
  return errors->count + errors->dropped;
}

void case_errors_print(const struct case_errors *errors, FILE *file)
{
  for (size_t i = 0; i < errors->count; i++) fprintf(file, "%s\n", errors->lines[i]);
  if (errors->dropped) fprintf(file, "and %zu more\n", errors->dropped);
}

void case_errors_clear(struct case_errors *errors)
{
  for (size_t i = 0; i < errors->count; i++) free(errors->lines[i]);
  free(errors->lines);
  *errors = (struct case_errors){0};
}
