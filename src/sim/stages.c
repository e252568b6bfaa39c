#include "sim/stages.h"

#include "base/threads.h"
#include "contact/substeps.h"

const char *stage_name(enum stage stage)
{
  static const char *const names[STAGE_COUNT] = {"occupation", "contact", "exchange", "sweep", "boundary", "output"};
  return names[stage];
}

struct stages stages_of(const struct scene *scene)
{
  size_t moving = 0, free = 0;
  for (size_t i = 0; i < scene->particles.count; i++) {
    moving += scene->particles.discs[i].motion != DISC_FIXED;
    free += scene->particles.discs[i].motion == DISC_FREE;
  }
  const bool fluid = !scene->fluid.none, discs = scene->particles.count > 0;
  struct stages stages = {.fluid = fluid,
                          .discs = discs,
                          .exchange = fluid && discs,
                          .pairs = scene->particles.count > 1 && free > 0,
                          .walls = free > 0 && !(scene_is_periodic(scene, 0) && scene_is_periodic(scene, 1)),
                          .force = scene->fluid.force[0] != 0 || scene->fluid.force[1] != 0 || scene->fluid.zero_flux};
  stages.occupation = !stages.exchange ? OCCUPATION_NEVER : moving ? OCCUPATION_EVERY_STEP : OCCUPATION_ONCE;
  stages.substeps = (stages.pairs || stages.walls) && substeps_max(scene) > 1;
  return stages;
}

int stages_threads(const struct scene *scene)
{
  const int64_t cells_per_disc = 64; /* cells whose sweep takes as long as a step of a disc in contact */
  return threads_for(scene->fluid.none ? cells_per_disc * (int64_t)scene->particles.count : scene_cells(scene));
}
