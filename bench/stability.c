/* Stability: maps of completed, inaccurate and diverged runs. Files of runs with discs are checked (edge.h). */
#include "edge.h"

bool bench_stability(const struct bench_report *report, struct status *status)
{
  static edge_maps *const all[] = {edge_fluid, edge_discs, edge_contacts, edge_crowds};
  struct edge edge;
  if (!edge_open(&edge, report, status)) return false;
  bool ok = true;
  printf("a place is the value of a run that completed, with ! where inaccurate; xN: stopped as diverged by step N\n");
  for (size_t k = 0; ok && k < sizeof all / sizeof all[0]; k++) ok = all[k](&edge, status);
  edge_close(&edge);
  if (!ok) return false;
  printf("\n\n# %d runs with discs, %d stopped as diverged; no file holds what is not a number\n", edge.runs,
         edge.diverged);
  if (report->json)
    fprintf(report->json, "\n    \"recorded\": {\"runs\": %d, \"diverged\": %d}\n  ", edge.runs, edge.diverged);
  return true;
}
