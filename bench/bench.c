#include "bench.h"

#include <stddef.h>

const struct bench *bench_at(size_t index)
{
  static const struct bench all[] = {
      {"sweep", "how fast is the fluid sweep, against a plain read-modify-write of its memory?", bench_sweep},
      {"run", "what does a run of fluid alone cost beyond the bare sweep?", bench_run_alone},
      {"step", "what does a step with discs cost, stage by stage, against one without?", bench_step},
      {"occupation", "what do the areas of covered cells cost, and the stage that lays them out?", bench_occupation},
      {"contact", "what does finding contacts by the grid cost, against linked cells?", bench_contact},
      {"accuracy", "what error does each choice make, for which time?", bench_accuracy},
      {"drag", "how does the drag of a square array depend on form, rates, viscosity and solid fraction?", bench_drag},
      {"lubrication",
       "how much of the force between close surfaces is resolved, and how accurate is sub-grid lubrication?",
       bench_lubrication},
      {"rebound", "how far does a disc rebound from a wall in viscous fluid?", bench_rebound},
      {"grains", "how steep is a heap of discs, and how far does a column of them run out?", bench_grains},
      {"overlap", "how does the overlap area grow with distance, and how does the one by cells differ?", bench_overlap},
      {"stability", "what stays stable and accurate, and where does it end?", bench_stability},
  };
  _Static_assert(sizeof all / sizeof all[0] <= BENCHES_MAX, "too many benchmarks");
  return index < sizeof all / sizeof all[0] ? &all[index] : NULL;
}
