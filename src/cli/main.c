#include "base/c_locale.h"
#include "case/case_file.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "cli/report.h"
#include "output/file.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int print_help(void)
{
  puts("usage: delbm COMMAND [ARGUMENT]...\n"
       "       delbm --help | --version\n"
       "\n"
       "Flows with discs in them, by the lattice Boltzmann method.\n"
       "\n"
       "commands (each has its own --help):");
  for (const struct command *const *c = commands; *c; c++) printf("  %-11s %s\n", (*c)->name, (*c)->purpose);
  puts("\n"
       "OMP_NUM_THREADS sets the number of threads; results do not depend on it.\n"
       "Exit codes: 0 done, 1 run failed (diverged), 2 usage, 3 invalid case, 4 input/output,\n"
       "129, 130 or 143 interrupted by SIGHUP, SIGINT or SIGTERM, after a checkpoint.");
  return DELBM_OK;
}

static int unknown_word(const char *word)
{
  static const char *const own[] = {"--help", "--version"};
  struct suggestion suggestion = {.typed = word};
  for (const struct command *const *c = commands; *c; c++) suggestion_consider(&suggestion, (*c)->name);
  for (size_t k = 0; k < sizeof own / sizeof own[0]; k++) suggestion_consider(&suggestion, own[k]);
  const char *kind = *word == '-' ? "option" : "command";
  if (!suggestion.nearest) return usage_error(NULL, "unknown %s '%s'", kind, word);
  return usage_error(NULL, "unknown %s '%s'; did you mean '%s'?", kind, word, suggestion.nearest);
}

/* Reads the case of the command line; prints all its errors. Returns DELBM_OK or the exit code. */
static int read_case(const char *path, struct arguments *arguments)
{
  struct case_errors errors = {.notes = &arguments->notes};
  const struct settings *settings = &arguments->settings;
  struct status status;
  const bool read = case_read(&arguments->scene, path, settings->items, settings->count, &errors, &status);
  if (!read && case_errors_total(&errors) == 0) report_error(&status);
  case_errors_print(&errors, stderr);
  case_errors_clear(&errors);
  return read ? DELBM_OK : (int)status.code;
}

static int read_results(const char *directory, struct arguments *arguments)
{
  struct status status;
  char *path = file_join(directory, "case.yaml", &status);
  if (!path) return report_error(&status);
  const int code = read_case(path, arguments);
  free(path);
  return code;
}

static int run_command(const struct command *command, int argc, char **argv)
{
  struct arguments arguments = {.command = command->name, .commands = commands};
  int code;
  if (options_read(command, argc, argv, &arguments, &code)) {
    if (command->operand == OPERAND_CASE) code = read_case(*arguments.operands, &arguments);
    if (command->operand == OPERAND_RESULTS) code = read_results(*arguments.operands, &arguments);
    if (code == DELBM_OK) code = command->run(&arguments);
  }
  arguments_clear(&arguments);
  return code;
}

static int dispatch(int argc, char **argv)
{
  if (argc < 2) return usage_error(NULL, "no command given");
  for (const struct command *const *c = commands; *c; c++)
    if (strcmp(argv[1], (*c)->name) == 0) return run_command(*c, argc - 1, argv + 1);
  bool version = strcmp(argv[1], "--version") == 0, help = strcmp(argv[1], "--help") == 0;
  if (!version && !help) return unknown_word(argv[1]);
  if (argc > 2) return usage_error(NULL, "nothing may follow '%s', but '%s' does", argv[1], argv[2]);
  if (help) return print_help();
  puts("delbm " DELBM_VERSION);
  return DELBM_OK;
}

/* Opens /dev/null in place of standard streams that the caller has closed; else the next file opened would get their
 * number and receive messages. It is opened in the opposite direction, so that access fails as on a closed stream. */
static bool reserve_standard_streams(void)
{
  for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; descriptor++)
    if (fcntl(descriptor, F_GETFD) < 0 &&
        open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY) != descriptor)
      return false;
  return true;
}

/* Exit code DELBM_IO in place of success if stdout could not be written. */
static int check_stdout(int code)
{
  errno = 0;
  bool written = !ferror(stdout);
  written = fclose(stdout) == 0 && written;
  if (written) return code;
  fprintf(stderr, "delbm: cannot write to standard output: %s\n", strerror(errno ? errno : EIO));
  return code == DELBM_OK ? DELBM_IO : code;
}

/* Limits the time that waiting OpenMP threads spin, which is wasted if there are more threads than idle cores. The
 * runtime reads GOMP_SPINCOUNT before main, so that the program sets it, unless the user has, and restarts. 500 turns
 * are a few microseconds. Measured on two cores: two runs of two threads take 3 times as long as one alone, without a
 * limit 10 to 40 times. */
static void limit_spinning(char **argv)
{
  if (getenv("OMP_WAIT_POLICY") || getenv("GOMP_SPINCOUNT") || setenv("GOMP_SPINCOUNT", "500", 1) != 0) return;
  execv("/proc/self/exe", argv); /* returns only on failure: continues without a limit */
}

int main(int argc, char **argv)
{
  limit_spinning(argv);
  if (!reserve_standard_streams()) return DELBM_IO;
  c_locale_enter();         /* a library may have set another locale */
  signal(SIGPIPE, SIG_IGN); /* a closed pipe is an error of the write, which check_stdout reports */
  signal(SIGXFSZ, SIG_IGN); /* a file above the size limit is an error of the write */
  return check_stdout(dispatch(argc, argv));
}
