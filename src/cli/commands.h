/* The commands of `delbm`: for each one table of options, from which its command line is read and its --help, its
 * completion and its part of the manual page are made. Results go to stdout, all else to stderr. */
#ifndef DELBM_CLI_COMMANDS_H
#define DELBM_CLI_COMMANDS_H

#include "case/case_errors.h"
#include "model/scene.h"

/* Words of the form key=value, for the case. */
struct settings {
  char **items; /* [count] */
  size_t count, capacity;
};

/* A command line, and the case that it names. A command uses what its own options and operand fill in. */
struct arguments {
  const char *command;
  const struct command *const *commands; /* all there are, in the order of the help, ended by NULL */
  char **operands;                       /* [operand_count] */
  int operand_count;
  const char *out, *json; /* NULL: not stated */
  struct settings settings;
  bool quiet, fresh, tables, quick;
  struct scene scene;
  struct case_errors notes; /* on values of the case that were rounded */
};

enum option_kind {
  OPTION_FLAG,    /* sets the bool at `target` */
  OPTION_TEXT,    /* points the const char * at `target` to the argument */
  OPTION_SETTING, /* adds `key`=argument to the settings; the argument alone where key is NULL */
  OPTION_HELP,    /* prints the help of the command, which then ends */
  OPTION_PRINT    /* calls `print`; the command then ends */
};

struct option_row {
  const char *name;     /* without -- */
  const char *argument; /* name of the argument in the help; NULL: none */
  const char *help;     /* its lines are indented to one column */
  enum option_kind kind;
  size_t target; /* offset in struct arguments */
  const char *key;
  void (*print)(void);
};

enum { OPTIONS_MAX = 8 };

/* What else a command line has: a word, any number of words, a case, or a folder of results, which holds case.yaml. */
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
