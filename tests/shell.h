/* A test in its own folder that runs the program by the shell like a user. DELBM is the path of the program. */
#ifndef DELBM_TESTS_SHELL_H
#define DELBM_TESTS_SHELL_H

#include <criterion/criterion.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static char shell_folder[] = "/tmp/delbm-test-XXXXXX";

static inline void shell_enter(void)
{
  cr_assert(mkdtemp(shell_folder) && chdir(shell_folder) == 0);
  setenv("DELBM", DELBM, 1);
  signal(SIGHUP, SIG_DFL); /* nohup ignores it, and the program would inherit that */
}

static inline void shell_leave(void)
{
  char command[64];
  snprintf(command, sizeof command, "rm -rf %s", shell_folder);
  cr_assert_eq(chdir("/") + system(command), 0);
}

/* Runs a script, in which $DELBM is the program; returns its exit code, 128 + n for a script ended by signal n. */
__attribute__((format(printf, 1, 2))) static inline int shell(const char *format, ...)
{
  char script[4096];
  va_list arguments;
  va_start(arguments, format);
  const int length = vsnprintf(script, sizeof script, format, arguments);
  va_end(arguments);
  cr_assert_lt(length, (int)sizeof script);
  const int result = system(script);
  return WIFEXITED(result) ? WEXITSTATUS(result) : 128 + WTERMSIG(result);
}

static inline void shell_write(const char *path, const char *text)
{
  FILE *file = fopen(path, "w");
  cr_assert(file && fputs(text, file) >= 0 && fclose(file) == 0);
}

#endif
