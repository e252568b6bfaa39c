/* Benchmarks: one file per question, run by `delbm bench NAME`. Each verifies what it times, prints a table and, on
 * request, adds to a JSON report. */
#ifndef DELBM_BENCH_BENCH_H
#define DELBM_BENCH_BENCH_H

#include "base/status.h"

#include <stdio.h>

/* Destination of a benchmark's figures. `json` is NULL without --json; a benchmark writes the members of an object
 * of its name. */
struct bench_report {
  FILE *json;
  bool quick; /* the same work and verification, with smaller sizes, fewer cases or fewer repetitions */
};

typedef bool bench_run(const struct bench_report *report, struct status *status);

struct bench {
  const char *name;
  const char *question;
  bench_run *run;
};

bench_run bench_accuracy, bench_contact, bench_drag, bench_grains, bench_lubrication, bench_occupation, bench_overlap,
    bench_rebound, bench_run_alone, bench_stability, bench_step, bench_sweep;

/* Prints the machine, and writes it as the first member of the report. */
void bench_describe_machine(const struct bench_report *report);

enum { BENCHES_MAX = 16 };

/* All benchmarks, BENCHES_MAX at most; NULL past the last. */
const struct bench *bench_at(size_t index);

#endif
