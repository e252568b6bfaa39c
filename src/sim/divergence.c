/* Candidate causes are tested in the order of their weight as evidence. First the state of the run: fluid that
 * cannot leave. Then estimates from the case: discs too light for the explicit solve or too heavy for the fluid, a
 * sudden start, too high a speed, cells too coarse, too small a viscosity. */
#include "sim/divergence.h"

#include "sim/estimate.h"

#include <math.h>
#include <stdio.h>

/* Excess of the mean density above which the box counts as overfull. */
static const double large_excess = 0.1;

/* Fraction of a side blocked by discs within a diameter of it. */
static double part_closed(const struct divergence *of, enum side_name side)
{
  double closed = 0;
  for (size_t i = 0; i < of->discs->count; i++) {
    const double radius = of->discs->hydraulic[i].radius, centre[2] = {of->discs->x[i], of->discs->y[i]};
    if (scene_distance_to_side(of->scene, side, centre) <= 3 * radius) closed += 2 * radius;
  }
  return fmin(1, closed / of->scene->domain.size[!side_axis(side)]);
}

/* The outlet with the largest blocked fraction. */
static enum side_name worst_outlet(const struct divergence *of, double *part)
{
  enum side_name worst = SIDE_COUNT;
  *part = 0;
  for (enum side_name side = 0; side < SIDE_COUNT; side++) {
    const double own = of->scene->domain.side[side].type == SIDE_OUTLET ? part_closed(of, side) : 0;
    if (own > *part) *part = own, worst = side;
  }
  return worst;
}

/* Discs that block an outlet: inflow exceeds outflow, and the pressure rises without bound. */
static bool explain_dam(const struct divergence *of, struct status *status)
{
  const double min_part = 0.5;
  double part;
  const enum side_name outlet = worst_outlet(of, &part);
  if (!(of->excess > large_excess) || part < min_part) return false;
  status_add(status,
             "; the box holds %.0f %% more fluid than at rest, as more enters than leaves: discs may close an outlet "
             "(they lie before %.0f %% of the %s side)",
             100 * of->excess, 100 * part, side_name_text(outlet));
  return true;
}

static bool explain_solve(const struct divergence *of, struct status *status)
{
  const size_t disc = estimate_lightest_explicit(of->scene);
  if (disc == of->scene->particles.count) return false;
  status_add(status,
             "; coupling.solve: explicit-averaged diverges for light discs (disc %zu: density %g), implicit does not",
             disc, of->scene->particles.discs[disc].density);
  return true;
}

static bool explain_load(const struct divergence *of, struct status *status)
{
  for (int axis = 0; axis < 2; axis++) {
    const double part = estimate_load(of->scene, axis);
    if (part < estimate_max_load) continue;
    status_add(status,
               "; the discs weigh %.0f %% of the fluid's pressure on the side below; better: particles.gravity <= %.2g "
               "cells/step^2, and more steps",
               100 * part, fabs(of->scene->particles.gravity[axis]) * estimate_max_load / part);
    return true;
  }
  return false;
}

/* The inlet of the fastest fluid; SIDE_COUNT without any. */
static enum side_name fastest_inlet(const struct scene *scene, double *speed)
{
  enum side_name fastest = SIDE_COUNT;
  *speed = 0;
  for (enum side_name side = 0; side < SIDE_COUNT; side++) {
    const double *u = scene->domain.side[side].velocity, own = hypot(u[0], u[1]);
    if (scene->domain.side[side].type == SIDE_INLET && own > *speed) *speed = own, fastest = side;
  }
  return fastest;
}

/* An inlet into fluid at rest starts a wave of relative density U/c_s across the box; beside discs potential flow
 * has up to twice the speed. Reflections persist for several crossings. */
static bool explain_start(const struct divergence *of, struct status *status)
{
  const double crossings = 4;
  double speed;
  const enum side_name inlet = fastest_inlet(of->scene, &speed);
  if (speed <= scene_advised_speed) return false;
  const int axis = inlet == SIDE_LEFT || inlet == SIDE_RIGHT ? 0 : 1;
  if ((double)of->step > crossings * of->scene->domain.size[axis] * sqrt(3)) return false;
  status_add(
      status,
      "; the inlet on the %s sets fluid at rest in motion at once at Mach %.2g: a wave of that strength crosses the "
      "box%s; better: a lower domain.%s.velocity (<= %g cells/step), or a larger fluid.viscosity",
      side_name_text(inlet), speed * sqrt(3),
      of->discs->count > 0 ? ", and beside discs fluid is up to twice as fast" : "", side_name_text(inlet),
      scene_advised_speed);
  return true;
}

