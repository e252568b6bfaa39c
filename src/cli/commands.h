/* The commands of `delbm`. The table of options of a command is the source of its parser, --help, completion and
 * section of the manual page. Results go to stdout, everything else to stderr. */
#ifndef DELBM_CLI_COMMANDS_H
#define DELBM_CLI_COMMANDS_H

#include "case/case_errors.h"
#include "model/scene.h"

/* Settings key=value for the case. */
struct settings {
  char **items; /* [count] */
  size_t count, capacity;
};

/* A command line, and the case that it names. The options and the operand of a command fill in some of the fields. */
struct arguments {
  const char *command;
  const struct command *const *commands; /* all commands, in the order of the help, ended by NULL */
  char **operands;                       /* [operand_count] */
  int operand_count;
  const char *out, *json; /* NULL: not set */
  struct settings settings;
  bool quiet, fresh, tables, quick;
  struct scene scene;
  struct case_errors notes; /* on rounded values of the case */
};

enum option_kind {
  OPTION_FLAG,    /* sets the bool at `target` */
  OPTION_TEXT,    /* points the const char * at `target` to the argument */
  OPTION_SETTING, /* adds `key`=argument to the settings; the argument alone where key is NULL */
  OPTION_HELP,    /* prints the help of the command and ends */
  OPTION_PRINT    /* calls `print` and ends */
};

struct option_row {
  const char *name;     /* without -- */
  const char *argument; /* name of the argument in the help; NULL: none */
  const char *help;     /* printed with lines indented to one column */
  enum option_kind kind;
  size_t target; /* offset in struct arguments */
  const char *key;
  void (*print)(void);
};

enum { OPTIONS_MAX = 8 };

/* Operand of a command: a word, any number of words, a case, or a folder of results (with case.yaml). */
enum operand { OPERAND_WORD, OPERAND_WORDS, OPERAND_CASE, OPERAND_RESULTS };

struct command {
  const char *name;
  const char *purpose;      /* one line, for the list of commands */
  const char *operand_name; /* in the help and in messages */
  enum operand operand;
  struct option_row options[OPTIONS_MAX];  /* ended by a zero row */
  const char *about, *notes;               /* texts of the help above and below the options; notes may be NULL */
  int (*run)(struct arguments *arguments); /* returns an exit code of delbm/status.h */
};

/* In the order of the help, ended by NULL. */
extern const struct command *const commands[];

extern const struct command command_run, command_resume, command_info, command_analyse, command_plot, command_bench,
    command_completion;

#endif
