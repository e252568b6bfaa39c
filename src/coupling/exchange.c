/* The exchange of momentum between fluid and discs, and the inertia of a disc in it.
 *
 * Linear solve. A cell of weight B receives the momentum B (-2 j + 2 rho v) from the solid, j with the force of the
 * step, v the velocity of the solid in the cell: linear in the velocity (V, omega) of the disc. Over the cells of a
 * disc, with b = 2 w_p B and lever arm r, the populations before collision yield
 *   P = sum b j, L = sum b (r x j), M0 = sum b rho, M1 = sum b rho r, M2 = sum b rho |r|^2,
 * and the change of velocity dV = (dVx, dVy, domega) in the step is the solution of
 *   A dV = R,  A = D + M,  D = diag(m - m_f, m - m_f, I - I_f),  R = weight + (P, L) - M V,
 *        | M0    0    -M1y |
 *   M =  | 0     M0    M1x |
 *        | -M1y  M1x   M2  |
 * The sweep then imposes the new velocity and needs no reduction. m_f and I_f, mass and moment of inertia of the
 * fluid that fills the hydraulic shape (solid/discs.h), are subtracted because this fluid moves with the disc and is
 * counted as fluid. The weight is (m - pi R^2) g, with the radius R and not R_h.
 *
 * Contacts. An impulse within one step acts against m - m_f + M0, about m + m_f, in place of m: at B = 1 the fluid
 * inside is reflected about the new velocity, so takes up twice the momentum of a rigid motion and returns the
 * excess one step later. A shorter contact would gain this energy. M0/2 is the inertia of fluid in rigid motion, so
 * impacts act through K with the fraction s = 1/2 of M, and the surface velocity contains only this fraction of the
 * velocity added by impacts. The weight of discs at rest, however, is a steady force and acts through A as gravity
 * does. The steady part is C, the mean contact impulse, which averages the contact impulse J of a step over 100
 * steps:
 *   K^-1 = D + s M,  dV = A^-1 (R + C) + K (J - C),  C' = C + (J - C)/100,  surface: V + dV - (1 - s) K (J - C).
 * s = 1 if D + M/2 is not positive definite (a light disc far inside a wall). With s = 1 everywhere the test
 * impact/in_fluid_without_damping_no_energy_is_gained_at_any_stiffness fails; without C, stability/
 * a_disc_on_the_ground_comes_to_rest_and_the_contact_carries_its_weight.
 *
 * Virtual mass of light discs (cf. Schwarz, Kempe & Froehlich 2015). m_f counts all fluid inside the disc, but only
 * M0/2 accelerates with the disc within a step; the rest, in cells of eps < 1, responds in the time of sound. Below
 * a density of 1 - M0/(2 m_f), 0.1 to 0.3, the inertia within a step, m - m_f + M0/2, is negative, and sound between
 * two discs, or a disc and a side, grows. A virtual mass c raises this inertia to at least 0.15 m_f; the deferred
 * momentum p is returned over a time T:
 *   A = ... + c,  R = ... + p/T,  p' = (1 - 1/T) p + c dV.
 * A steady acceleration is unchanged, with p = T c dV. (m - m_f) V + p is conserved, also when c changes as the disc
 * moves over the cells. Rotation likewise. Deferred momentum drives oscillations: at an angular frequency w with the
 * power c w^2 T/(1 + w^2 T^2) V^2, against the dissipation 4 pi R sqrt(nu w/2) V^2 of the boundary layer; the power
 * is larger for small discs at small viscosity. With T at least (c R_h/m_f)^2/nu, the time of diffusion over the part
 * c/m_f of R_h, the power is at most a fifth of the dissipation (test
 * stability/a_crowd_of_small_light_discs_at_small_viscosity_rises_quietly).
 *
 * Where a side or another disc cuts off part of a light disc, the centroid of its cells is off the disc's centre: M1
 * couples translation and rotation, and the smallest eigenvalue of D + M/2 counts, not its diagonal. m_f also counts
 * fluid beyond the side, and fluid of cells of two owners twice. So the bound of 0.15 grows by a multiple of |M1|/2,
 * which vanishes in free fluid. With 0.15 alone a disc of density 0.1, R = 3, against a wall at viscosity 1
 * oscillates at a period of 5.5 steps, with a growth of 3 % a step.
 *
 * explicit-averaged, for comparison: A = diag(m, m, I), R = weight + mean of the exchange at V over this step and
 * the step before; the surface velocity is V.
 *
 * Without fluid m_f, I_f and all sums are zero: K = diag(1/m, 1/m, 1/I) and dV = (g, 0) for each free disc, set once.
 * Steps and sub-steps are those of the leapfrog: a velocity belongs to the time t - h/2 of a position at t, h the length
 * of the last sub-step, 0 at the start. With sub-steps of one length this is v' = v + h dV, x' = x + h v'; free fall is
 * then the exact parabola, and a disc at rest on a side has the velocity 0. Where the length changes from h_last to h,
 * the first sub-step of the new length accelerates the disc for (h_last + h)/2 in place of h. The difference,
 * (h_last - h)/2 dV, is added at the end of the step, since a disc is free in the step in which the length changes by
 * more than a sub-step (contacts.c: sub-steps begin at a gap of a cell). Without it each bounce under gravity g at the
 * speed U would lose the fraction 2 g/U of the energy (test dry/a_disc_without_damping_bounces_back_to_its_height).
 *
 * Order. The sums are computed in the sweep of the step before, one row behind the sweep, while the row is in cache
 * (sim/flow.c). They are stored per row of each disc and added from the lowest row up, so that the bits are
 * independent of the distribution of rows to threads. Each disc is solved by one thread. */
