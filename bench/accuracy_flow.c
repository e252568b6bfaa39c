/* Flows without discs with a solution in closed form. */
#include "accuracy.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

static bool allocate_exact(const struct scene *scene, double *exact[2], struct status *status)
{
  const size_t cells = (size_t)scene_cells(scene);
  exact[0] = memory_allocate(2 * cells, sizeof(double), "the exact velocity", status);
  exact[1] = exact[0] + cells;
  return exact[0] != NULL;
}

/* Advances a flow from `initial` (NULL: rest) and compares it with `exact`. */
static bool compare(const struct scene *scene, flow_initial *initial, const void *context, int64_t steps,
                    double *const exact[2], struct accuracy_outcome *outcome, struct status *status)
{
  struct simulation *simulation = NULL;
  bool ok = simulation_create(&simulation, scene, status);
  if (ok && initial) simulation_start(simulation, initial, context);
  ok = ok && accuracy_advance(simulation, steps, outcome, status) &&
       accuracy_field_error(simulation, exact, &outcome->error, status);
  simulation_destroy(simulation);
  return ok;
}

/* Vortices of 1 x 2 waves in a periodic square; they decay without a change of form. */
struct vortices {
  double kx, ky, speed, viscosity, time;
};

static struct flow_state vortices_at(const void *context, int x, int y)
{
  const struct vortices *v = context;
  const double decay = exp(-v->viscosity * (v->kx * v->kx + v->ky * v->ky) * v->time), speed = v->speed * decay;
  const double ax = v->kx * (x + 0.5), ay = v->ky * (y + 0.5), ratio = v->ky / v->kx;
  const double u = -speed * sqrt(ratio), w = speed / sqrt(ratio);
  return (struct flow_state){.density = 1 - 0.75 * speed * speed * (ratio * cos(2 * ax) + cos(2 * ay) / ratio),
                             .velocity = {u * cos(ax) * sin(ay), w * sin(ax) * cos(ay)},
                             .gradient = {{-u * v->kx * sin(ax) * sin(ay), u * v->ky * cos(ax) * cos(ay)},
                                          {w * v->kx * cos(ax) * cos(ay), -w * v->ky * sin(ax) * sin(ay)}}};
}

/* The speed is proportional to the cell size, so that the compressibility error falls with the discretisation error. */
static bool run_taylor_green(void *context, const struct accuracy_choice *choice, int n,
                             struct accuracy_outcome *outcome, struct status *status)
{
  (void)context;
  const double viscosity = 0.02;
  struct scene scene = accuracy_scene(choice, n, n, viscosity, SIDES_PERIODIC);
  struct vortices v = {2 * M_PI / n, 4 * M_PI / n, 1.28 / n, viscosity, 0};
  const int64_t steps = llround(1 / (viscosity * (v.kx * v.kx + v.ky * v.ky)));
  const struct vortices start = v;
  double *exact[2];
  bool ok = allocate_exact(&scene, exact, status);
  v.time = (double)steps;
  for (int k = 0; ok && k < n * n; k++) {
    const struct flow_state state = vortices_at(&v, k % n, k / n);
    for (int axis = 0; axis < 2; axis++) exact[axis][k] = state.velocity[axis];
  }
  ok = ok && compare(&scene, vortices_at, &start, steps, exact, outcome, status);
  free(exact[0]);
  scene_clear(&scene);
  return ok;
}

const struct accuracy_case accuracy_taylor_green = {
    .name = "taylor-green",
    .error = "velocity against the exact one when it has fallen to 1/e, relative, mean square; Re 64 (1.28 / 0.02)",
    .axis = "cells a side",
    .resolution = {16, 32, 64, 128, 256},
    .quick = 3,
    .bound = 0.03,
    .run = run_taylor_green};

enum { CHANNEL_LENGTH = 4 };

static struct scene channel(const struct accuracy_choice *choice, int height, double viscosity)
{
  struct scene scene = accuracy_scene(choice, CHANNEL_LENGTH, height, viscosity, SIDES_PERIODIC);
  scene.domain.side[SIDE_BOTTOM].type = scene.domain.side[SIDE_TOP].type = SIDE_WALL;
  return scene;
}

/* Advances from rest and compares with profile(y / height) * speed. */
static bool compare_channel(struct scene *scene, int64_t steps, double (*profile)(double), double speed,
                            struct accuracy_outcome *outcome, struct status *status)
{
  const int height = scene->domain.size[1];
  double *exact[2];
  bool ok = allocate_exact(scene, exact, status);
  for (int k = 0; ok && k < CHANNEL_LENGTH * height; k++) {
    const int y = k / CHANNEL_LENGTH;
    exact[0][k] = speed * profile((y + 0.5) / height);
  }
  ok = ok && compare(scene, NULL, NULL, steps, exact, outcome, status);
  free(exact[0]);
  scene_clear(scene);
  return ok;
}

static double parabola(double y)
{
  return 4 * y * (1 - y);
}

static bool run_poiseuille(void *context, const struct accuracy_choice *choice, int height,
                           struct accuracy_outcome *outcome, struct status *status)
{
  (void)context;
  const double viscosity = 0.1, speed = 0.01;
  struct scene scene = channel(choice, height, viscosity);
  scene.fluid.force[0] = 8 * viscosity * speed / (height * height);
  /* the transient has decayed to exp(-3 pi^2) */
  return compare_channel(&scene, (int64_t)(3 * height * height / viscosity), parabola, speed, outcome, status);
}

const struct accuracy_case accuracy_poiseuille = {.name = "poiseuille",
                                                  .error = "steady velocity, relative, mean square; viscosity 0.1",
                                                  .axis = "cells across",
                                                  .resolution = {6, 12, 24, 48},
                                                  .quick = 3,
                                                  .bound = 0.03,
                                                  .run = run_poiseuille};

static const double couette_time = 0.1; /* H^2/nu */

/* Lower wall at rest, upper one moving since time 0. */
static double couette(double y)
{
  double sum = y;
  for (int n = 1; n < 30; n++)
    sum += 2 / (n * M_PI) * (n % 2 ? -1 : 1) * sin(n * M_PI * y) * exp(-n * n * M_PI * M_PI * couette_time);
  return sum;
}

static bool run_couette(void *context, const struct accuracy_choice *choice, int height,
                        struct accuracy_outcome *outcome, struct status *status)
{
  (void)context;
  const double viscosity = 0.1, speed = 0.01;
  struct scene scene = channel(choice, height, viscosity);
  scene.domain.side[SIDE_TOP].velocity[0] = speed;
  return compare_channel(&scene, llround(couette_time * height * height / viscosity), couette, speed, outcome, status);
}

const struct accuracy_case accuracy_couette = {
    .name = "couette",
    .error = "velocity at 0.1 H^2/nu after the wall starts, relative, mean square; viscosity 0.1",
    .axis = "cells across",
    .resolution = {10, 20, 40, 80, 160},
    .quick = 3,
    .bound = 0.004,
    .run = run_couette};
