/* Discs in slow flow: spin in shear, settling between walls, and what crossing cells does to the force. */
#include "accuracy.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

/* Spin over half the shear rate of a torque-free disc in the middle of a square cell of `width`, periodic along the
 * walls, which move. Slow: Re = shear R^2/nu 0.01. */
static bool shear_spin(const struct accuracy_choice *choice, int radius, int width, double *spin,
                       struct accuracy_outcome *outcome, struct status *status)
{
  const double viscosity = 0.1, shear = 0.01 * viscosity / (radius * radius);
  struct scene scene = accuracy_scene(choice, width, width, viscosity, SIDES_PERIODIC);
  struct simulation *simulation = NULL;
  scene.domain.side[SIDE_BOTTOM] = (struct side){SIDE_WALL, {-shear * width / 2, 0}};
  scene.domain.side[SIDE_TOP] = (struct side){SIDE_WALL, {shear * width / 2, 0}};
  scene_add_disc(&scene, radius, 1, width / 2.0, width / 2.0);
  /* the walls' motion spreads as exp(-4 pi^2 nu t/width^2) */
  const bool ok = simulation_create(&simulation, &scene, status) &&
                  accuracy_advance(simulation, (int64_t)(0.3 * width * width / viscosity), outcome, status);
  if (ok) *spin = -2 * simulation_discs(simulation)->omega[0] / shear;
  simulation_destroy(simulation);
  scene_clear(&scene);
  return ok;
}

/* Two widths, 8 and 16 R: what the walls and the disc's images add goes as 1/width^2. */
static bool run_spin(void *context, const struct accuracy_choice *choice, int radius, struct accuracy_outcome *outcome,
                     struct status *status)
{
  double narrow, wide;
  (void)context;
  if (!shear_spin(choice, radius, 8 * radius, &narrow, outcome, status) ||
      !shear_spin(choice, radius, 16 * radius, &wide, outcome, status))
    return false;
  outcome->error = fabs(wide + (wide - narrow) / 3 - 1);
  return true;
}

const struct accuracy_case accuracy_spin = {
    .name = "spin",
    .error = "spin of a free disc in shear, with d/W -> 0 from 1/4 and 1/8, over half the shear rate, relative",
    .axis = "cells in R",
    .resolution = {2, 4, 8},
    .quick = 2,
    .with_forms = true,
    .run = run_spin};

/* Force per length on a cylinder that moves along the middle of a channel, over mu U (Faxen 1946); k = d/W. */
static double faxen_drag(double k)
{
  const double k2 = k * k;
  return 4 * M_PI / (-log(k) - 0.9157 + k2 * (1.7244 + k2 * (-1.7302 + k2 * (2.4056 - 4.5913 * k2))));
}

/* The disc falls from the middle of a closed box by a few cells, at Re 0.05; the velocity is the mean over the last
 * cell, through which the force varies. */
static bool run_settling(void *context, const struct accuracy_choice *choice, int radius,
                         struct accuracy_outcome *outcome, struct status *status)
{
  const int width = 8 * radius, height = 6 * width;
  const double viscosity = 0.1, speed = 0.05 * viscosity / (2 * radius), excess = 0.5;
  const int64_t steady = (int64_t)(0.4 * width * width / viscosity), cell = llround(1 / speed);
  struct scene scene = accuracy_scene(choice, width, height, viscosity, SIDES_CLOSED);
  struct simulation *simulation = NULL;
  (void)context;
  scene.fluid.zero_flux = true;
  scene.particles.gravity[1] = -faxen_drag(0.25) * viscosity * speed / (M_PI * radius * radius * excess);
  scene_add_disc(&scene, radius, 1 + excess, width / 2.0, height / 2.0 + 0.3);
  bool ok = simulation_create(&simulation, &scene, status) && accuracy_advance(simulation, steady, outcome, status);
  const double from = ok ? simulation_discs(simulation)->y[0] : NAN;
  ok = ok && accuracy_advance(simulation, cell, outcome, status);
  if (ok) outcome->error = fabs((from - simulation_discs(simulation)->y[0]) / ((double)cell * speed) - 1);
  simulation_destroy(simulation);
  scene_clear(&scene);
  return ok;
}