#include "coupling/exchange.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

/* Minimum of the inertia within a step, in units of m_f and I_f. */
static const double min_inertia = 0.15;

/* Factor of |M1|/(2 sqrt(m_f I_f)) in this minimum. With 1 the smallest eigenvalue is min_inertia; more is needed at sides, since
 * m_f then counts fluid beyond the side: with 3 a disc of R = 8, density 0.01, at rest against a wall diverges at
 * viscosity 10. */
static const double coupled_inertia = 5;

/* Duration of the mean C, in steps: much longer than impacts with an effect of s. */
static const double mean_contact_time = 100;

/* Whether the inertia within a step, m - m_f + M0/2 >= m - m_f, can be below its minimum. */
static bool may_need_virtual_mass(const struct discs *d, size_t i)
{
  return d->motion[i] == DISC_FREE && d->mass[i] < (1 + min_inertia) * d->fluid_mass[i];
}

static bool any_may_need_virtual_mass(const struct exchange *e, const struct discs *d)
{
  if (e->solve != SOLVE_IMPLICIT) return false;
  for (size_t i = 0; i < d->count; i++)
    if (may_need_virtual_mass(d, i)) return true;
  return false;
}

/* Virtual mass c, virtual moment of inertia, and the time T of the return of deferred momentum. */
struct virtual_mass {
  double mass, inertia, time;
};

/* Zero for discs that need none. T is at least the time of sound across four radii, by which the fluid of partly covered
 * cells has responded. */
static struct virtual_mass virtual_mass_of(const struct exchange *e, const struct discs *d, size_t i)
{
  if (!e->deferred || !may_need_virtual_mass(d, i)) return (struct virtual_mass){0};
  const struct gathered *g = &e->gathered[i];
  const double inertia = d->mass[i] - d->fluid_mass[i] + g->m0 / 2;
  const double angular = d->inertia[i] - d->fluid_inertia[i] + g->m2 / 2;
  /* off-diagonal part of D + M/2 in units of m_f and I_f */
  const double coupling = sqrt((g->m1x * g->m1x + g->m1y * g->m1y) / (4 * d->fluid_mass[i] * d->fluid_inertia[i]));
  const double min = min_inertia + coupled_inertia * coupling;
  const double mass = fmax(0, min * d->fluid_mass[i] - inertia);
  const double radius = d->hydraulic[i].radius, depth = mass / d->fluid_mass[i] * radius;
  return (struct virtual_mass){.mass = mass,
                               .inertia = fmax(0, min * d->fluid_inertia[i] - angular),
                               .time = fmax(4 * sqrt(3) * radius, depth * depth / e->viscosity)};
}

