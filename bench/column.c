#include "column.h"

#include "base/memory.h"
#include "contact/law.h"
#include "heap.h"
#include "scenes.h"
#include "sim/load.h"
#include "sim/simulation.h"

#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>

static const double density = 2.5, spread = 0.2, packed = 0.84;
static const double wet_speed = 0.08; /* sqrt(2 g H_0) */

/* Touching: as close as 2 % of R, the order of overlaps in the collapse. */
static const double touching = 0.02;

/* sqrt(2 g H_0), dry. Without friction, discs at the far side of the box are squeezed out upwards at up to 1.8 times this
 * speed, which has to remain below 0.346. */
static double dry_speed(const struct column *c)
{
  return c->friction > 0 ? 0.25 : 0.15;
}

static bool draw_radii(const struct column *c, double *radius, double *jitter, struct status *status)
{
  gsl_rng random = {.type = gsl_rng_mt19937,
                    .state = memory_allocate(1, gsl_rng_mt19937->size, "random numbers", status)};
  if (!random.state) return false;
  gsl_rng_set(&random, (unsigned long)c->seed);
  for (int k = 0; k < c->discs; k++) {
    radius[k] = column_radius * (1 + spread * (2 * gsl_rng_uniform(&random) - 1));
    for (int axis = 0; axis < 2; axis++) jitter[2 * k + axis] = 2 * gsl_rng_uniform(&random) - 1;
  }
  free(random.state);
  return true;
}

static double floor_level(const struct column *c)
{
  return c->rough ? 2 * column_radius : 0;
}

static void add_floor(struct scene *scene, const struct column *c)
{
  if (!c->rough) return;
  const int count = (int)(scene->domain.size[0] / (2 * column_radius));
  for (int k = 0; k < count; k++)
    scene_add_disc(scene, column_radius, density, (2 * k + 1) * column_radius, floor_level(c) - column_radius)->motion =
        DISC_FIXED;
}

/* Stiffness for an overlap of 1 % of R in an impact at an eighth of the speed of free fall from H_0: under 4 % in any. */
static double stiffness_of(const struct scene *scene, double speed)
{
  struct contact_law law = contact_law_of(scene);
  const double radius[2] = {column_radius, column_radius};
  law.k_n = 1;
  const double mass = 0.5 * density * M_PI * column_radius * column_radius;
  return 0.5 * mass * speed * speed / 64 / contact_energy(&law, radius, 0.01 * column_radius);
}

static struct scene common(const struct column *c, int width, int height, double g)
{
  struct scene scene = scene_box(width, height, c->viscosity, SIDES_CLOSED);
  scene.domain.side[SIDE_LEFT].type = SIDE_SLIP;
  scene.particles.gravity[1] = -g;
  scene.contact.restitution = c->restitution;
  return scene;
}

/* The discs on a loose lattice between smooth sides. */
static bool pouring(const struct column *c, double g, struct scene *scene, struct status *status)
{
  double *radius = memory_allocate(3 * (size_t)c->discs, sizeof *radius, "radii", status);
  if (!radius || !draw_radii(c, radius, radius + c->discs, status)) {
    free(radius);
    return false;
  }
  const int columns = (int)(c->width / (2.5 * column_radius)), rows = (c->discs + columns - 1) / columns;
  const double spacing = c->width / columns, level = floor_level(c);
  *scene = common(c, (int)c->width, (int)(level + (rows + 1) * spacing), g);
  scene->domain.side[SIDE_RIGHT].type = SIDE_SLIP;
  scene_dry(scene);
  scene->contact.stiffness = stiffness_of(scene, dry_speed(c));
  add_floor(scene, c);
  for (int k = 0; k < c->discs; k++) {
    const double room = 0.5 * spacing - (1 + spread) * column_radius, *jitter = radius + c->discs + 2 * k;
    const int row = k / columns, column = k % columns;
    scene_add_disc(scene, radius[k], density, (column + 0.5) * spacing + room * jitter[0],
                   level + (row + 0.5) * spacing + room * jitter[1]);
  }
  free(radius);
  return true;
}

static bool observe(const struct column *c, const struct simulation *simulation, struct heap *heap,
                    struct status *status)
{
  return heap_of(heap, simulation_discs(simulation), touching * column_radius, floor_level(c), column_radius, status);
}

static void take_places(struct scene *to, const struct discs *d)
{
  for (size_t i = 0; i < d->count; i++)
    if (d->motion[i] == DISC_FREE) scene_add_disc(to, d->radius[i], density, d->x[i], d->y[i]);
}

/* Height of a column that covers its width with its mean outline. */
static double height_of(const struct column *c, const struct discs *d)
{
  double moment = 0, area = 0;
  for (size_t i = 0; i < d->count; i++)
    if (d->motion[i] == DISC_FREE) {
      const double a = d->radius[i] * d->radius[i];
      area += a;
      moment += a * (d->y[i] - floor_level(c));
    }
  return 2 * moment / area;
}

