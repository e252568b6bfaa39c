#include "cli/commands.h"
#include "cli/options.h"

#include "bench.h"
#include "fluid/sweep.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

enum { OPTION_LIST = OPTION_OWN, OPTION_JSON, OPTION_QUICK };

const struct option bench_options[] = {{"list", no_argument, NULL, OPTION_LIST},
                                       {"json", required_argument, NULL, OPTION_JSON},
                                       {"quick", no_argument, NULL, OPTION_QUICK},
                                       {"help", no_argument, NULL, OPTION_HELP},
                                       {0}};

static void print_help(void)
{
  puts("usage: delbm bench [NAME]... [--list] [--json FILE] [--quick]\n"
       "\n"
       "Measures on this machine, with OMP_NUM_THREADS threads. Without a NAME all benchmarks run.\n"
       "\n"
       "  --list       the benchmarks and the kernels, and which kernels this machine runs\n"
       "  --json FILE  also writes the figures to FILE\n"
       "  --quick      a short run that checks the benchmarks rather than the machine\n"
       "  --help       this text");
}

static void print_list(void)
{
  const struct bench *bench;
  const struct sweep_kernel *kernel;
  bool runs;
  puts("benchmarks:");
  for (size_t k = 0; (bench = bench_at(k)); k++) printf("  %-12s %s\n", bench->name, bench->question);
  puts("kernels (fluid.kernel):");
  for (size_t k = 0; (kernel = sweep_kernel_at(k, &runs)); k++)
    printf("  %-18s %s\n", kernel->name, runs ? "runs here" : "needs another processor");
}

static const struct bench *find(const char *name)
{
  const struct bench *bench;
  struct suggestion suggestion = {.given = name};
  for (size_t k = 0; (bench = bench_at(k)); k++) {
    if (strcmp(bench->name, name) == 0) return bench;
    suggestion_consider(&suggestion, bench->name);
  }
  usage_error("bench", "unknown benchmark '%s'%s%s%s", name, suggestion.nearest ? "; did you mean '" : "",
              suggestion.nearest ? suggestion.nearest : "", suggestion.nearest ? "'?" : "");
  return NULL;
}

static bool run_one(const struct bench *bench, struct bench_report *report, bool first, struct status *status)
{
  printf("%s== %s: %s\n", first ? "" : "\n", bench->name, bench->question);
  if (report->json) fprintf(report->json, "%s  \"%s\": {", first ? "" : ",\n", bench->name);
  if (!bench->run(report, status)) return false;
  if (report->json) fprintf(report->json, "}");
  return true;
}

/* Runs the named benchmarks, or all. */
static bool run_all(char **names, int count, struct bench_report *report, struct status *status)
{
  const struct bench *bench;
  if (report->json) fprintf(report->json, "{\n");
  for (int k = 0; k < count; k++)
    if (!run_one(find(names[k]), report, k == 0, status)) return false;
  for (size_t k = 0; count == 0 && (bench = bench_at(k)); k++)
    if (!run_one(bench, report, k == 0, status)) return false;
  if (report->json) fprintf(report->json, "\n}\n");
  return true;
}

static int run_benches(char **names, int count, struct bench_report *report, const char *path)
{
  struct status status;
  for (int k = 0; k < count; k++)
    if (!find(names[k])) return DELBM_USAGE;
  if (path && !(report->json = fopen(path, "w"))) {
    status_fail(&status, DELBM_IO, "cannot write %s: %s", path, strerror(errno));
    return report_error(&status);
  }
  bool ok = run_all(names, count, report, &status);
  if (report->json) {
    const bool failed = ferror(report->json);
    if ((fclose(report->json) != 0 || failed) && ok)
      ok = status_fail(&status, DELBM_IO, "cannot write %s: %s", path, strerror(errno));
  }
  return ok ? DELBM_OK : report_error(&status);
}

int command_bench(int argc, char **argv)
{
  struct bench_report report = {0};
  const char *path = NULL;
  for (int option; (option = option_next(argc, argv, bench_options)) != OPTION_END;) {
    switch (option) {
    case OPTION_LIST:
      print_list();
      return DELBM_OK;
    case OPTION_JSON:
      path = optarg;
      break;
    case OPTION_QUICK:
      report.quick = true;
      break;
    case OPTION_HELP:
      print_help();
      return DELBM_OK;
    default:
      return DELBM_USAGE;
    }
  }
  return run_benches(argv + optind, argc - optind, &report, path);
}