/* Without fluid. */
static bool create_dry(struct exchange *e, const struct discs *d, struct status *status)
{
  const char *what = "the motion of the discs";
  if (!(e->response = memory_allocate(d->count, sizeof *e->response, what, status)) ||
      !(e->lag = memory_allocate(d->count, sizeof *e->lag, what, status)))
    return false;
  for (size_t i = 0; i < d->count; i++)
    if (d->motion[i] == DISC_FREE)
      e->response[i] = (struct response){.xx = 1 / d->mass[i],
                                         .yy = 1 / d->mass[i],
                                         .ww = 1 / d->inertia[i],
                                         .impact_fraction = 1,
                                         .dvx = e->gravity[0],
                                         .dvy = e->gravity[1]};
  return true;
}

static bool create_coupled(struct exchange *e, const struct discs *discs, struct status *status)
{
  const char *what = "the exchange";
  return (e->gathered = memory_allocate(discs->count, sizeof *e->gathered, what, status)) &&
         (e->response = memory_allocate(discs->count, sizeof *e->response, what, status)) &&
         (e->surface = memory_allocate(discs->count, sizeof *e->surface, what, status)) &&
         (!any_may_need_virtual_mass(e, discs) ||
          (e->deferred = memory_allocate(3 * discs->count, sizeof *e->deferred, what, status))) &&
         (e->solve != SOLVE_IMPLICIT ||
          (e->mean_contact = memory_allocate(3 * discs->count, sizeof *e->mean_contact, what, status))) &&
         (e->solve == SOLVE_IMPLICIT ||
          (e->last_exchange = memory_allocate(3 * discs->count, sizeof *e->last_exchange, what, status)));
}

bool exchange_create(struct exchange *e, const struct scene *scene, const struct discs *discs, struct status *status)
{
  *e = (struct exchange){.dry = scene->fluid.none,
                         .solve = scene->coupling.solve,
                         .viscosity = scene->fluid.viscosity,
                         .gravity = {scene->particles.gravity[0], scene->particles.gravity[1]}};
  if (e->dry ? create_dry(e, discs, status) : create_coupled(e, discs, status)) return true;
  exchange_destroy(e);
  return false;
}

void exchange_destroy(struct exchange *e)
{
  free(e->gathered);
  free(e->response);
  free(e->surface);
  free(e->last_exchange);
  free(e->deferred);
  free(e->mean_contact);
  free(e->lag);
  *e = (struct exchange){0};
}

bool exchange_store(struct exchange *e, size_t discs, struct store *store, struct status *status)
{
  const size_t bytes = 3 * discs * sizeof(double);
  uint8_t has_last_exchange = e->has_last_exchange; /* a restored byte may not be a valid bool */
  const bool stored = store_mark(store, "exchange", status) &&
                      store_bytes(store, &has_last_exchange, sizeof has_last_exchange, status) &&
                      (!e->last_exchange || store_bytes(store, e->last_exchange, bytes, status)) &&
                      (!e->deferred || store_bytes(store, e->deferred, bytes, status)) &&
                      (!e->lag || store_bytes(store, e->lag, bytes / 3, status)) &&
                      (!e->mean_contact || store_bytes(store, e->mean_contact, bytes, status));
  e->has_last_exchange = has_last_exchange;
  return stored;
}

/* Sums over the rows of a disc, from the lowest up, j with the force of the coming step; b = 2 w_p B. */
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
      const double px = run->jx + gx * run->mass + zx * run->sum_weight;
      g.px += 2 * px;
      g.py += 2 * (run->jy + gy * run->mass + zy * run->sum_weight);
      g.l += 2 * (run->turn + gy * run->mx + zy * run->sx - ry * px);
      g.m0 += 2 * run->mass;
      g.m1x += 2 * run->mx;
      g.m1y += 2 * ry * run->mass;
      g.m2 += 2 * (run->mxx + ry * ry * run->mass);
    }
  return g;
}

/* The exchange (force, torque) on a disc of velocity (vx, vy, omega): (P, L) - M V. */
static void exchange_force(const struct gathered *g, double vx, double vy, double omega, double force[3])
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

