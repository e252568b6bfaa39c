#include "cli/commands.h"
#include "cli/report.h"

#include "bench.h"
#include "fluid/sweep.h"
#include "output/json.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

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
  struct suggestion suggestion = {.typed = name};
  for (size_t k = 0; (bench = bench_at(k)); k++) {
    if (strcmp(bench->name, name) == 0) return bench;
    suggestion_consider(&suggestion, bench->name);
  }
  usage_error("bench", "unknown benchmark '%s'%s%s%s", name, suggestion.nearest ? "; did you mean '" : "",
              suggestion.nearest ? suggestion.nearest : "", suggestion.nearest ? "'?" : "");
  return NULL;
}

static bool copy_members(FILE *members, FILE *json, struct status *status)
{
  char part[4096];
  rewind(members);
  for (size_t n; (n = fread(part, 1, sizeof part, members)) > 0;) fwrite(part, 1, n, json);
  return !ferror(members) || status_fail(status, DELBM_IO, "cannot read the figures back: %s", strerror(errno));
}

/* Runs a benchmark. Its figures go to a temporary file first, so that a failed benchmark leaves valid JSON. */
static bool run_kept(const struct bench *bench, bool quick, FILE *json, struct status *status)
{
  struct bench_report report = {.quick = quick, .json = tmpfile()};
  if (!report.json) return status_fail(status, DELBM_IO, "cannot keep the figures: %s", strerror(errno));
  const bool ok = bench->run(&report, status) && copy_members(report.json, json, status);
  fclose(report.json);
  return ok;
}

/* Writes one member of the JSON object: the figures or, after a failure, the message. */
static bool run_one(const struct bench *bench, bool quick, FILE *json, bool first, struct status *status)
{
  printf("%s== %s: %s\n", first ? "" : "\n", bench->name, bench->question);
  if (!json) return bench->run(&(struct bench_report){.quick = quick}, status);
  fprintf(json, "%s  \"%s\": {", first ? "" : ",\n", bench->name);
  const bool ok = run_kept(bench, quick, json, status);
  if (!ok) {
    fputs("\"failed\": ", json);
    json_text(status->message, json);
  }
  fputc('}', json);
  return ok;
}

/* Runs all chosen benchmarks, also after a failure; returns the exit code of the first failure. */
static int run_chosen(const bool chosen[], bool quick, FILE *json)
{
  const struct bench *bench;
  bool first = true;
  int code = DELBM_OK;
  if (json) fputs("{\n", json);
  for (size_t k = 0; (bench = bench_at(k)); k++) {
    struct status status;
    if (!chosen[k]) continue;
    if (!run_one(bench, quick, json, first, &status)) {
      fflush(stdout);
      const int failed = report_error(&status);
      if (code == DELBM_OK) code = failed;
    }
    first = false;
  }
  if (json) fputs("\n}\n", json);
  return code;
}

/* Marks the benchmarks with these names, or all without a name. */
static bool choose(char **names, int count, bool chosen[])
{
  const struct bench *bench;
  for (size_t k = 0; bench_at(k); k++) chosen[k] = count == 0;
  for (int n = 0; n < count; n++) {
    const struct bench *wanted = find(names[n]);
    if (!wanted) return false;
    for (size_t k = 0; (bench = bench_at(k)); k++) chosen[k] |= bench == wanted;
  }
  return true;
}

static int run_benches(struct arguments *arguments)
{
  struct status status;
  const char *path = arguments->json;
  bool chosen[BENCHES_MAX] = {false};
  FILE *json = NULL;
  if (!choose(arguments->operands, arguments->operand_count, chosen)) return DELBM_USAGE;
  if (path && !(json = fopen(path, "w"))) {
    status_fail(&status, DELBM_IO, "cannot write %s: %s", path, strerror(errno));
    return report_error(&status);
  }
  const int code = run_chosen(chosen, arguments->quick, json);
  if (!json) return code;
  const bool failed = ferror(json);
  if (fclose(json) == 0 && !failed) return code;
  status_fail(&status, DELBM_IO, "cannot write %s: %s", path, strerror(errno));
  return report_error(&status);
}

const struct command command_bench = {
    .name = "bench",
    .purpose = "measure speed on this machine",
    .operand_name = "[NAME]...",
    .operand = OPERAND_WORDS,
    .about = "Measures on this machine, with OMP_NUM_THREADS threads. Without a NAME all benchmarks run: half an hour, "
             "or about\n"
             "a minute with --quick. Each verifies its results; after a failure the others still run, and the exit\n"
             "code is 1.",
    .options = {{"list", NULL, "the benchmarks and the kernels, and which kernels this machine runs",
                 .kind = OPTION_PRINT, .print = print_list},
                {"json", "FILE",
                 "also writes the figures to FILE; of a benchmark that failed the message, as \"failed\"",
                 .kind = OPTION_TEXT, .target = offsetof(struct arguments, json)},
                {"quick", NULL,
                 "the same work and verification, with smaller sizes, fewer cases or fewer repetitions: seconds each",
                 .kind = OPTION_FLAG, .target = offsetof(struct arguments, quick)},
                {"help", NULL, "this text", .kind = OPTION_HELP}},
    .run = run_benches,
};