const struct accuracy_case accuracy_settling = {
    .name = "settling",
    .error = "velocity of a disc falling between walls 4 diameters apart, Re 0.05, against Faxen 1946, relative",
    .axis = "cells in R",
    .resolution = {2, 4, 8},
    .quick = 2,
    .with_forms = true,
    .run = run_settling};

/* A disc and a channel full of fluid that pass each other at `speed`. */
struct passage {
  int radius, size;
  double viscosity, speed;
};

static struct flow_state stream(const void *context, int x, int y)
{
  const struct passage *p = context;
  (void)x, (void)y;
  return (struct flow_state){.density = 1, .velocity = {-p->speed, 0}};
}

/* The force on the disc in each of `count` steps after `skip`, the disc driven or the fluid moving. */
static bool follow(const struct passage *p, const struct accuracy_choice *choice, bool driven, int skip, int count,
                   double *force, struct accuracy_outcome *outcome, struct status *status)
{
  struct scene scene = accuracy_scene(choice, p->size, p->size, p->viscosity, SIDES_PERIODIC);
  const struct side wall = {SIDE_WALL, {driven ? 0 : -p->speed, 0}};
  scene.domain.side[SIDE_BOTTOM] = scene.domain.side[SIDE_TOP] = wall;
  struct disc_spec *disc = scene_add_disc(&scene, p->radius, 1, 0.5 * p->size + 0.2, 0.5 * p->size + 0.3);
  struct simulation *simulation = NULL;
  disc->motion = driven ? DISC_DRIVEN : DISC_FIXED;
  if (driven) disc->velocity[0] = p->speed;
  bool ok = simulation_create(&simulation, &scene, status);
  if (ok && !driven) simulation_start(simulation, stream, p);
  ok = ok && accuracy_advance(simulation, skip, outcome, status);
  for (int k = 0; ok && k < count; k++) {
    ok = accuracy_advance(simulation, 1, outcome, status);
    force[k] = simulation_discs(simulation)->fx[0];
  }
  simulation_destroy(simulation);
  scene_clear(&scene);
  return ok;
}

/* What a moving disc feels besides: root mean square of the difference over four cells, over the mean force. */
static double noise(const double *moving, const double *resting, int count)
{
  double squares = 0, sum = 0;
  for (int k = 0; k < count; k++) {
    squares += (moving[k] - resting[k]) * (moving[k] - resting[k]);
    sum += resting[k];
  }
  return sqrt(squares / count) / fabs(sum / count);
}

static bool run_crossing(void *context, const struct accuracy_choice *choice, int radius,
                         struct accuracy_outcome *outcome, struct status *status)
{
  const struct passage p = {radius, 10 * radius, 0.05, 0.1 / radius}; /* Re 4 */
  const int skip = (int)(p.size * p.size / (20 * p.viscosity)), steps = (int)(4 / p.speed);
  double *force = memory_allocate(2 * (size_t)steps, sizeof *force, "the forces", status);
  (void)context;
  const bool ok = force && follow(&p, choice, true, skip, steps, force, outcome, status) &&
                  follow(&p, choice, false, skip, steps, force + steps, outcome, status);
  if (ok) outcome->error = noise(force, force + steps, steps);
  free(force);
  return ok;
}

const struct accuracy_case accuracy_crossing = {
    .name = "crossing",
    .error =
        "force on a disc driven across cells at Re 4, against that on a fixed disc in a channel that moves, relative",
    .axis = "cells in R",
    .resolution = {3, 5, 8},
    .quick = 2,
    .with_forms = true,
    .run = run_crossing};