/* Fills `released` with the discs at rest, and sets the height. */
static bool pour(struct column *c, double g, struct scene *released, struct status *status)
{
  enum { MIN = 8, MAX = 400 };
  struct scene scene = {0};
  struct simulation *simulation = NULL;
  struct heap heap = {.kinetic = INFINITY};
  const double rest = 1e-3 * g * column_radius;
  const int64_t interval = (int64_t)ceil(0.25 * sqrt(c->width * c->aspect / g));
  bool ok = pouring(c, g, &scene, status) && simulation_create(&simulation, &scene, status);
  int k = 0;
  for (; ok && (k < MIN || heap.kinetic > rest) && k < MAX; k++)
    ok = simulation_advance(simulation, interval, status) && observe(c, simulation, &heap, status);
  if (ok && k == MAX) ok = status_fail(status, DELBM_FAILED, "the discs of a column do not come to rest");
  if (ok) {
    take_places(released, simulation_discs(simulation));
    c->height = height_of(c, simulation_discs(simulation));
  }
  simulation_destroy(simulation);
  scene_clear(&scene);
  return ok;
}

enum { SAMPLES = 2000, LEAST = 70 };

/* Places of the front at intervals of time. */
struct advance {
  int count;
  double interval; /* over sqrt(H_0/g) */
  double front[SAMPLES];
};

static void take_figures(struct column *c, const struct heap *heap, const struct advance *a,
                         struct simulation *simulation)
{
  struct simulation_report report;
  int k = 0;
  simulation_report(simulation, &report);
  while (a->front[k] < c->width + 0.95 * (heap->front - c->width)) k++;
  c->time = (k + 1) * a->interval;
  c->end = a->count * a->interval;
  c->run_out = heap->front / c->width - 1;
  c->final_height = heap->height / c->width;
  c->slope = atan(heap->slope) * 180 / M_PI;
  c->apart = (size_t)c->discs - heap->count;
  c->max_overlap = report.max_overlap;
}

/* Until the mean kinetic energy in the mass is that of a fall by R/10,000, but at least for 7 sqrt(H_0/g): the front arrives
 * after 4 to 6, and on the way the mass is in pieces, some of them at rest. */
static bool collapse(struct column *c, const struct scene *scene, double g, struct status *status)
{
  struct simulation *simulation = NULL;
  struct heap heap = {.kinetic = INFINITY};
  const double unit = sqrt(c->height / g), rest = 2e-4 * g * column_radius;
  const int64_t steps = (int64_t)ceil(0.1 * unit);
  struct advance a = {.interval = (double)steps / unit};
  bool ok = simulation_create(&simulation, scene, status);
  while (ok && (a.count < LEAST || heap.kinetic > rest) && a.count < SAMPLES) {
    ok = simulation_advance(simulation, steps, status) && observe(c, simulation, &heap, status);
    a.front[a.count++] = heap.front;
  }
  if (ok && a.count == SAMPLES) ok = status_fail(status, DELBM_FAILED, "a column does not come to rest");
  if (ok) take_figures(c, &heap, &a, simulation);
  simulation_destroy(simulation);
  return ok;
}

static void use_fluid(struct scene *scene)
{
  const struct loads loads = loads_of(scene);
  scene->coupling.hydraulic_radius = 0.8;
  scene->fluid.zero_flux = true;
  load_set_stiffness(scene, &loads, INFINITY);
}

/* Far beyond the front at the end; in fluid the run-out is shorter. */
static double box_width(const struct column *c)
{
  const double dry = c->width * (3 + (c->aspect < 2 ? 4 * c->aspect : 6 * pow(c->aspect, 0.75)));
  return c->viscosity > 0 ? 0.5 * dry : dry;
}

bool column_run(struct column *c, struct status *status)
{
  const double area = c->discs * M_PI * column_radius * column_radius * (1 + spread * spread / 3);
  c->width = 2 * column_radius * round(sqrt(area / packed / c->aspect) / (2 * column_radius));
  const double height = c->width * c->aspect, speed = c->viscosity > 0 ? wet_speed : dry_speed(c);
  const double fall = height + floor_level(c);
  const double g = dry_speed(c) * dry_speed(c) / (2 * fall), g_released = speed * speed / (2 * fall);
  struct scene scene = common(c, (int)ceil(box_width(c)), (int)(floor_level(c) + 1.5 * height), g_released);
  const bool dry = c->viscosity == 0;
  if (dry) scene_dry(&scene);
  scene.contact.friction = c->friction;
  scene.contact.rolling_friction = c->rolling_friction;
  bool ok = pour(c, g, &scene, status);
  if (ok) {
    add_floor(&scene, c);
    if (dry)
      scene.contact.stiffness = stiffness_of(&scene, speed);
    else
      use_fluid(&scene);
    ok = collapse(c, &scene, g_released * (dry ? 1 : 1 - 1 / density), status);
  }
  scene_clear(&scene);
  return ok;
}
