/* Discs in slow flow: spin in shear, settling between walls, noise of the force on a disc that crosses cells. */
#include "accuracy.h"

#include "base/memory.h"
#include "steady.h"

#include <math.h>
#include <stdlib.h>

/* A linear shear that is at rest at height `centre`. */
struct shear {
  double rate, centre;
};

static struct flow_state sheared(const void *context, int x, int y)
{
  const struct shear *shear = context;
  (void)x;
  return (struct flow_state){
      .density = 1, .velocity = {shear->rate * (y + 0.5 - shear->centre), 0}, .gradient = {{0, shear->rate}, {0, 0}}};
}

/* A fixed disc near the middle of a square box of `width`, periodic along the walls, whose velocities put the zero
 * of the shear at the disc's centre. Re = shear R^2/nu = 0.01. */
struct sheared_disc {
  int radius, width;
  double x, y, viscosity;
  struct shear shear;
};

/* Torque on the disc at a spin of `spin` times half the shear rate, over 4 pi mu R^2 times half the shear rate. */
static bool shear_torque(const struct sheared_disc *d, const struct accuracy_choice *choice, double spin,
                         double *torque, struct accuracy_outcome *cost, struct status *status)
{
  const int64_t interval = (int64_t)(d->width * d->width / (100 * d->viscosity));
  const double half = d->shear.rate / 2, unit = -half * 4 * M_PI * d->viscosity * d->radius * d->radius;
  struct steady steady = {.enough = 1e-5};
  struct scene scene = accuracy_scene(choice, d->width, d->width, d->viscosity, SIDES_PERIODIC);
  struct simulation *simulation = NULL;
  scene.domain.side[SIDE_BOTTOM] = (struct side){SIDE_WALL, {-d->shear.rate * d->y, 0}};
  scene.domain.side[SIDE_TOP] = (struct side){SIDE_WALL, {d->shear.rate * (d->width - d->y), 0}};
  struct disc_spec *disc = scene_add_disc(&scene, d->radius, 1, d->x, d->y);
  disc->motion = DISC_FIXED;
  disc->spin = -half * spin;
  bool ok = simulation_create(&simulation, &scene, status), known = false;
  if (ok) simulation_start(simulation, sheared, &d->shear);
  while (ok && !known) {
    ok = accuracy_advance(simulation, interval, cost, status);
    known = ok && steady_add(&steady, spin + simulation_discs(simulation)->torque[0] / unit);
  }
  *torque = steady.limit - spin;
  simulation_destroy(simulation);
  scene_clear(&scene);
  return ok;
}

/* The spin at zero torque, over half the shear rate, from the linearity of the torque in the spin. */
static bool shear_spin(const struct accuracy_choice *choice, int radius, int width, const struct offset *offset,
                       double *spin, struct accuracy_outcome *cost, struct status *status)
{
  const int middle = width / 2;
  struct sheared_disc d = {radius, width, middle + offset->x, middle + offset->y, .viscosity = 0.1};
  d.shear = (struct shear){0.01 * d.viscosity / (radius * radius), d.y};
  double at_rest, turning;
  if (!shear_torque(&d, choice, 0, &at_rest, cost, status) || !shear_torque(&d, choice, 1, &turning, cost, status))
    return false;
  *spin = at_rest / (at_rest - turning);
  return true;
}

/* Extrapolated from widths of 6 and 12 R: the effect of walls and images is proportional to 1/width^2, with a rest
 * of 1e-4. */
static bool spin_at(const struct accuracy_choice *choice, int radius, const struct offset *offset, double *deviation,
                    struct accuracy_outcome *cost, struct status *status)
{
  double narrow, wide;
  if (!shear_spin(choice, radius, 6 * radius, offset, &narrow, cost, status) ||
      !shear_spin(choice, radius, 12 * radius, offset, &wide, cost, status))
    return false;
  *deviation = wide + (wide - narrow) / 3 - 1;
  return true;
}

static bool run_spin(void *context, const struct accuracy_choice *choice, int radius, struct accuracy_outcome *outcome,
                     struct status *status)
{
  (void)context;
  return accuracy_over_places(spin_at, choice, radius, outcome, status);
}

const struct accuracy_case accuracy_spin = {
    .name = "spin",
    .error = "spin of a free disc in shear, with d/W -> 0 from 1/3 and 1/6, over half the shear rate, relative",
    .axis = "cells in R",
    .resolution = {2, 4, 8},
    .quick = 1,
    .bound = 0.02,
    .places = PLACES,
    .with_forms = true,
    .run = run_spin};

/* Force per length on a cylinder that moves along the middle of a channel, over mu U (Faxen 1946); k = d/W. */
static double faxen_drag(double k)
{
  const double k2 = k * k;
  return 4 * M_PI / (-log(k) - 0.9157 + k2 * (1.7244 + k2 * (-1.7302 + k2 * (2.4056 - 4.5913 * k2))));
}

/* The disc falls from the middle of a closed box by a few cells, at Re 0.05. Deviations of its velocity are taken at
 * LEVELS heights within the last cell. */
enum { LEVELS = 16 };

