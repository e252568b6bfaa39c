#include "api/discs.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

size_t delbm_disc_count(const struct delbm_simulation *s)
{
  return s->scene.particles.count;
}

bool api_has_discs(const struct delbm_simulation *s, size_t first, size_t count, struct status *status)
{
  const size_t all = s->scene.particles.count;
  if (first <= all && count <= all - first) return true;
  return status_fail(status, DELBM_USAGE, "%zu discs from disc %zu on: there are %zu, counted from 0", count, first,
                     all);
}

bool api_allows_motion(const struct delbm_simulation *s, size_t disc, const double velocity[2], double spin,
                       struct status *status)
{
  const struct disc_spec *spec = &s->scene.particles.discs[disc];
  if (!(hypot(velocity[0], velocity[1]) + fabs(spin) * spec->radius <= scene_max_speed))
    return status_fail(status, DELBM_USAGE, "disc %zu: velocity (%g, %g), spin %g: |velocity| + |spin| radius > %g",
                       disc, velocity[0], velocity[1], spin, scene_max_speed);
  if (spec->motion == DISC_FIXED && (velocity[0] != 0 || velocity[1] != 0))
    return status_fail(status, DELBM_USAGE, "disc %zu: velocity (%g, %g) of a fixed disc", disc, velocity[0],
                       velocity[1]);
  return true;
}

static bool allows_state(const struct delbm_simulation *s, size_t disc, const struct delbm_disc_state *state,
                         struct status *status)
{
  const int *size = s->scene.domain.size;
  const double x = state->position[0], y = state->position[1];
  if (!(x >= 0 && x < size[0] && y >= 0 && y < size[1]))
    return status_fail(status, DELBM_USAGE, "disc %zu: centre (%g, %g) outside of the box of %d x %d", disc, x, y,
                       size[0], size[1]);
  if (!isfinite(state->angle)) return status_fail(status, DELBM_USAGE, "disc %zu: angle %g", disc, state->angle);
  return api_allows_motion(s, disc, state->velocity, state->spin, status);
}

struct delbm_disc_state api_disc_state(const struct discs *d, size_t i)
{
  return (struct delbm_disc_state){.position = {d->x[i], d->y[i]},
                                   .velocity = {d->vx[i], d->vy[i]},
                                   .angle = d->angle[i],
                                   .spin = d->omega[i],
                                   .force = {d->fx[i], d->fy[i]},
                                   .torque = d->torque[i],
                                   .contact_force = {d->contact_fx[i], d->contact_fy[i]},
                                   .contact_torque = d->contact_torque[i]};
}

static void set_state(const struct discs *d, size_t i, const struct delbm_disc_state *state)
{
  d->x[i] = state->position[0];
  d->y[i] = state->position[1];
  d->vx[i] = state->velocity[0];
  d->vy[i] = state->velocity[1];
  d->angle[i] = state->angle;
  d->omega[i] = state->spin;
}

static void get_states(const struct delbm_simulation *s, size_t first, size_t count, struct delbm_disc_state *states)
{
  for (size_t k = 0; k < count; k++) states[k] = api_disc_state(simulation_discs(s->simulation), first + k);
}

static void set_states(struct delbm_simulation *s, size_t first, size_t count, const struct delbm_disc_state *states)
{
  for (size_t k = 0; k < count; k++) set_state(simulation_discs(s->simulation), first + k, &states[k]);
}

enum delbm_code delbm_read_discs(const struct delbm_simulation *s, size_t first, size_t count,
                                 struct delbm_disc_state *states, struct delbm_status *out)
{
  struct api_call call;
  const bool good = api_enter(&call, s, out) && api_has_discs(s, first, count, &call.status);
  if (good) get_states(s, first, count, states);
  return api_leave(&call, good);
}

/* Sets the states of the discs, or resets them if memory runs out. */
static bool move(struct delbm_simulation *s, size_t first, size_t count, const struct delbm_disc_state *states,
                 struct status *status)
{
  struct delbm_disc_state *before = memory_allocate(count, sizeof *before, "the discs as they were", status);
  if (!before) return false;
  get_states(s, first, count, before);
  set_states(s, first, count, states);
  const bool moved = simulation_changed(s->simulation, status);
  if (!moved) {
    set_states(s, first, count, before);
    s->lost = !simulation_unchanged(s->simulation);
  }
  free(before);
  return moved;
}

static bool write_discs(struct delbm_simulation *s, size_t first, size_t count, const struct delbm_disc_state *states,
                        struct status *status)
{
  if (!simulation_usable(s->simulation, status) || !api_has_discs(s, first, count, status)) return false;
  for (size_t k = 0; k < count; k++)
    if (!allows_state(s, first + k, &states[k], status)) return false;
  return move(s, first, count, states, status);
}

enum delbm_code delbm_write_discs(struct delbm_simulation *s, size_t first, size_t count,
                                  const struct delbm_disc_state *states, struct delbm_status *out)
{
  struct api_call call;
  const bool good = api_enter(&call, s, out) && write_discs(s, first, count, states, &call.status);
  return api_leave(&call, good);
}