/* Inverse of diag(mass, mass, inertia) + fraction M, by elimination of omega: A = [[t, 0, -y], [0, t, x], [-y, x,
 * w]]. False unless A is positive definite. */
static bool invert(const struct gathered *g, double mass, double inertia, double fraction, struct response *inverse)
{
  const double t = mass + fraction * g->m0, w = inertia + fraction * g->m2, x = fraction * g->m1x,
               y = fraction * g->m1y;
  const double schur = w - (x * x + y * y) / t;
  if (!(t > 0 && schur > 0)) return false;
  inverse->ww = 1 / schur;
  inverse->xw = y / t * inverse->ww;
  inverse->yw = -x / t * inverse->ww;
  inverse->xx = 1 / t + y / t * inverse->xw;
  inverse->xy = -x / t * inverse->xw;
  inverse->yy = 1 / t - x / t * inverse->yw;
  inverse->impact_fraction = fraction;
  return true;
}

/* Sets K and the change of velocity without contacts, A^-1 (R + C) - K C. `r`: R on entry, R + C on return. */
static bool respond(struct response *response, const struct gathered *g, double mass, double inertia, double r[3],
                    const double c[3])
{
  double steady[3], contact[3];
  for (int k = 0; k < 3; k++) r[k] += c[k];
  if (!invert(g, mass, inertia, 1, response)) return false;
  response_to(response, r, steady);
  invert(g, mass, inertia, 0.5, response); /* on failure the inverse with s = 1 remains */
  response_to(response, c, contact);
  response->dvx = steady[0] - contact[0];
  response->dvy = steady[1] - contact[1];
  response->domega = steady[2] - contact[2];
  return true;
}

static bool solve_implicit(struct exchange *e, const struct discs *d, size_t i, double weight[2])
{
  double r[3];
  exchange_force(&e->gathered[i], d->vx[i], d->vy[i], d->omega[i], r);
  r[0] += weight[0];
  r[1] += weight[1];
  const struct virtual_mass added = virtual_mass_of(e, d, i);
  if (added.time > 0) {
    const double *p = &e->deferred[3 * i];
    for (int k = 0; k < 3; k++) r[k] += p[k] / added.time;
  }
  return respond(&e->response[i], &e->gathered[i], d->mass[i] - d->fluid_mass[i] + added.mass,
                 d->inertia[i] - d->fluid_inertia[i] + added.inertia, r, &e->mean_contact[3 * i]);
}

