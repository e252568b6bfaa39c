#include "sim/estimate.h"

#include <math.h>
#include <stdio.h>

/* Force per density and depth on a cylinder in a stream. */
static double cylinder_drag(double radius, double viscosity, double speed)
{
  const double re = 2 * speed * radius / viscosity;
  const double cd = re < 1 ? 8 * M_PI / (re * log(7.4 / re)) : 1 + 10 * pow(re, -2.0 / 3);
  return cd * speed * speed * radius;
}

double estimate_settling(double radius, double viscosity, double weight)
{
  double low = 0, high = 10;
  for (int k = 0; k < 100; k++) {
    const double speed = (low + high) / 2;
    if (cylinder_drag(radius, viscosity, speed) < weight)
      low = speed;
    else
      high = speed;
  }
  return low;
}

/* K = F/(mu U) of a square array of cylinders at Re = 0 (Sangani & Acrivos 1982). */
static double array_drag(double fraction)
{
  const double f = fraction;
  return 4 * M_PI / (-0.5 * log(f) - 0.738 + f - 0.887 * f * f + 2.038 * f * f * f);
}

/* Mean speed of fluid driven past the fixed discs by a force per unit mass; INFINITY without fixed discs. */
static double past_fixed_discs(const struct scene *scene, double force)
{
  const double cells = (double)scene_cells(scene), viscosity = scene->fluid.viscosity;
  double count = 0, radius = 0, area = 0;
  for (size_t i = 0; i < scene->particles.count; i++) {
    const struct disc_spec *disc = &scene->particles.discs[i];
    if (disc->motion != DISC_FIXED) continue;
    const double own = scene_hydraulic_radius(scene, disc);
    count++;
    radius += own;
    area += M_PI * own * own;
  }
  if (count == 0) return INFINITY;
  const double load = force * cells / count, fraction = fmin(area / cells, 0.7);
  return fmin(load / (array_drag(fraction) * viscosity), estimate_settling(radius / count, viscosity, load));
}

double estimate_forced(const struct scene *scene, int axis, int64_t steps)
{
  const double force = fabs(scene->fluid.force[axis]), height = scene->domain.size[!axis];
  if (!scene_is_periodic(scene, axis) || force == 0) return 0;
  double speed = fmin(force * (double)steps, past_fixed_discs(scene, force));
  const int walls = scene_sticking_sides(scene, !axis); /* two: a parabola between them; one: half of one */
  if (scene_is_closed(scene, !axis) && walls > 0)
    speed = fmin(speed, force * height * height / (2 * walls * walls * scene->fluid.viscosity));
  return speed;
}

double estimate_advised_speed(const struct scene *scene)
{
  return scene->fluid.none ? scene_max_speed : scene_advised_speed;
}

double estimate_fall(const struct scene *scene, const struct disc_spec *disc, int64_t steps, double factor)
{
  double speed[2];
  for (int axis = 0; axis < 2; axis++) {
    const double start = fabs(disc->velocity[axis]), g = factor * fabs(scene->particles.gravity[axis]);
    const bool up = scene->particles.gravity[axis] > 0;
    const enum side_name below = axis == 0 ? (up ? SIDE_RIGHT : SIDE_LEFT) : up ? SIDE_TOP : SIDE_BOTTOM;
    const double height = fmax(0, scene_distance_to_side(scene, below, disc->position) - disc->radius);
    speed[axis] = start + g * (double)steps;
    if (!scene_is_periodic(scene, axis)) speed[axis] = fmin(speed[axis], sqrt(start * start + 2 * g * height));
  }
  return hypot(speed[0], speed[1]);
}

static void consider(struct estimate *fastest, const struct estimate *other)
{
  if (other->speed > fastest->speed) *fastest = *other;
}

static void consider_sides(struct estimate *fastest, const struct scene *scene)
{
  for (int k = 0; k < SIDE_COUNT; k++) {
    const double *u = scene->domain.side[k].velocity;
    struct estimate own = {
        .speed = hypot(u[0], u[1]), .from = "the sides", .advised = scene_advised_speed, .unit = "cells/step"};
    snprintf(own.key, sizeof own.key, "domain.%s.velocity", side_name_text((enum side_name)k));
    consider(fastest, &own);
  }
}

static void consider_disc(struct estimate *fastest, const struct scene *scene, size_t i)
{
  const struct disc_spec *disc = &scene->particles.discs[i];
  const double radius = scene_hydraulic_radius(scene, disc), advised = estimate_advised_speed(scene);
  const double along = hypot(disc->velocity[0], disc->velocity[1]), rim = fabs(disc->spin) * radius;
  struct estimate own = {.speed = along + rim, .from = "the discs", .advised = advised, .unit = "cells/step"};
  snprintf(own.key, sizeof own.key, "particles.discs.%zu.velocity", i);
  if (rim > along) {
    snprintf(own.key, sizeof own.key, "particles.discs.%zu.spin", i);
    own.advised = advised / radius;
    own.unit = "radians/step";
  }
  consider(fastest, &own);
}

