#include "cli/report.h"

#include "base/words.h"

#include <stdarg.h>

int usage_error(const char *command, const char *format, ...)
{
  const char *space = command ? " " : "", *name = command ? command : "";
  va_list arguments;
  va_start(arguments, format);
  fprintf(stderr, "delbm%s%s: ", space, name);
  vfprintf(stderr, format, arguments);
  fprintf(stderr, " (see 'delbm%s%s --help')\n", space, name);
  va_end(arguments);
  return DELBM_USAGE;
}

int report_error(const struct status *status)
{
  fprintf(stderr, "delbm: %s\n", status->message);
  return (int)status->code;
}

void suggestion_consider(struct suggestion *suggestion, const char *word)
{
  size_t distance = edit_distance(suggestion->typed, word);
  if (!words_are_near(suggestion->typed, distance) || (suggestion->nearest && distance >= suggestion->distance)) return;
  suggestion->nearest = word;
  suggestion->distance = distance;
}

void notes_print(struct case_errors *notes, const char *before, FILE *file)
{
  for (size_t i = 0; i < notes->count; i++) fprintf(file, "%s%s\n", before, notes->lines[i]);
  if (notes->dropped > 0) fprintf(file, "%s%zu more values are rounded\n", before, notes->dropped);
  case_errors_clear(notes);
}