static void solve_explicit(struct exchange *e, const struct discs *d, size_t i, double weight[2])
{
  double now[3], r[3];
  exchange_force(&e->gathered[i], d->vx[i], d->vy[i], d->omega[i], now);
  for (int k = 0; k < 3; k++) {
    double *last = &e->last_exchange[3 * i + (size_t)k];
    r[k] = e->has_last_exchange ? 0.5 * (now[k] + *last) : now[k];
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

/* Reports the reason why A of a disc is not positive definite. */
static void report_unsolved(const struct exchange *e, const struct discs *d, size_t i, int64_t step,
                            struct status *status)
{
  const double coupled = e->gathered[i].m0;
  if (coupled >= 0)
    status_fail(
        status, DELBM_FAILED,
        "step %lld: disc %zu at (%g, %g) cannot be coupled: it is too light and too small for the cells it covers "
        "(mass %g, of the fluid that fills it %g, coupled fluid %g); use a larger radius or density",
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
    double weight[2] = {d->buoyant_mass[i] * e->gravity[0], d->buoyant_mass[i] * e->gravity[1]};
    if (e->solve == SOLVE_EXPLICIT_AVERAGED) {
      solve_explicit(e, d, i, weight);
    } else if (!solve_implicit(e, d, i, weight)) {
      struct status status;
      report_unsolved(e, d, i, step, &status);
      team_fail(team, &status);
    }
  }
#pragma omp single
  {
    e->has_last_exchange = true;
    team_decide(team, &e->leave_unsolved);
  }
  return !e->leave_unsolved;
}

/* Difference of disc and surface velocity in an impact, (1 - s) K (J - C). Updates C. */
static void surface_lag(struct exchange *e, size_t i, const double impulse[3], double lag[3])
{
  double *mean = &e->mean_contact[3 * i], impact[3];
  for (int k = 0; k < 3; k++) impact[k] = impulse[k] - mean[k];
  response_to(&e->response[i], impact, lag);
  for (int k = 0; k < 3; k++) {
    lag[k] *= 1 - e->response[i].impact_fraction;
    mean[k] += impact[k] / mean_contact_time;
  }
}

/* Moves the change of p in this step, c dV - p/T, from the force to p. */
static void defer(struct exchange *e, const struct discs *d, size_t i, const double dv[3], double force[3])
{
  const struct virtual_mass added = virtual_mass_of(e, d, i);
  const double mass[3] = {added.mass, added.mass, added.inertia};
  for (int k = 0; k < 3 && added.time > 0; k++) {
    double *p = &e->deferred[3 * i + (size_t)k];
    const double change = mass[k] * dv[k] - *p / added.time;
    force[k] -= change;
    *p += change;
  }
}

/* Adds dV + K J to the velocity. */
static void accelerate(const struct exchange *e, struct discs *d, size_t i, const double impulse[3], double dv[3])
{
  const struct response *r = &e->response[i];
  response_to(r, impulse, dv);
  dv[0] += r->dvx;
  dv[1] += r->dvy;
  dv[2] += r->domega;
  d->vx[i] += dv[0];
  d->vy[i] += dv[1];
  d->omega[i] += dv[2];
}

void exchange_finish(struct exchange *e, struct discs *d, size_t i)
{
  const bool implicit = e->solve == SOLVE_IMPLICIT;
  const struct surface_velocity before = {d->vx[i], d->vy[i], d->omega[i]};
  const double impulse[3] = {d->contact_fx[i], d->contact_fy[i], d->contact_torque[i]};
  double dv[3], lag[3] = {0}, force[3];
  accelerate(e, d, i, impulse, dv);
  if (e->dry) return;
  struct surface_velocity *surface = &e->surface[i];
  *surface = before;
  if (implicit) {
    surface_lag(e, i, impulse, lag);
    *surface = (struct surface_velocity){d->vx[i] - lag[0], d->vy[i] - lag[1], d->omega[i] - lag[2]};
  }
  exchange_force(&e->gathered[i], surface->vx, surface->vy, surface->omega, force);
  defer(e, d, i, dv, force);
  d->fx[i] = force[0] + (implicit ? d->fluid_mass[i] * dv[0] : 0);
  d->fy[i] = force[1] + (implicit ? d->fluid_mass[i] * dv[1] : 0);
  d->torque[i] = force[2] + (implicit ? d->fluid_inertia[i] * dv[2] : 0);
}

void exchange_change_lag(struct exchange *e, struct discs *d, size_t i, double h, double to[2])
{
  const double more = (2 * e->lag[i] - h) / 2, dvx = more * e->response[i].dvx, dvy = more * e->response[i].dvy;
  d->vx[i] += dvx;
  d->vy[i] += dvy;
  to[0] += dvx;
  to[1] += dvy;
  e->lag[i] = h / 2;
}

void exchange_add_momentum(const struct exchange *e, const struct discs *d, size_t i, double momentum[2])
{
  const double mass = d->mass[i] - d->fluid_mass[i];
  if (e->lag) {
    momentum[0] += mass * e->lag[i] * e->response[i].dvx;
    momentum[1] += mass * e->lag[i] * e->response[i].dvy;
  }
  momentum[0] += mass * d->vx[i] + (e->deferred ? e->deferred[3 * i] : 0);
  momentum[1] += mass * d->vy[i] + (e->deferred ? e->deferred[3 * i + 1] : 0);
}

void exchange_add_load(const struct exchange *e, const struct discs *d, size_t i, double load[2])
{
  if (d->motion[i] != DISC_FREE) return;
  for (int axis = 0; axis < 2; axis++) {
    load[axis] += d->buoyant_mass[i] * e->gravity[axis];
    if (e->mean_contact) load[axis] += e->mean_contact[3 * i + (size_t)axis];
  }
}
