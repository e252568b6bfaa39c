#include "cli/options.h"

#include "base/memory.h"
#include "base/words.h"
#include "case/case_file.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
  size_t distance = edit_distance(suggestion->given, word);
  if (!words_are_near(suggestion->given, distance) || (suggestion->nearest && distance >= suggestion->distance)) return;
  suggestion->nearest = word;
  suggestion->distance = distance;
}

/* `word` is the option as given, perhaps with =value. */
static void report_unknown_option(const char *command, const char *word, const struct option *options)
{
  char name[WORD_LENGTH];
  int length = (int)strcspn(word, "=");
  snprintf(name, sizeof name, "%.*s", length - 2, word + 2);
  struct suggestion suggestion = {.given = name};
  for (const struct option *option = options; option->name; option++) suggestion_consider(&suggestion, option->name);
  if (suggestion.nearest)
    usage_error(command, "unknown option '%.*s'; did you mean '--%s'?", length, word, suggestion.nearest);
  else
    usage_error(command, "unknown option '%.*s'", length, word);
}

int option_next(int argc, char **argv, const struct option *options)
{
  opterr = 0;
  int option = getopt_long(argc, argv, ":", options, NULL);
  if (option != '?' && option != ':') return option;
  const char *word = argv[optind - 1];
  if (option == ':')
    usage_error(argv[0], "option '%s' needs a value", word);
  else if (optopt >= OPTION_FIRST)
    usage_error(argv[0], "option '%.*s' takes no value", (int)strcspn(word, "="), word);
  else if (optopt)
    usage_error(argv[0], "unknown option '-%c'", optopt);
  else
    report_unknown_option(argv[0], word, options);
  return OPTION_BAD;
}

const char *option_operand(int argc, char **argv, const char *what)
{
  if (argc - optind == 1) return argv[optind];
  if (argc == optind)
    usage_error(argv[0], "%s is missing", what);
  else
    usage_error(argv[0], "one %s at a time: '%s' is one word too many", what, argv[optind + 1]);
  return NULL;
}

int settings_add(struct settings *settings, char *setting, int argc, char **argv)
{
  if (!strchr(setting, '=') || *setting == '=') return usage_error(argv[0], "'--set %s' is not key=value", setting);
  struct status status;
  if (!settings->items) settings->items = memory_allocate((size_t)argc, sizeof(char *), "the settings", &status);
  if (!settings->items) return report_error(&status);
  settings->items[settings->count++] = setting;
  return DELBM_OK;
}

int read_case(struct scene *scene, const char *path, const struct settings *settings, struct case_errors *notes)
{
  struct case_errors errors = {.notes = notes};
  struct status status;
  bool read = case_read(scene, path, settings->items, settings->count, &errors, &status);
  if (!read && case_errors_total(&errors) == 0) report_error(&status);
  case_errors_print(&errors, stderr);
  case_errors_clear(&errors);
  return read ? DELBM_OK : (int)status.code;
}

void notes_print(struct case_errors *notes, const char *before, FILE *file)
{
  for (size_t i = 0; i < notes->count; i++) fprintf(file, "%s%s\n", before, notes->lines[i]);
  if (notes->dropped > 0) fprintf(file, "%s%zu more values are rounded\n", before, notes->dropped);
  case_errors_clear(notes);
}
