#include "model/scene.h"

#include "base/memory.h"
#include "model/fill_grid.h"

#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>

const struct side_kind *side_kind_of(enum side_type type)
{
  static const struct side_kind kinds[] = {
      [SIDE_WALL] = {.name = "a wall", .closed = true, .sticks = true, .velocity = VELOCITY_ALONG},
      [SIDE_PERIODIC] = {.name = "a periodic side"},
      [SIDE_INLET] = {.name = "an inlet", .sticks = true, .velocity = VELOCITY_INTO},
      [SIDE_OUTLET] = {.name = "an outlet"},
      [SIDE_SLIP] = {.name = "a slip side", .closed = true},
  };
  return &kinds[type];
}

double disc_spec_area(const struct disc_spec *disc)
{
  return M_PI * disc->radius * disc->radius;
}

void scene_clear(struct scene *scene)
{
  free(scene->title);
  free(scene->name);
  free(scene->fluid.kernel);
  free(scene->particles.discs);
  *scene = (struct scene){0};
}

static double displaced(double centre, double jitter, gsl_rng *random)
{
  return centre + (2.0 * gsl_rng_uniform(random) - 1.0) * jitter;
}

static void place_discs(const struct fill_spec *fill, size_t columns, size_t rows, gsl_rng *random,
                        struct disc_spec *discs)
{
  for (size_t j = 0; j < rows; j++) {
    for (size_t i = 0; i < columns; i++) {
      struct disc_spec *disc = &discs[j * columns + i];
      *disc = (struct disc_spec){.radius = fill->radius, .density = fill->density};
      disc->position[0] = displaced(fill->region[0] + ((double)i + 0.5) * fill->spacing, fill->jitter, random);
      disc->position[1] = displaced(fill->region[1] + ((double)j + 0.5) * fill->spacing, fill->jitter, random);
    }
  }
}

bool scene_fill(struct scene *scene, struct status *status)
{
  const struct fill_spec *fill = &scene->particles.fill;
  scene->particles.count = scene->particles.listed;
  if (!fill->present) return true;
  double columns = fill_grid_cells(fill->region, fill->spacing, 0);
  double rows = fill_grid_cells(fill->region, fill->spacing, 1);
  if (!(columns >= 1 && rows >= 1 && columns * rows < 1e15))
    return status_fail(status, DELBM_INVALID, "particles.fill: a grid of %g x %g discs", columns, rows);
  size_t added = (size_t)columns * (size_t)rows;
  size_t listed = scene->particles.listed, capacity = listed;
  if (!memory_grow(&scene->particles.discs, &capacity, listed + added, sizeof *scene->particles.discs, "the discs",
                   status))
    return false;
  /* not gsl_rng_alloc, which aborts for want of memory under GSL's default error handler */
  gsl_rng random = {.type = gsl_rng_mt19937,
                    .state = memory_allocate(1, gsl_rng_mt19937->size, "random numbers", status)};
  if (!random.state) return false;
  gsl_rng_set(&random, (unsigned long)fill->seed);
  place_discs(fill, (size_t)columns, (size_t)rows, &random, scene->particles.discs + listed);
  free(random.state);
  scene->particles.count = listed + added;
  return true;
}

double scene_mean_radius(const struct scene *scene)
{
  double sum = 0;
  for (size_t i = 0; i < scene->particles.count; i++) sum += scene->particles.discs[i].radius;
  return sum / (double)scene->particles.count;
}
