/* Starting and advancing a simulation in a test, which fails with the program's message where that fails. */
#ifndef DELBM_TESTS_DRIVE_H
#define DELBM_TESTS_DRIVE_H

#include "sim/simulation.h"

#include <criterion/criterion.h>

static inline struct simulation *start(const struct scene *scene)
{
  struct simulation *simulation;
  struct status status;
  cr_assert(simulation_create(&simulation, scene, &status), "%s", status.message);
  return simulation;
}

static inline void advance(struct simulation *simulation, int64_t steps)
{
  struct status status;
  cr_assert(simulation_advance(simulation, steps, &status), "%s", status.message);
}

#endif
