#include "sim/motion.h"

#include "sim/diagnostics.h"

#include <math.h>

static double into_box(const struct scene *scene, int axis, double at)
{
  const double size = scene->domain.size[axis];
  if (!scene_is_periodic(scene, axis)) return at;
  if (at < 0) at += size;
  return at >= size ? at - size : at;
}

/* The force that holds a light disc goes over to p, the momentum that it holds. */
static void release(struct exchange *e, const struct discs *d, size_t i, const double dv[3], double force[3])
{
  const struct held held = exchange_held(e, d, i);
  const double mass[3] = {held.mass, held.mass, held.inertia};
  for (int k = 0; k < 3 && held.time > 0; k++) {
    double *p = &e->memory[3 * i + (size_t)k];
    const double change = mass[k] * dv[k] - *p / held.time;
    force[k] -= change;
    *p += change;
  }
}

/* New velocity, the forces that made it, new place. */
static void finish_disc(const struct contacts *c, struct exchange *e, struct discs *d, size_t i)
{
  const struct response *r = &e->response[i];
  const struct wrench impulse = {d->contact_fx[i], d->contact_fy[i], d->contact_torque[i]};
  double kick[3], hidden[3] = {0, 0, 0};
  response_to(r, (const double[3]){impulse.fx, impulse.fy, impulse.torque}, kick);
  const double dvx = r->dvx + kick[0], dvy = r->dvy + kick[1], domega = r->domega + kick[2];
  const struct surface_velocity old = {d->vx[i], d->vy[i], d->omega[i]};
  const struct surface_velocity new = {old.vx + dvx, old.vy + dvy, old.omega + domega};
  const bool implicit = e->solve == SOLVE_IMPLICIT;
  if (implicit) exchange_hide(e, i, &impulse, hidden);
  e->surface[i] =
      implicit ? (struct surface_velocity){new.vx - hidden[0], new.vy - hidden[1], new.omega - hidden[2]} : old;

  double force[3];
  exchange_force(&e->gathered[i], e->surface[i].vx, e->surface[i].vy, e->surface[i].omega, force);
  release(e, d, i, (const double[3]){dvx, dvy, domega}, force);
  d->fx[i] = force[0] + (implicit ? d->fluid_mass[i] * dvx : 0);
  d->fy[i] = force[1] + (implicit ? d->fluid_mass[i] * dvy : 0);
  d->torque[i] = force[2] + (implicit ? d->fluid_inertia[i] * domega : 0);

  d->vx[i] = new.vx;
  d->vy[i] = new.vy;
  d->omega[i] = new.omega;
  d->angle[i] += new.omega;
  if (d->motion[i] == DISC_FIXED) return;
  const bool followed = c->substeps > 1 && c->is_followed[i];
  d->x[i] = into_box(c->scene, 0, followed ? c->within.x[i] : d->x[i] + new.vx);
  d->y[i] = into_box(c->scene, 1, followed ? c->within.y[i] : d->y[i] + new.vy);
}

static bool too_fast(const struct discs *d, size_t i)
{
  const double left = diagnostics_fastest - fabs(d->omega[i]) * d->radius[i]; /* for the centre; not finite: too fast */
  return !(left >= 0 && d->vx[i] * d->vx[i] + d->vy[i] * d->vy[i] <= left * left);
}

/* Beyond a side, which holds free discs back as a wall does unless they are too heavy or too fast for it. */
static bool has_left(const struct scene *scene, const struct discs *d, size_t i)
{
  const int *size = scene->domain.size;
  const bool inside = d->x[i] >= 0 && d->x[i] <= size[0] && d->y[i] >= 0 && d->y[i] <= size[1];
  return d->motion[i] == DISC_FREE && !inside;
}

/* False, with the reason, if the disc that came from there cannot go on. */
static bool check_disc(const struct scene *scene, const struct discs *d, size_t i, int64_t step, const double from[2],
                       struct status *status)
{
  if (too_fast(d, i))
    return status_fail(status, DELBM_FAILED,
                       "diverged at step %lld: disc %zu near (%.1f, %.1f) moves at (%g, %g), spin %g: above Mach 0.6",
                       (long long)step, i, from[0], from[1], d->vx[i], d->vy[i], d->omega[i]);
  if (has_left(scene, d, i))
    return status_fail(
        status, DELBM_FAILED,
        "step %lld: disc %zu near (%.1f, %.1f) was pushed out of the box: contact.stiffness, %g, does not "
        "hold it against its weight, its speed or a disc that pushes it",
        (long long)step, i, from[0], from[1], scene->contact.stiffness);
  return true;
}

bool stage_motion(const struct contacts *c, struct exchange *e, struct discs *d, int64_t step, struct team *team)
{
#pragma omp for schedule(static)
  for (size_t i = 0; i < d->count; i++) {
    const double from[2] = {d->x[i], d->y[i]};
    struct status status;
    finish_disc(c, e, d, i);
    if (!check_disc(c->scene, d, i, step, from, &status)) team_fail(team, &status);
  }
#pragma omp single
  team_decide(team, &e->leave_unmoved);
  return !e->leave_unmoved;
}
