#include "coupling/exchange.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

/* The least inertia, of a disc and what follows it at once, in units of m_f and I_f. */
static const double least_inertia = 0.15;

/* By how many times their coupling the inertias of translation and rotation exceed the least: with 1 the least eigenvalue
 * is the least inertia. Fluid that m_f takes out is not there either where a side cuts the disc off, which the rest is for:
 * with 3 a disc of R = 8, density 0.01, diverged at rest against a wall at viscosity 10. */
static const double coupled_inertia = 5;

/* Over which C is a mean, in steps: much longer than an impact to which s matters. */
static const double carried_time = 100;

static bool is_light(const struct discs *d, size_t i)
{
  return d->motion[i] == DISC_FREE && d->mass[i] < (1 + least_inertia) * d->fluid_mass[i];
}

static bool any_light(const struct exchange *e, const struct discs *d)
{
  if (e->solve != SOLVE_IMPLICIT) return false;
  for (size_t i = 0; i < d->count; i++)
    if (is_light(d, i)) return true;
  return false;
}

struct held exchange_held(const struct exchange *e, const struct discs *d, size_t i)
{
  if (!e->memory || !is_light(d, i)) return (struct held){0};
  const struct gathered *g = &e->gathered[i];
  const double inertia = d->mass[i] - d->fluid_mass[i] + g->m0 / 2;
  const double angular = d->inertia[i] - d->fluid_inertia[i] + g->m2 / 2;
  /* off-diagonal part of diag(m - m_f, m - m_f, I - I_f) + M/2 in those units */
  const double coupling = sqrt((g->m1x * g->m1x + g->m1y * g->m1y) / (4 * d->fluid_mass[i] * d->fluid_inertia[i]));
  const double least = least_inertia + coupled_inertia * coupling;
  const double mass = fmax(0, least * d->fluid_mass[i] - inertia);
  const double depth = mass / d->fluid_mass[i] * d->radius[i];
  return (struct held){.mass = mass,
                       .inertia = fmax(0, least * d->fluid_inertia[i] - angular),
                       .time = fmax(4 * sqrt(3) * d->radius[i], depth * depth / e->viscosity)};
}

bool exchange_create(struct exchange *e, const struct scene *scene, const struct discs *discs, struct status *status)
{
  const char *what = "the exchange";
  *e = (struct exchange){.solve = scene->coupling.solve,
                         .viscosity = scene->fluid.viscosity,
                         .gravity = {scene->particles.gravity[0], scene->particles.gravity[1]}};
  if ((e->gathered = memory_allocate(discs->count, sizeof *e->gathered, what, status)) &&
      (e->response = memory_allocate(discs->count, sizeof *e->response, what, status)) &&
      (e->surface = memory_allocate(discs->count, sizeof *e->surface, what, status)) &&
      (!any_light(e, discs) || (e->memory = memory_allocate(3 * discs->count, sizeof *e->memory, what, status))) &&
      (e->solve != SOLVE_IMPLICIT ||
       (e->carried = memory_allocate(3 * discs->count, sizeof *e->carried, what, status))) &&
      (e->solve == SOLVE_IMPLICIT || (e->last = memory_allocate(3 * discs->count, sizeof *e->last, what, status))))
    return true;
  exchange_destroy(e);
  return false;
}

void exchange_destroy(struct exchange *e)
{
  free(e->gathered);
  free(e->response);
  free(e->surface);
  free(e->last);
  free(e->memory);
  free(e->carried);
  *e = (struct exchange){0};
}

bool exchange_store(struct exchange *e, size_t discs, struct store *store, struct status *status)
{
  const size_t bytes = 3 * discs * sizeof(double);
  uint8_t has_last = e->has_last; /* any byte may come back, of which not every one is a bool */
  const bool stored = store_mark(store, "exchange", status) && store_bytes(store, &has_last, sizeof has_last, status) &&
                      (!e->last || store_bytes(store, e->last, bytes, status)) &&
                      (!e->memory || store_bytes(store, e->memory, bytes, status)) &&
                      (!e->carried || store_bytes(store, e->carried, bytes, status));
  e->has_last = has_last;
  return stored;
}

/* What the sweep found of a disc, row by row from the lowest; with the force of the coming step, and b = 2 share. */
static struct gathered add_up(const struct occupation *o, const struct sweep_constants *c, size_t disc)
{
  struct gathered g = {0};
  const double gx = c->force[0], gy = c->force[1], zx = c->uniform[0], zy = c->uniform[1];
  for (int k = 0; k < o->rows[disc]; k++)
    for (int piece = 0; piece < 2; piece++) {
      int y;
      const struct moment_sums *run = occupation_sums(o, disc, k, piece, &y);
      if (!run) continue;
      const double ry = y + 0.5 - o->y[disc];
      const double px = run->jx + gx * run->mass + zx * run->share;
      g.px += 2 * px;
      g.py += 2 * (run->jy + gy * run->mass + zy * run->share);
      g.l += 2 * (run->turn + gy * run->mx + zy * run->sx - ry * px);
      g.m0 += 2 * run->mass;
      g.m1x += 2 * run->mx;
      g.m1y += 2 * ry * run->mass;
      g.m2 += 2 * (run->mxx + ry * ry * run->mass);
    }
  return g;
}

void exchange_force(const struct gathered *g, double vx, double vy, double omega, double force[3])
{
  force[0] = g->px - (g->m0 * vx - g->m1y * omega);
  force[1] = g->py - (g->m0 * vy + g->m1x * omega);
  force[2] = g->l - (g->m1x * vy - g->m1y * vx + g->m2 * omega);
}

