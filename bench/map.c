#include "map.h"

#include <inttypes.h>
#include <math.h>

struct place map_judge(const struct map *map, double value, int64_t step)
{
  return (struct place){value <= map->threshold ? COMPLETED : INACCURATE, value, step};
}

struct place map_diverged(int64_t step)
{
  return (struct place){DIVERGED, NAN, step};
}

void map_set_columns(struct map *map, const double *values, int count)
{
  map->columns = count;
  for (int k = 0; k < count; k++) snprintf(map->column[k], MAP_LABEL, "%.6g", values[k]);
}

void map_begin(const struct map *map, const struct bench_report *report)
{
  printf("\n\n# %s: %s, ! above %g\n%-22s", map->name, map->value, map->threshold, map->corner);
  for (int k = 0; k < map->columns; k++) printf(" %10s", map->column[k]);
  printf("\n");
  if (!report->json) return;
  fprintf(report->json,
          "\n    \"%s\": {\"value\": \"%s\", \"inaccurate_above\": %.17g, \"axes\": \"%s\", \"columns\": [", map->name,
          map->value, map->threshold, map->corner);
  for (int k = 0; k < map->columns; k++) fprintf(report->json, "%s\"%s\"", k ? ", " : "", map->column[k]);
  fprintf(report->json, "], \"rows\": {");
}

static void print_place(const struct place *at)
{
  char word[32];
  if (at->verdict == DIVERGED)
    snprintf(word, sizeof word, "x%" PRId64, at->step);
  else
    snprintf(word, sizeof word, "%.3g%s", at->value, at->verdict == INACCURATE ? "!" : "");
  printf(" %10s", word);
}

static void write_place(FILE *json, const struct place *at)
{
  static const char *const verdicts[] = {"completed", "inaccurate", "diverged"};
  fprintf(json, "{\"verdict\": \"%s\", \"step\": %" PRId64, verdicts[at->verdict], at->step);
  if (isfinite(at->value)) fprintf(json, ", \"value\": %.17g", at->value);
  fputc('}', json);
}

void map_row(const struct map *map, const struct bench_report *report, const char *label, const struct place *row,
             bool first)
{
  printf("%-22s", label);
  for (int k = 0; k < map->columns; k++) print_place(&row[k]);
  printf("\n");
  fflush(stdout);
  if (!report->json) return;
  fprintf(report->json, "%s\n      \"%s\": [", first ? "" : ",", label);
  for (int k = 0; k < map->columns; k++) {
    if (k) fprintf(report->json, ", ");
    write_place(report->json, &row[k]);
  }
  fprintf(report->json, "]");
}

void map_end(const struct bench_report *report)
{
  if (report->json) fprintf(report->json, "}},");
}