static bool fall(const struct accuracy_choice *choice, int radius, int width, double deviation[LEVELS],
                 struct accuracy_outcome *cost, struct status *status)
{
  const double viscosity = 0.1, speed = 0.05 * viscosity / (2 * radius), excess = 0.5;
  const int height = 32 * radius;
  const int64_t steady = (int64_t)(0.6 * width * width / viscosity), level = llround(1 / (LEVELS * speed));
  struct scene scene = accuracy_scene(choice, width, height, viscosity, SIDES_CLOSED);
  struct simulation *simulation = NULL;
  scene.fluid.zero_flux = true;
  scene.particles.gravity[1] =
      -faxen_drag(2.0 * radius / width) * viscosity * speed / (M_PI * radius * radius * excess);
  scene_add_disc(&scene, radius, 1 + excess, width / 2.0, height / 2.0 + 0.3);
  bool ok = simulation_create(&simulation, &scene, status) && accuracy_advance(simulation, steady, cost, status);
  for (int k = 0; ok && k < LEVELS; k++) {
    const double from = simulation_discs(simulation)->y[0];
    ok = accuracy_advance(simulation, level, cost, status);
    deviation[k] = (from - simulation_discs(simulation)->y[0]) / ((double)level * speed) - 1;
  }
  simulation_destroy(simulation);
  scene_clear(&scene);
  return ok;
}

/* The disc's centre is midway between the walls: on a line of cells for an even width, at the centre of cells for an
 * odd width. */
static bool run_settling(void *context, const struct accuracy_choice *choice, int radius,
                         struct accuracy_outcome *outcome, struct status *status)
{
  struct deviations all = {0};
  (void)context;
  for (int odd = 0; odd < 2; odd++) {
    double deviation[LEVELS];
    if (!fall(choice, radius, 8 * radius + odd, deviation, outcome, status)) return false;
    for (int k = 0; k < LEVELS; k++) deviations_add(&all, deviation[k], 1.0 / (2 * LEVELS));
  }
  *outcome = (struct accuracy_outcome){all.error, all.worst, outcome->seconds / 2, outcome->updates / 2};
  return true;
}

const struct accuracy_case accuracy_settling = {
    .name = "settling",
    .error = "velocity of a disc falling between walls 4 diameters apart, Re 0.05, against Faxen 1946, relative",
    .axis = "cells in R",
    .resolution = {2, 4, 8},
    .quick = 1,
    .bound = 0.06,
    .places = 2 * LEVELS,
    .with_forms = true,
    .run = run_settling};

/* A disc and a channel of fluid at relative velocity `speed`. */
struct passage {
  int radius, size;
  double viscosity, speed;
  struct offset start; /* of the disc, from the middle of the channel */
};

static struct flow_state stream(const void *context, int x, int y)
{
  const struct passage *p = context;
  (void)x, (void)y;
  return (struct flow_state){.density = 1, .velocity = {-p->speed, 0}};
}

/* Records the force on the disc in each of `count` steps after `skip`, with the disc driven or the fluid moving. */
static bool record_force(const struct passage *p, const struct accuracy_choice *choice, bool driven, int skip,
                         int count, double *force, struct accuracy_outcome *outcome, struct status *status)
{
  struct scene scene = accuracy_scene(choice, p->size, p->size, p->viscosity, SIDES_PERIODIC);
  const struct side wall = {SIDE_WALL, {driven ? 0 : -p->speed, 0}};
  scene.domain.side[SIDE_BOTTOM] = scene.domain.side[SIDE_TOP] = wall;
  const int middle = p->size / 2;
  struct disc_spec *disc = scene_add_disc(&scene, p->radius, 1, middle + p->start.x, middle + p->start.y);
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

/* Noise of the force on a moving disc: root mean square of the difference over four cells, over the mean force. */
static double noise(const double *moving, const double *resting, int count)
{
  double squares = 0, sum = 0;
  for (int k = 0; k < count; k++) {
    squares += (moving[k] - resting[k]) * (moving[k] - resting[k]);
    sum += resting[k];
  }
  return sqrt(squares / count) / fabs(sum / count);
}

/* The driven disc starts at the position of the fixed disc. */
static bool cross_from(const struct accuracy_choice *choice, int radius, const struct offset *offset, double *deviation,
                       struct accuracy_outcome *cost, struct status *status)
{
  const struct passage p = {radius, 10 * radius, 0.05, 0.1 / radius, *offset}; /* Re 4 */
  const int skip = (int)(p.size * p.size / (20 * p.viscosity)), steps = (int)(4 / p.speed);
  double *force = memory_allocate(2 * (size_t)steps, sizeof *force, "the forces", status);
  const bool ok = force && record_force(&p, choice, true, skip, steps, force, cost, status) &&
                  record_force(&p, choice, false, skip, steps, force + steps, cost, status);
  if (ok) *deviation = noise(force, force + steps, steps);
  free(force);
  return ok;
}

static bool run_crossing(void *context, const struct accuracy_choice *choice, int radius,
                         struct accuracy_outcome *outcome, struct status *status)
{
  (void)context;
  return accuracy_over_places(cross_from, choice, radius, outcome, status);
}

const struct accuracy_case accuracy_crossing = {
    .name = "crossing",
    .error =
        "force on a disc driven across cells at Re 4, against that on a fixed disc in a channel that moves, relative",
    .axis = "cells in R",
    .resolution = {3, 5, 8},
    .quick = 1,
    .bound = 0.012,
    .places = PLACES,
    .with_forms = true,
    .run = run_crossing};