/* Speed reached by a force within the steps done; the advised value of the key is for the whole run. */
static bool explain_speed(const struct divergence *of, const struct estimate *so_far, struct status *status)
{
  if (so_far->speed <= estimate_advised_speed(of->scene)) return false;
  const int64_t steps = of->scene->run.steps > of->step ? of->scene->run.steps : of->step;
  const struct estimate fastest = estimate_fastest(of->scene, steps);
  status_add(status, "; %s leads to speeds of about %.2g cells/step", fastest.key, fastest.speed);
  if (!of->scene->fluid.none) status_add(status, " (Mach %.2g)", fastest.speed * sqrt(3));
  status_add(status, "; better: %s <= %.2g %s", fastest.key, fastest.advised, fastest.unit);
  return true;
}

static bool explain_cells(const struct divergence *of, const struct estimate *fastest, struct status *status)
{
  const double grid_reynolds = fastest->speed / of->scene->fluid.viscosity;
  if (grid_reynolds <= estimate_max_grid_reynolds) return false;
  status_add(
      status,
      "; the grid Reynolds number (of one cell) is %.3g, above %g: the cells are too coarse for the flow; better: "
      "fluid.viscosity >= %.2g",
      grid_reynolds, estimate_max_grid_reynolds, fastest->speed / estimate_max_grid_reynolds);
  return true;
}

/* Distance of the cell's centre from the rim of a disc, nearest image. */
static double gap(const struct divergence *of, size_t disc)
{
  double d[2] = {of->cell[0] + 0.5 - of->discs->x[disc], of->cell[1] + 0.5 - of->discs->y[disc]};
  for (int axis = 0; axis < 2; axis++)
    d[axis] = nearest_image(d[axis], of->scene->domain.size[axis], scene_is_periodic(of->scene, axis));
  return hypot(d[0], d[1]) - of->discs->hydraulic[disc].radius;
}

/* The side nearest to the cell, if within `reach`; SIDE_COUNT: none. */
static enum side_name side_near(const struct divergence *of, double reach)
{
  const double cell[2] = {of->cell[0] + 0.5, of->cell[1] + 0.5};
  for (enum side_name side = 0; side < SIDE_COUNT; side++)
    if (side_kind_of(of->scene->domain.side[side].type)->closed &&
        scene_distance_to_side(of->scene, side, cell) <= reach)
      return side;
  return SIDE_COUNT;
}

/* Fluid squeezed out of a gap h between surfaces that approach at speed U has a speed of about U sqrt(2 R/h). */
static bool explain_squeeze(const struct divergence *of, struct status *status)
{
  const double reach = 3;
  size_t near[2] = {0, 0}, count = 0;
  for (size_t i = 0; i < of->discs->count && of->cell[0] >= 0 && count < 2; i++)
    if (gap(of, i) <= reach) near[count++] = i;
  bool moves = false;
  for (size_t k = 0; k < count; k++) moves |= of->discs->motion[near[k]] != DISC_FIXED;
  if (!moves) return false;
  const enum side_name side = count == 1 ? side_near(of, reach) : SIDE_COUNT;
  if (count == 1 && side == SIDE_COUNT) return false;
  char other[32];
  if (count == 2)
    snprintf(other, sizeof other, "disc %zu", near[1]);
  else
    snprintf(other, sizeof other, "the %s side", side_name_text(side));
  status_add(status,
             "; it lies between disc %zu and %s: fluid leaves a gap of a cell at sqrt(2 R) = %.2g times the speed at "
             "which it closes; better: discs that approach more slowly, or a smaller fluid.viscosity",
             near[0], other, sqrt(2 * of->discs->hydraulic[near[0]].radius));
  return true;
}

static bool explain_viscosity(const struct divergence *of, struct status *status)
{
  const double min_viscosity = (estimate_min_tau - 0.5) / 3;
  if (of->scene->fluid.viscosity >= min_viscosity) return false;
  status_add(status, "; a viscosity of %g hardly damps errors; better: fluid.viscosity >= %g",
             of->scene->fluid.viscosity, min_viscosity);
  return true;
}

static bool explain_excess(const struct divergence *of, struct status *status)
{
  double speed;
  if (fastest_inlet(of->scene, &speed) == SIDE_COUNT || !(of->excess > large_excess)) return false;
  status_add(status, "; the box holds %.0f %% more fluid than at rest, as more enters than leaves", 100 * of->excess);
  return true;
}

void divergence_explain(const struct divergence *of, struct status *status)
{
  const struct estimate fastest = estimate_fastest(of->scene, of->step);
  if (of->scene->fluid.none) {
    explain_speed(of, &fastest, status);
    return;
  }
  if (explain_dam(of, status) || explain_solve(of, status) || explain_load(of, status)) return;
  const bool fast = explain_start(of, status) || explain_speed(of, &fastest, status);
  const bool coarse = explain_cells(of, &fastest, status) || explain_viscosity(of, status);
  if (!fast && !coarse && !explain_squeeze(of, status)) explain_excess(of, status);
}
