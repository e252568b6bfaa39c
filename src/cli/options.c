#include "cli/options.h"

#include "base/memory.h"
#include "base/words.h"
#include "cli/report.h"

#include <getopt.h>
#include <stdlib.h>
#include <string.h>

/* getopt_long returns OPTION_FIRST + k for row k of a table, above every character. */
enum { OPTION_END = -1, OPTION_FIRST = 256 };

/* "--name ARGUMENT" */
static int print_option(const struct option_row *row, char *text, size_t room)
{
  return snprintf(text, room, "--%s%s%s", row->name, row->argument ? " " : "", row->argument ? row->argument : "");
}

static void print_usage(const struct command *command)
{
  char option[64];
  printf("usage: delbm %s %s", command->name, command->operand_name);
  for (const struct option_row *row = command->options; row->name; row++) {
    if (row->kind == OPTION_HELP) continue;
    print_option(row, option, sizeof option);
    printf(" [%s]%s", option, row->kind == OPTION_SETTING && !row->key ? "..." : "");
  }
  printf("\n\n%s\n\n", command->about);
}

static void print_help(const struct command *command)
{
  char option[64];
  int width = 0;
  print_usage(command);
  for (const struct option_row *row = command->options; row->name; row++) {
    const int length = print_option(row, option, sizeof option);
    if (length > width) width = length;
  }
  for (const struct option_row *row = command->options; row->name; row++) {
    print_option(row, option, sizeof option);
    for (const char *line = row->help; line; line = strchr(line, '\n') ? strchr(line, '\n') + 1 : NULL)
      printf("  %-*s  %.*s\n", width, line == row->help ? option : "", (int)strcspn(line, "\n"), line);
  }
  if (command->notes) printf("\n%s\n", command->notes);
}

/* `word`: the option as typed, with or without =value. */
static void report_unknown_option(const char *command, const char *word, const struct option *options)
{
  char name[WORD_LENGTH];
  int length = (int)strcspn(word, "=");
  snprintf(name, sizeof name, "%.*s", length - 2, word + 2);
  struct suggestion suggestion = {.typed = name};
  for (const struct option *option = options; option->name; option++) suggestion_consider(&suggestion, option->name);
  if (suggestion.nearest)
    usage_error(command, "unknown option '%.*s'; did you mean '--%s'?", length, word, suggestion.nearest);
  else
    usage_error(command, "unknown option '%.*s'", length, word);
}

/* `option`: result of getopt_long for the last word. */
static void report_misused_option(int option, char **argv, const struct option *options)
{
  const char *word = argv[optind - 1];
  if (option == ':')
    usage_error(argv[0], "option '%s' needs a value", word);
  else if (optopt >= OPTION_FIRST)
    usage_error(argv[0], "option '%.*s' takes no value", (int)strcspn(word, "="), word);
  else if (optopt)
    usage_error(argv[0], "unknown option '-%c'", optopt);
  else
    report_unknown_option(argv[0], word, options);
}

static int add_setting(const char *key, const char *text, struct arguments *arguments)
{
  struct settings *settings = &arguments->settings;
  const size_t length = (key ? strlen(key) + 1 : 0) + strlen(text) + 1;
  struct status status;
  if (!key && (!strchr(text, '=') || *text == '='))
    return usage_error(arguments->command, "'--set %s' is not key=value", text);
  if (!memory_grow(&settings->items, &settings->capacity, settings->count + 1, sizeof(char *), "the settings", &status))
    return report_error(&status);
  char *item = memory_allocate(length, 1, "the settings", &status);
  if (!item) return report_error(&status);
  snprintf(item, length, "%s%s%s", key ? key : "", key ? "=" : "", text);
  settings->items[settings->count++] = item;
  return DELBM_OK;
}

/* Stores the value of an option. Returns DELBM_OK, or the exit code of a reported error. */
static int take(const struct option_row *row, const char *text, struct arguments *arguments)
{
  void *target = (char *)arguments + row->target;
  if (row->kind == OPTION_SETTING) return add_setting(row->key, text, arguments);
  if (row->kind == OPTION_TEXT) memcpy(target, &text, sizeof text);
  if (row->kind == OPTION_FLAG) *(bool *)target = true;
  return DELBM_OK;
}

static int check_operands(const struct command *command, const struct arguments *arguments)
{
  if (command->operand == OPERAND_WORDS || arguments->operand_count == 1) return DELBM_OK;
  if (arguments->operand_count == 0) return usage_error(command->name, "%s is missing", command->operand_name);
  return usage_error(command->name, "one %s at a time: '%s' is one word too many", command->operand_name,
                     arguments->operands[1]);
}

/* Reads options up to the first that ends the command; returns as options_read. */
static bool read_options(const struct command *command, int argc, char **argv, struct arguments *arguments, int *code)
{
  struct option list[OPTIONS_MAX] = {0};
  for (int k = 0; command->options[k].name; k++)
    list[k] = (struct option){command->options[k].name, command->options[k].argument ? required_argument : no_argument,
                              NULL, OPTION_FIRST + k};
  opterr = 0;
  for (int option; (option = getopt_long(argc, argv, ":", list, NULL)) != OPTION_END;) {
    *code = DELBM_USAGE;
    if (option < OPTION_FIRST) report_misused_option(option, argv, list);
    if (option < OPTION_FIRST) return false;
    const struct option_row *row = &command->options[option - OPTION_FIRST];
    *code = take(row, optarg, arguments);
    if (row->kind == OPTION_HELP) print_help(command);
    if (row->kind == OPTION_PRINT) row->print();
    if (row->kind >= OPTION_HELP || *code != DELBM_OK) return false;
  }
  return true;
}

bool options_read(const struct command *command, int argc, char **argv, struct arguments *arguments, int *code)
{
  if (!read_options(command, argc, argv, arguments, code)) return false;
  arguments->operands = argv + optind;
  arguments->operand_count = argc - optind;
  *code = check_operands(command, arguments);
  return *code == DELBM_OK;
}

void arguments_clear(struct arguments *arguments)
{
  for (size_t k = 0; k < arguments->settings.count; k++) free(arguments->settings.items[k]);
  free(arguments->settings.items);
  scene_clear(&arguments->scene);
  case_errors_clear(&arguments->notes);
}
