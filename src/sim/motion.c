#include "sim/motion.h"

#include "base/memory.h"
#include "contact/lens.h"
#include "sim/diagnostics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const uint32_t no_trial = UINT32_MAX;

bool motion_create(struct motion *m, const struct scene *scene, const struct plan *plan, const struct discs *discs,
                   struct status *status)
{
  *m = (struct motion){.scene = scene, .plan = *plan, .law = contact_law_of(scene), .most_substeps = 1};
  m->trial_of = memory_allocate(discs->count, sizeof *m->trial_of, "the contacts", status);
  const bool linked = plan->pairs && scene->contact.search == SEARCH_LINKED_CELL;
  if (!m->trial_of || (plan->pairs && !overlap_create(&m->pairs, discs->count, status)) ||
      (linked && !linked_cell_create(&m->linked, scene, discs, scene->contact.edge, plan->reach, status))) {
    motion_destroy(m);
    return false;
  }
  for (size_t i = 0; i < discs->count; i++) m->trial_of[i] = no_trial;
  return true;
}

void motion_destroy(struct motion *m)
{
  overlap_destroy(&m->pairs);
  linked_cell_destroy(&m->linked);
  free(m->contacts);
  free(m->trials);
  free(m->trial_of);
  *m = (struct motion){0};
}

bool motion_store(struct motion *m, struct store *store, struct status *status)
{
  return store_mark(store, "motion", status) && store_bytes(store, &m->last_substep, sizeof m->last_substep, status) &&
         store_bytes(store, &m->most_substeps, sizeof m->most_substeps, status);
}

static double inverse_mass(const struct discs *d, uint32_t i)
{
  return d->motion[i] == DISC_FREE ? 1 / d->mass[i] : 0;
}

/* The nearest image's displacement along one axis. */
static double nearest(const struct scene *scene, int axis, double displacement)
{
  const double size = scene->domain.size[axis];
  return scene_is_periodic(scene, axis) ? displacement - size * rint(displacement / size) : displacement;
}

static double distance_to_side(const struct scene *scene, enum side_name side, double x, double y)
{
  switch (side) {
  case SIDE_LEFT:
    return x;
  case SIDE_RIGHT:
    return scene->domain.size[0] - x;
  case SIDE_BOTTOM:
    return y;
  default:
    return scene->domain.size[1] - y;
  }
}

static bool add_contact(struct motion *m, const struct contact *contact, struct status *status)
{
  if (!memory_grow(&m->contacts, &m->contact_capacity, m->contact_count + 1, sizeof *m->contacts, "the contacts",
                   status))
    return false;
  m->contacts[m->contact_count++] = *contact;
  return true;
}

static bool add_pairs(struct motion *m, const struct discs *d, struct status *status)
{
  for (size_t p = 0; p < m->pairs.count; p++) {
    const struct near_pair *pair = &m->pairs.pairs[p];
    const double w = inverse_mass(d, pair->a) + inverse_mass(d, pair->b);
    const double dx = nearest(m->scene, 0, d->x[pair->b] - d->x[pair->a]);
    const double dy = nearest(m->scene, 1, d->y[pair->b] - d->y[pair->a]);
    const double near = d->radius[pair->a] + d->radius[pair->b] + m->plan.reach;
    const bool touching = dx * dx + dy * dy < near * near || pair->cells_area > 0;
    const struct contact contact = {.a = pair->a, .b = pair->b, .inverse_mass = w, .cells_area = pair->cells_area};
    if (w > 0 && touching && !add_contact(m, &contact, status)) return false;
  }
  return true;
}

static bool add_sides(struct motion *m, const struct discs *d, struct status *status)
{
  const double reach = m->plan.substeps ? 1 : 0;
  for (uint32_t i = 0; i < d->count; i++) {
    if (d->motion[i] != DISC_FREE) continue;
    for (enum side_name side = 0; side < SIDE_COUNT; side++) {
      if (m->scene->domain.side[side].type == SIDE_PERIODIC) continue;
      if (distance_to_side(m->scene, side, d->x[i], d->y[i]) >= d->radius[i] + reach) continue;
      const struct contact contact = {.a = i, .b = contact_with_side, .side = side, .inverse_mass = 1 / d->mass[i]};
      if (!add_contact(m, &contact, status)) return false;
    }
  }
  return true;
}

static bool add_trial(struct motion *m, const struct discs *d, uint32_t i, struct status *status)
{
  if (i == contact_with_side || m->trial_of[i] != no_trial) return true;
  if (!memory_grow(&m->trials, &m->trial_capacity, m->trial_count + 1, sizeof *m->trials, "the contacts", status))
    return false;
  m->trial_of[i] = (uint32_t)m->trial_count;
  m->trials[m->trial_count++] = (struct trial){.disc = i, .x = d->x[i], .y = d->y[i], .vx = d->vx[i], .vy = d->vy[i]};
  return true;
}

