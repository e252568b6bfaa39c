/* A map: the outcome of a case over two parameters, rows and columns. On the terminal and for bench/stability.gp
 * each entry is one word: the value of a completed run, with ! if beyond the map's threshold, or xN for a run that
 * diverged by step N. */
#ifndef DELBM_BENCH_MAP_H
#define DELBM_BENCH_MAP_H

#include "bench.h"

#include <stddef.h>
#include <stdint.h>

enum { MAP_COLUMNS = 16, MAP_LABEL = 24 };

enum verdict { COMPLETED, INACCURATE, DIVERGED };

struct place {
  enum verdict verdict;
  double value; /* NAN if diverged before there was a value */
  int64_t step; /* last step of the run */
};

struct map {
  const char *name;   /* also the member of the JSON report */
  const char *value;  /* meaning of the entries */
  const char *corner; /* names of rows/columns */
  double threshold;   /* values above it are inaccurate */
  int columns;
  char column[MAP_COLUMNS][MAP_LABEL];
};

/* Completed or, by the threshold, inaccurate; NAN is inaccurate. */
struct place map_judge(const struct map *map, double value, int64_t step);
struct place map_diverged(int64_t step);

/* Sets the columns' labels from numbers. */
void map_set_columns(struct map *map, const double *values, int count);

/* Call map_begin, map_put for each row, map_end. */
void map_begin(const struct map *map, const struct bench_report *report);
void map_row(const struct map *map, const struct bench_report *report, const char *label, const struct place *row,
             bool first);
void map_end(const struct bench_report *report);

#endif
