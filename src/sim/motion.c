#include "sim/motion.h"

#include "sim/diagnostics.h"

#include <math.h>
#include <stdio.h>

static double into_box(const struct scene *scene, int axis, double at)
{
  const double size = scene->domain.size[axis];
  if (!scene_is_periodic(scene, axis)) return at;
  if (at < 0) at += size;
  return at >= size ? at - size : at;
}

/* Sets the new velocity, position and angle. */
static void move_disc(const struct contacts *c, struct exchange *e, struct discs *d, size_t i)
{
  exchange_finish(e, d, i);
  double to[3] = {d->x[i] + d->vx[i], d->y[i] + d->vy[i], d->angle[i] + d->omega[i]};
  const bool by_substeps = contacts_moved(c, i, to);
  d->angle[i] = to[2];
  if (d->motion[i] == DISC_FIXED) return;
  if (e->lag) exchange_change_lag(e, d, i, by_substeps ? 1.0 / c->substeps : 1, to);
  d->x[i] = into_box(c->scene, 0, to[0]);
  d->y[i] = into_box(c->scene, 1, to[1]);
}

static bool too_fast(const struct discs *d, size_t i)
{
  const double max = diagnostics_speed_limit - fabs(d->omega[i]) * d->radius[i]; /* of the centre; NAN: too fast */
  return !(max >= 0 && d->vx[i] * d->vx[i] + d->vy[i] * d->vy[i] <= max * max);
}

/* True for the centre of a free disc beyond a side: its weight or speed is too large for the contact stiffness. */
static bool has_left(const struct scene *scene, const struct discs *d, size_t i)
{
  const int *size = scene->domain.size;
  const bool inside = d->x[i] >= 0 && d->x[i] <= size[0] && d->y[i] >= 0 && d->y[i] <= size[1];
  return d->motion[i] == DISC_FREE && !inside;
}

/* Reports the speed of disc i. */
static bool fail_too_fast(const struct scene *scene, const struct discs *d, size_t i, int64_t step,
                          const double from[2], struct status *status)
{
  char limit[64];
  if (scene->fluid.none)
    snprintf(limit, sizeof limit, "%.3g cells/step, beyond which contacts may be missed", diagnostics_speed_limit);
  else
    snprintf(limit, sizeof limit, "Mach 0.6");
  return status_fail(status, DELBM_FAILED,
                     "diverged at step %lld: disc %zu near (%.1f, %.1f) moves at (%g, %g), spin %g: above %s",
                     (long long)step, i, from[0], from[1], d->vx[i], d->vy[i], d->omega[i], limit);
}

/* Fails if disc i, previously at `from`, is too fast or outside of the box. */
static bool check_disc(const struct scene *scene, const struct discs *d, size_t i, int64_t step, const double from[2],
                       struct status *status)
{
  if (too_fast(d, i)) return fail_too_fast(scene, d, i, step, from, status);
  if (has_left(scene, d, i))
    return status_fail(
        status, DELBM_FAILED,
        "step %lld: disc %zu near (%.1f, %.1f) was pushed out of the box: contact.stiffness, %g, does not "
        "balance its weight, its speed or a disc that pushes it",
        (long long)step, i, from[0], from[1], scene->contact.stiffness);
  return true;
}

bool stage_motion(const struct contacts *c, struct exchange *e, struct discs *d, int64_t step, struct team *team)
{
#pragma omp for schedule(static)
  for (size_t i = 0; i < d->count; i++) {
    const double from[2] = {d->x[i], d->y[i]};
    struct status status;
    move_disc(c, e, d, i);
    if (!check_disc(c->scene, d, i, step, from, &status)) team_fail(team, &status);
  }
#pragma omp single
  team_decide(team, &e->leave_unmoved);
  return !e->leave_unmoved;
}