/* A contact's geometry: the lens, the normal from a to what it meets, and the speed at which they close. */
struct meeting {
  struct lens lens;
  double nx, ny, closing;
};

static struct meeting meet_side(const struct scene *scene, const struct contact *c, const struct trial *a,
                                double radius)
{
  static const double normal[SIDE_COUNT][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
  const double *n = normal[c->side];
  const double distance = distance_to_side(scene, c->side, a->x, a->y);
  return (struct meeting){lens_of_wall(radius, distance), n[0], n[1], a->vx * n[0] + a->vy * n[1]};
}

static struct meeting meet(const struct motion *m, const struct discs *d, const struct contact *c)
{
  const struct trial *a = &m->trials[m->trial_of[c->a]];
  if (c->b == contact_with_side) return meet_side(m->scene, c, a, d->radius[c->a]);
  const struct trial *b = &m->trials[m->trial_of[c->b]];
  const double dx = nearest(m->scene, 0, b->x - a->x), dy = nearest(m->scene, 1, b->y - a->y);
  const double distance = sqrt(dx * dx + dy * dy);
  struct meeting meeting = {.lens = lens_of_discs(d->radius[c->a], d->radius[c->b], distance), .nx = 1};
  if (distance > 0) { /* coincident centres are pushed apart along x */
    meeting.nx = dx / distance;
    meeting.ny = dy / distance;
  }
  meeting.closing = (a->vx - b->vx) * meeting.nx + (a->vy - b->vy) * meeting.ny;
  if (m->scene->contact.area == AREA_CELLS) meeting.lens.area = c->cells_area;
  return meeting;
}

/* Inverse mass of the relative motion along the normal, added mass of the fluid included: what the response says. */
static double compliance(const struct contact *c, const struct exchange *e, const struct meeting *at)
{
  double sum = 0;
  for (int end = 0; end < 2; end++) {
    const uint32_t i = end ? c->b : c->a;
    if (i == contact_with_side) continue;
    const struct response *r = &e->response[i];
    sum += at->nx * at->nx * r->xx + 2 * at->nx * at->ny * r->xy + at->ny * at->ny * r->yy;
  }
  return sum;
}

/* Sub-steps of this step: enough for the stiffest of its contacts, at the overlap that it may reach within the step. */
static int count_substeps(const struct motion *m, const struct discs *d, const struct exchange *e)
{
  int most = 1;
  if (!m->plan.substeps) return most;
  for (size_t k = 0; k < m->contact_count; k++) {
    const struct contact *c = &m->contacts[k];
    const struct meeting at = meet(m, d, c);
    const double ra = d->radius[c->a], rb = c->b == contact_with_side ? INFINITY : d->radius[c->b];
    const double effective = isinf(rb) ? ra : ra * rb / (ra + rb);
    const double advance = fmax(0, at.closing);
    const double chord = fmax(at.lens.chord, sqrt(8 * effective * advance) + at.lens.chord / 2);
    const double damping = contact_damping(&m->law, c->inverse_mass);
    const int needed = plan_substeps(m->scene, m->law.stiffness * chord, damping, compliance(c, e, &at));
    if (needed > most) most = needed;
  }
  return most;
}

static void push(struct motion *m, uint32_t i, double fx, double fy)
{
  if (i == contact_with_side) return;
  struct trial *t = &m->trials[m->trial_of[i]];
  t->fx += fx;
  t->fy += fy;
}

/* One sub-step of length h: forces at the trial places, then velocities, then places: a leapfrog, whose velocities lie
 * half a sub-step before its places. The kick therefore lasts from the middle of the last sub-step to the middle of
 * this one; a kick of h where h changes would gain energy. */
static void substep(struct motion *m, const struct exchange *e, struct discs *d, double h)
{
  const double kick = 0.5 * (m->last_substep + h);
  m->last_substep = h;
  for (size_t k = 0; k < m->contact_count; k++) {
    const struct contact *c = &m->contacts[k];
    const struct meeting at = meet(m, d, c);
    const double force = contact_force(&m->law, at.lens.area, at.closing, c->inverse_mass);
    push(m, c->a, -force * at.nx, -force * at.ny);
    push(m, c->b, force * at.nx, force * at.ny);
  }
  for (size_t k = 0; k < m->trial_count; k++) {
    struct trial *t = &m->trials[k];
    const struct response *r = &e->response[t->disc];
    d->contact_fx[t->disc] += kick * t->fx;
    d->contact_fy[t->disc] += kick * t->fy;
    t->vx += h * r->dvx + kick * (r->xx * t->fx + r->xy * t->fy);
    t->vy += h * r->dvy + kick * (r->xy * t->fx + r->yy * t->fy);
    t->x += h * t->vx;
    t->y += h * t->vy;
    t->fx = t->fy = 0;
  }
}

/* All contacts of the step, from their search to their impulses. */
static bool follow_contacts(struct motion *m, const struct occupation *o, const struct exchange *e, struct discs *d,
                            struct status *status)
{
  for (size_t k = 0; k < m->trial_count; k++) m->trial_of[m->trials[k].disc] = no_trial;
  m->trial_count = m->contact_count = 0;
  memset(d->contact_fx, 0, d->count * sizeof *d->contact_fx);
  memset(d->contact_fy, 0, d->count * sizeof *d->contact_fy);
  const bool linked = m->scene->contact.search == SEARCH_LINKED_CELL;
  if (m->plan.pairs && !linked && !overlap_join(&m->pairs, o->batches, (size_t)o->band_count, d->count, status))
    return false;
  if (m->plan.pairs && !add_pairs(m, d, status)) return false;
  if (m->plan.walls && !add_sides(m, d, status)) return false;
  for (size_t k = 0; k < m->contact_count; k++)
    if (!add_trial(m, d, m->contacts[k].a, status) || !add_trial(m, d, m->contacts[k].b, status)) return false;
  m->substeps = count_substeps(m, d, e);
  if (m->substeps > m->most_substeps) m->most_substeps = m->substeps;
  for (int k = 0; k < m->substeps; k++) substep(m, e, d, 1.0 / m->substeps);
  return true;
}

static double into_box(const struct scene *scene, int axis, double at)
{
  const double size = scene->domain.size[axis];
  if (!scene_is_periodic(scene, axis)) return at;
  if (at < 0) at += size;
  return at >= size ? at - size : at;
}

/* The force that holds a light disc goes over to p, its memory of past acceleration. */
static void release(struct exchange *e, const struct discs *d, size_t i, const double dv[3], double force[3])
{
  const struct held held = exchange_held(e, d, i);
  const double mass[3] = {held.mass, held.mass, held.inertia};
  for (int k = 0; k < 3 && held.time > 0; k++) {
    double *p = &e->memory[3 * i + (size_t)k];
    const double change = dv[k] - *p / held.time;
    force[k] -= mass[k] * change;
    *p += change;
  }
}

/* New velocity, the forces that made it, new place. */
static void finish_disc(const struct motion *m, struct exchange *e, struct discs *d, size_t i)
{
  const struct response *r = &e->response[i];
  const double jx = d->contact_fx[i], jy = d->contact_fy[i];
  const double dvx = r->dvx + r->xx * jx + r->xy * jy;
  const double dvy = r->dvy + r->xy * jx + r->yy * jy;
  const double domega = r->domega + r->xw * jx + r->yw * jy;
  const struct surface_velocity old = {d->vx[i], d->vy[i], d->omega[i]};
  const struct surface_velocity new = {old.vx + dvx, old.vy + dvy, old.omega + domega};
  const bool implicit = e->solve == SOLVE_IMPLICIT;
  e->surface[i] = implicit ? new : old;

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
  const struct trial *followed = m->substeps > 1 && m->trial_of[i] != no_trial ? &m->trials[m->trial_of[i]] : NULL;
  d->x[i] = into_box(m->scene, 0, followed ? followed->x : d->x[i] + new.vx);
  d->y[i] = into_box(m->scene, 1, followed ? followed->y : d->y[i] + new.vy);
}

static bool too_fast(const struct discs *d, size_t i)
{
  const double left = diagnostics_fastest - fabs(d->omega[i]) * d->radius[i]; /* for the centre; not finite: too fast */
  return !(left >= 0 && d->vx[i] * d->vx[i] + d->vy[i] * d->vy[i] <= left * left);
}

void stage_contact(struct motion *m, const struct occupation *o, struct exchange *e, struct discs *d, int64_t step,
                   struct team *team)
{
  struct status status;
  if (m->plan.pairs && m->scene->contact.search == SEARCH_LINKED_CELL) {
    linked_cell_find(&m->linked, d, &m->pairs, team);
    if (team->stop) return;
  }
#pragma omp single
  {
    m->substeps = 1;
    if ((m->plan.pairs || m->plan.walls) && !follow_contacts(m, o, e, d, &status)) team_fail(team, &status);
    team->stop = team->failed;
  }
  if (team->stop) return;
#pragma omp for schedule(static)
  for (size_t i = 0; i < d->count; i++) {
    finish_disc(m, e, d, i);
    if (!too_fast(d, i)) continue;
    status_fail(&status, DELBM_FAILED,
                "diverged at step %lld: disc %zu near (%.1f, %.1f) moves at (%g, %g), spin %g: above Mach 0.6",
                (long long)step, i, o->x[i], o->y[i], d->vx[i], d->vy[i], d->omega[i]);
    team_fail(team, &status);
  }
#pragma omp single
  team->stop = team->failed;
}