void response_to(const struct response *k, const double impulse[3], double dv[3])
{
  dv[0] = k->xx * impulse[0] + k->xy * impulse[1] + k->xw * impulse[2];
  dv[1] = k->xy * impulse[0] + k->yy * impulse[1] + k->yw * impulse[2];
  dv[2] = k->xw * impulse[0] + k->yw * impulse[1] + k->ww * impulse[2];
}

/* Inverse of diag(mass, mass, inertia) + share M, by elimination of omega: A = [[t, 0, -y], [0, t, x], [-y, x, w]]. False
 * unless A is positive definite. */
static bool invert(const struct gathered *g, double mass, double inertia, double share, struct response *inverse)
{
  const double t = mass + share * g->m0, w = inertia + share * g->m2, x = share * g->m1x, y = share * g->m1y;
  const double schur = w - (x * x + y * y) / t;
  if (!(t > 0 && schur > 0)) return false;
  inverse->ww = 1 / schur;
  inverse->xw = y / t * inverse->ww;
  inverse->yw = -x / t * inverse->ww;
  inverse->xx = 1 / t + y / t * inverse->xw;
  inverse->xy = -x / t * inverse->xw;
  inverse->yy = 1 / t - x / t * inverse->yw;
  inverse->share = share;
  return true;
}

/* K, and dV without contacts; r is R, and then R + C. */
static bool respond(struct response *response, const struct gathered *g, double mass, double inertia, double r[3],
                    const double c[3])
{
  double free[3], back[3];
  for (int k = 0; k < 3; k++) r[k] += c[k];
  if (!invert(g, mass, inertia, 1, response)) return false;
  response_to(response, r, free);
  invert(g, mass, inertia, 0.5, response); /* or what stands there remains */
  response_to(response, c, back);
  response->dvx = free[0] - back[0];
  response->dvy = free[1] - back[1];
  response->domega = free[2] - back[2];
  return true;
}

static bool solve_implicit(struct exchange *e, const struct discs *d, size_t i, double weight[2])
{
  double r[3];
  exchange_force(&e->gathered[i], d->vx[i], d->vy[i], d->omega[i], r);
  r[0] += weight[0];
  r[1] += weight[1];
  const struct held held = exchange_held(e, d, i);
  if (held.time > 0) {
    const double *p = &e->memory[3 * i];
    for (int k = 0; k < 3; k++) r[k] += p[k] / held.time;
  }
  return respond(&e->response[i], &e->gathered[i], d->mass[i] - d->fluid_mass[i] + held.mass,
                 d->inertia[i] - d->fluid_inertia[i] + held.inertia, r, &e->carried[3 * i]);
}

void exchange_hide(struct exchange *e, size_t i, const struct wrench *impulse, double hidden[3])
{
  double *carried = &e->carried[3 * i];
  const double impact[3] = {impulse->fx - carried[0], impulse->fy - carried[1], impulse->torque - carried[2]};
  response_to(&e->response[i], impact, hidden);
  for (int k = 0; k < 3; k++) {
    hidden[k] *= 1 - e->response[i].share;
    carried[k] += impact[k] / carried_time;
  }
}

static void solve_explicit(struct exchange *e, const struct discs *d, size_t i, double weight[2])
{
  double now[3], r[3];
  exchange_force(&e->gathered[i], d->vx[i], d->vy[i], d->omega[i], now);
  for (int k = 0; k < 3; k++) {
    double *last = &e->last[3 * i + (size_t)k];
    r[k] = e->has_last ? 0.5 * (now[k] + *last) : now[k];
    *last = now[k];
  }
  r[0] += weight[0];
  r[1] += weight[1];
  e->response[i] = (struct response){.xx = 1 / d->mass[i], .yy = 1 / d->mass[i], .ww = 1 / d->inertia[i]};
  double dv[3];
  response_to(&e->response[i], r, dv);
  e->response[i].dvx = dv[0];
  e->response[i].dvy = dv[1];
  e->response[i].domega = dv[2];
}

/* Why A of a disc cannot be inverted. */
static void say_why(const struct exchange *e, const struct discs *d, size_t i, int64_t step, struct status *status)
{
  const double coupled = e->gathered[i].m0;
  if (coupled >= 0)
    status_fail(
        status, DELBM_FAILED,
        "step %lld: disc %zu at (%g, %g) cannot be coupled: it is too light and too small for the cells it covers "
        "(mass %g, of the fluid it displaces %g, coupled fluid %g); use a larger radius or density",
        (long long)step, i, d->x[i], d->y[i], d->mass[i], d->fluid_mass[i], coupled);
  else
    status_fail(status, DELBM_FAILED,
                "diverged at step %lld: the fluid that disc %zu covers at (%g, %g) has a negative density (%g over its "
                "cells, of which %g is the disc's area)",
                (long long)step, i, d->x[i], d->y[i], coupled / 2, d->fluid_mass[i]);
}

bool stage_exchange(struct exchange *e, const struct sweep_constants *constants, const struct occupation *o,
                    const struct discs *d, int64_t step, struct team *team)
{
#pragma omp for schedule(static)
  for (size_t i = 0; i < d->count; i++) {
    e->gathered[i] = add_up(o, constants, i);
    e->response[i] = (struct response){0};
    if (d->motion[i] != DISC_FREE) continue;
    const double buoyant = d->mass[i] - d->fluid_mass[i];
    double weight[2] = {buoyant * e->gravity[0], buoyant * e->gravity[1]};
    if (e->solve == SOLVE_EXPLICIT_AVERAGED) {
      solve_explicit(e, d, i, weight);
    } else if (!solve_implicit(e, d, i, weight)) {
      struct status status;
      say_why(e, d, i, step, &status);
      team_fail(team, &status);
    }
  }
#pragma omp single
  {
    e->has_last = true;
    team_decide(team, &e->leave_unsolved);
  }
  return !e->leave_unsolved;
}
