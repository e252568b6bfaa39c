#include "scene/scene_errors.h"

#include "base/memory.h"

#include <stdarg.h>
#include <stdlib.h>

bool scene_errors_full(const struct scene_errors *errors)
{
  return errors->count >= SCENE_ERRORS_KEPT;
}

static bool append(struct scene_errors *errors, char *line)
{
  struct status ignored; /* that a line is lost is told by `dropped` */
  if (scene_errors_full(errors)) return false;
  if (!memory_grow(&errors->lines, &errors->capacity, errors->count + 1, sizeof *errors->lines, "errors", &ignored))
    return false;
  errors->lines[errors->count++] = line;
  return true;
}

void scene_errors_add(struct scene_errors *errors, const char *format, ...)
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

size_t scene_errors_total(const struct scene_errors *errors)
{
  return errors->count + errors->dropped;
}

void scene_errors_print(const struct scene_errors *errors, FILE *file)
{
  for (size_t i = 0; i < errors->count; i++) fprintf(file, "%s\n", errors->lines[i]);
  if (errors->dropped) fprintf(file, "and %zu more\n", errors->dropped);
}

void scene_errors_clear(struct scene_errors *errors)
{
  for (size_t i = 0; i < errors->count; i++) free(errors->lines[i]);
  free(errors->lines);
  *errors = (struct scene_errors){0};
}