static void consider_weight(struct estimate *fastest, const struct scene *scene, const struct disc_spec *disc)
{
  const double *gravity = scene->particles.gravity, viscosity = scene->fluid.viscosity;
  const double buoyant = disc_spec_area(disc) * fabs(disc->density - 1);
  const double weight = buoyant * hypot(gravity[0], gravity[1]), radius = scene_hydraulic_radius(scene, disc);
  if (disc->motion != DISC_FREE || weight == 0) return;
  const struct estimate own = {
      .speed = estimate_settling(radius, viscosity, weight),
      .from = "the discs",
      .key = "particles.gravity",
      .advised = cylinder_drag(radius, viscosity, scene_advised_speed) / buoyant,
      .unit = "cells/step^2",
  };
  consider(fastest, &own);
}

static void consider_fall(struct estimate *fastest, const struct scene *scene, const struct disc_spec *disc,
                          int64_t steps)
{
  const double *gravity = scene->particles.gravity, advised = estimate_advised_speed(scene);
  if (disc->motion != DISC_FREE) return;
  struct estimate own = {.speed = estimate_fall(scene, disc, steps, 1),
                         .from = "the discs",
                         .key = "particles.gravity",
                         .unit = "cells/step^2"};
  if (own.speed <= fastest->speed) return;
  double low = 0, high = 1;
  for (int k = 0; k < 60; k++) {
    const double middle = (low + high) / 2;
    *(estimate_fall(scene, disc, steps, middle) < advised ? &low : &high) = middle;
  }
  own.advised = low * hypot(gravity[0], gravity[1]);
  consider(fastest, &own);
}

static void consider_force(struct estimate *fastest, const struct scene *scene, int axis, int64_t steps)
{
  struct scene weaker = *scene;
  struct estimate own = {
      .speed = estimate_forced(scene, axis, steps), .from = "the force", .key = "fluid.force", .unit = "cells/step^2"};
  if (own.speed <= fastest->speed) return;
  double low = 0, high = fabs(scene->fluid.force[axis]);
  for (int k = 0; k < 60; k++) {
    weaker.fluid.force[axis] = (low + high) / 2;
    if (estimate_forced(&weaker, axis, steps) < scene_advised_speed)
      low = weaker.fluid.force[axis];
    else
      high = weaker.fluid.force[axis];
  }
  own.advised = low;
  consider(fastest, &own);
}

struct estimate estimate_fastest(const struct scene *scene, int64_t steps)
{
  struct estimate fastest = {.from = ""};
  const struct disc_spec *before = NULL;
  consider_sides(&fastest, scene);
  for (size_t i = 0; i < scene->particles.count; i++) {
    const struct disc_spec *disc = &scene->particles.discs[i];
    consider_disc(&fastest, scene, i);
    if (scene->fluid.none)
      consider_fall(&fastest, scene, disc, steps);
    else if (!before || disc->radius != before->radius || disc->density != before->density ||
             disc->motion != before->motion)
      consider_weight(&fastest, scene, disc);
    before = disc;
  }
  for (int axis = 0; axis < 2 && !scene->fluid.none; axis++) consider_force(&fastest, scene, axis, steps);
  return fastest;
}

void estimate_weight(const struct scene *scene, double weight[2])
{
  weight[0] = weight[1] = 0;
  for (size_t i = 0; i < scene->particles.count; i++) {
    const struct disc_spec *disc = &scene->particles.discs[i];
    if (disc->motion != DISC_FREE) continue;
    const double mass = disc_spec_area(disc) * scene_buoyant_density(scene, disc);
    for (int axis = 0; axis < 2; axis++) weight[axis] += mass * scene->particles.gravity[axis];
  }
}

double estimate_load(const struct scene *scene, int axis)
{
  const double pressure = 1.0 / 3;
  double weight[2];
  estimate_weight(scene, weight);
  return scene_is_closed(scene, axis) ? fabs(weight[axis]) / scene->domain.size[!axis] / pressure : 0;
}

size_t estimate_lightest_explicit(const struct scene *scene)
{
  const double min_density = 0.8;
  size_t lightest = scene->particles.count;
  for (size_t i = 0; i < scene->particles.count && scene->coupling.solve == SOLVE_EXPLICIT_AVERAGED; i++) {
    const struct disc_spec *disc = &scene->particles.discs[i];
    if (disc->motion != DISC_FREE || disc->density >= min_density) continue;
    if (lightest == scene->particles.count || disc->density < scene->particles.discs[lightest].density) lightest = i;
  }
  return lightest;
}
