/* Completion of command lines, from the tables of commands, options and keys: a script for bash, and for zsh by its
 * emulation of bash. Without a candidate (CASE, DIR, files) the shell completes file names. */
#include "case/case_keys.h"
#include "cli/commands.h"
#include "cli/report.h"

#include <stdio.h>
#include <string.h>

static void print_commands(const struct command *const *all)
{
  printf("    COMPREPLY=($(compgen -W '--help --version");
  for (; *all; all++) printf(" %s", (*all)->name);
  printf("' -- \"$word\"))\n");
}

static void print_options(const struct command *const *all)
{
  for (; *all; all++) {
    printf("    %s) options='", (*all)->name);
    for (const struct option_row *row = (*all)->options; row->name; row++)
      printf("%s--%s", row == (*all)->options ? "" : " ", row->name);
    printf("' ;;\n");
  }
}

/* Prints "key=" of every key; in lists with index 0. */
static void print_keys(void)
{
  size_t count;
  const struct key *keys = key_table(&count);
  printf("    COMPREPLY=($(compgen -W '");
  for (size_t k = 0; k < count; k++) {
    const char *brackets = strstr(keys[k].path, "[]");
    const int length = brackets ? (int)(brackets - keys[k].path) : (int)strlen(keys[k].path);
    printf("%s%.*s%s%s=", k > 0 ? " " : "", length, keys[k].path, brackets ? ".0" : "", brackets ? brackets + 2 : "");
  }
  printf("' -- \"$word\"))\n");
}

static void print_script(const struct command *const *all)
{
  puts("# completion of delbm, written by `delbm completion`\n"
       "_delbm() {\n"
       "  local word=\"${COMP_WORDS[COMP_CWORD]}\" before=\"${COMP_WORDS[COMP_CWORD-1]}\" options=\n"
       "  COMPREPLY=()\n"
       "  if [ \"$COMP_CWORD\" = 1 ]; then");
  print_commands(all);
  puts("    return\n"
       "  fi\n"
       "  if [ \"$before\" = --set ]; then");
  print_keys();
  puts("    type compopt >/dev/null 2>&1 && compopt -o nospace\n"
       "    return\n"
       "  fi\n"
       "  case \"${COMP_WORDS[1]}\" in");
  print_options(all);
  puts("  esac\n"
       "  case \"${COMP_WORDS[1]},$word\" in\n"
       "    *,-*) COMPREPLY=($(compgen -W \"$options\" -- \"$word\")) ;;\n"
       "    completion,*) COMPREPLY=($(compgen -W 'bash zsh' -- \"$word\")) ;;\n"
       "  esac\n"
       "}\n"
       "complete -o default -F _delbm delbm");
}

static int complete(struct arguments *arguments)
{
  const char *shell = *arguments->operands;
  const bool zsh = strcmp(shell, "zsh") == 0;
  if (!zsh && strcmp(shell, "bash") != 0)
    return usage_error(arguments->command, "no completion for '%s', only for bash and zsh", shell);
  if (zsh) puts("autoload -Uz compinit bashcompinit && compinit && bashcompinit");
  print_script(arguments->commands);
  return DELBM_OK;
}

const struct command command_completion = {
    .name = "completion",
    .purpose = "print a completion script for bash or zsh",
    .operand_name = "bash|zsh",
    .operand = OPERAND_WORD,
    .about = "Prints a script that makes the shell complete commands, options and the keys of --set. For this shell:\n"
             "\n"
             "  eval \"$(delbm completion bash)\"   or   eval \"$(delbm completion zsh)\"\n"
             "\n"
             "or put that line into ~/.bashrc or ~/.zshrc.",
    .options = {{"help", NULL, "this text", .kind = OPTION_HELP}},
    .run = complete,
};
