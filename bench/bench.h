/* Benchmarks: one file per question, run by `delbm bench NAME`. Each verifies what it times, prints a table and, on
 * request, adds to a JSON report. */
#ifndef DELBM_BENCH_BENCH_H
#define DELBM_BENCH_BENCH_H

#include "base/status.h"

#include <stdio.h>

/* Where a benchmark leaves its figures. `json` is NULL unless --json was given; what is written there are the members
 * of an object of the benchmark's name. */
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

bench_run bench_accuracy, bench_contact, bench_drag, bench_occupation, bench_overlap, bench_run_alone, bench_stability,
    bench_step, bench_sweep;

/* Prints what is measured on, and puts it into the report as its first member. */
void bench_describe_machine(const struct bench_report *report);

enum { BENCHES_MOST = 16 };

/* All benchmarks, BENCHES_MOST at most; NULL past the last. */
const struct bench *bench_at(size_t index);

#endif
