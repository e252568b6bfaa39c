/* A map: what becomes of a case over two axes, rows and columns. On the terminal and for bench/stability.gp each place is
 * one word: the value of a run that completed, with ! where that value is beyond the map's threshold, or xN where
 * the run was stopped as diverged by step N. */
#ifndef DELBM_BENCH_MAP_H
#define DELBM_BENCH_MAP_H

#include "bench.h"

#include <stddef.h>
#include <stdint.h>

enum { MAP_COLUMNS = 16, MAP_LABEL = 24 };

enum verdict { COMPLETED, INACCURATE, DIVERGED };

struct place {
  enum verdict verdict;
  double value; /* NAN where diverged before there was one */
  int64_t step; /* that the run came to */
};

struct map {
  const char *name;   /* also the member of the JSON report */
  const char *value;  /* what the places show */
  const char *corner; /* what rows/columns are */
  double threshold;   /* values above it are inaccurate */
  int columns;
  char column[MAP_COLUMNS][MAP_LABEL];
};

/* Completed or, by the threshold, inaccurate; a value that is not a number is not accurate. */
struct place map_judge(const struct map *map, double value, int64_t step);
struct place map_diverged(int64_t step);

/* Sets the columns' labels from numbers. */
void map_set_columns(struct map *map, const double *values, int count);

/* A map is begun, its rows put one by one, and ended. */
void map_begin(const struct map *map, const struct bench_report *report);
void map_row(const struct map *map, const struct bench_report *report, const char *label, const struct place *row,
             bool first);
void map_end(const struct bench_report *report);

#endif
