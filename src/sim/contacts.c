#include "sim/contacts.h"

#include "base/memory.h"
#include "contact/lens.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { ALONE = 64 }; /* contacts that one thread follows by itself: barriers would cost more */

static bool allocate_followed(struct contacts *c, size_t discs, struct status *status)
{
  const char *what = "the contacts";
  return (c->followed = memory_allocate(discs, sizeof *c->followed, what, status)) &&
         (c->is_followed = memory_allocate(discs, sizeof *c->is_followed, what, status)) &&
         (c->within.x = memory_allocate(discs, sizeof *c->within.x, what, status)) &&
         (c->within.y = memory_allocate(discs, sizeof *c->within.y, what, status)) &&
         (c->within.vx = memory_allocate(discs, sizeof *c->within.vx, what, status)) &&
         (c->within.vy = memory_allocate(discs, sizeof *c->within.vy, what, status)) &&
         (c->fx = memory_allocate(discs, sizeof *c->fx, what, status)) &&
         (c->fy = memory_allocate(discs, sizeof *c->fy, what, status));
}

bool contacts_create(struct contacts *c, const struct scene *scene, const struct plan *plan, const struct discs *discs,
                     struct status *status)
{
  *c =
      (struct contacts){.scene = scene, .plan = *plan, .law = contact_law_of(scene), .substeps = 1, .most_substeps = 1};
  const bool linked = plan->pairs && scene->contact.search == SEARCH_LINKED_CELL;
  if ((!plan->substeps || allocate_followed(c, discs->count, status)) &&
      (!plan->pairs || overlap_create(&c->pairs, discs->count, status)) &&
      (!linked || linked_cell_create(&c->linked, scene, discs, scene->contact.edge, plan->reach, status)))
    return true;
  contacts_destroy(c);
  return false;
}

void contacts_destroy(struct contacts *c)
{
  overlap_destroy(&c->pairs);
  linked_cell_destroy(&c->linked);
  void *const arrays[] = {c->list,      c->followed,  c->is_followed, c->within.x, c->within.y,
                          c->within.vx, c->within.vy, c->fx,          c->fy};
  for (size_t k = 0; k < sizeof arrays / sizeof arrays[0]; k++) free(arrays[k]);
  *c = (struct contacts){0};
}

bool contacts_store(struct contacts *c, struct store *store, struct status *status)
{
  return store_mark(store, "contacts", status) &&
         store_bytes(store, &c->last_substep, sizeof c->last_substep, status) &&
         store_bytes(store, &c->most_substeps, sizeof c->most_substeps, status);
}

static double inverse_mass(const struct discs *d, uint32_t i)
{
  return d->motion[i] == DISC_FREE ? 1 / d->mass[i] : 0;
}

static double nearest(const struct scene *scene, int axis, double d)
{
  return nearest_image(d, scene->domain.size[axis], scene_is_periodic(scene, axis));
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

static bool add_sides_of(struct contacts *c, const struct discs *d, uint32_t i, double reach, struct status *status)
{
  for (enum side_name side = 0; side < SIDE_COUNT; side++) {
    if (c->scene->domain.side[side].type == SIDE_PERIODIC) continue;
    if (distance_to_side(c->scene, side, d->x[i], d->y[i]) >= d->radius[i] + reach) continue;
    if (!memory_grow(&c->list, &c->capacity, c->count + 1, sizeof *c->list, "the contacts", status)) return false;
    c->list[c->count++] = (struct contact){.a = i, .b = contact_with_side, .side = side};
  }
  return true;
}

static bool add_sides(struct contacts *c, const struct discs *d, struct status *status)
{
  const double reach = c->plan.substeps ? 1 : 0;
  const double nx = c->scene->domain.size[0], ny = c->scene->domain.size[1];
  for (uint32_t i = 0; i < d->count; i++) {
    const double x = d->x[i], y = d->y[i], near = d->radius[i] + reach;
    const bool clear = (x >= near) & (nx - x >= near) & (y >= near) & (ny - y >= near);
    if (!clear && d->motion[i] == DISC_FREE && !add_sides_of(c, d, i, reach, status)) return false;
  }
  return true;
}

/* Lists what the search has found, each contact of discs still to be prepared. */
static bool collect(struct contacts *c, const struct occupation *o, struct discs *d, struct status *status)
{
  memset(d->contact_fx, 0, d->count * sizeof *d->contact_fx);
  memset(d->contact_fy, 0, d->count * sizeof *d->contact_fy);
  for (size_t k = 0; k < c->followed_count; k++) c->is_followed[c->followed[k]] = 0;
  c->followed_count = 0;
  const bool linked = c->scene->contact.search == SEARCH_LINKED_CELL;
  if (c->plan.pairs && !linked && !overlap_join(&c->pairs, o->batches, (size_t)o->band_count, d->count, status))
    return false;
  c->count = c->pairs.count;
  c->substeps = 1;
  return memory_grow(&c->list, &c->capacity, c->count, sizeof *c->list, "the contacts", status) &&
         (!c->plan.walls || add_sides(c, d, status));
}

static void prepare(struct contacts *c, const struct discs *d, size_t k)
{
  struct contact *contact = &c->list[k];
  if (k < c->pairs.count) {
    const struct near_pair *pair = &c->pairs.pairs[k];
    const double dx = nearest(c->scene, 0, d->x[pair->b] - d->x[pair->a]);
    const double dy = nearest(c->scene, 1, d->y[pair->b] - d->y[pair->a]);
    const double near = d->radius[pair->a] + d->radius[pair->b] + c->plan.reach;
    const bool touching = dx * dx + dy * dy < near * near || pair->cells_area > 0;
    *contact = (struct contact){.a = pair->a,
                                .b = pair->b,
                                .inverse_mass = touching ? inverse_mass(d, pair->a) + inverse_mass(d, pair->b) : 0,
                                .cells_area = pair->cells_area};
  } else {
    contact->inverse_mass = inverse_mass(d, contact->a);
  }
  contact->damping = contact_damping(&c->law, contact->inverse_mass);
}

/* A contact's geometry: the lens, the normal from a to what it meets, and the speed at which they close. */
struct meeting {
  struct lens lens;
  double nx, ny, closing;
};

static struct meeting meet_side(const struct scene *scene, const struct contact *c, const struct places *at,
                                double radius)
{
  static const double normal[SIDE_COUNT][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
  const double *n = normal[c->side];
  const double distance = distance_to_side(scene, c->side, at->x[c->a], at->y[c->a]);
  return (struct meeting){lens_of_wall(radius, distance), n[0], n[1], at->vx[c->a] * n[0] + at->vy[c->a] * n[1]};
}

static struct meeting meet(const struct scene *scene, const struct discs *d, const struct contact *c,
                           const struct places *at)
{
  const uint32_t a = c->a, b = c->b;
  if (b == contact_with_side) return meet_side(scene, c, at, d->radius[a]);
  const double dx = nearest(scene, 0, at->x[b] - at->x[a]), dy = nearest(scene, 1, at->y[b] - at->y[a]);
  const double distance = sqrt(dx * dx + dy * dy);
  struct meeting meeting = {.lens = lens_of_discs(d->radius[a], d->radius[b], distance), .nx = 1};
  if (distance > 0) { /* coincident centres are pushed apart along x */
    meeting.nx = dx / distance;
    meeting.ny = dy / distance;
  }
  meeting.closing = (at->vx[a] - at->vx[b]) * meeting.nx + (at->vy[a] - at->vy[b]) * meeting.ny;
  if (scene->contact.area == AREA_CELLS) meeting.lens.area = c->cells_area;
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

/* Sub-steps that a contact needs, at the overlap that it may reach within the step. */
static int substeps_needed(const struct contacts *m, const struct discs *d, const struct exchange *e,
                           const struct contact *c)
{
  if (c->inverse_mass <= 0) return 1;
  const struct meeting at = meet(m->scene, d, c, &(struct places){d->x, d->y, d->vx, d->vy});
  const double ra = d->radius[c->a], rb = c->b == contact_with_side ? INFINITY : d->radius[c->b];
  const double effective = isinf(rb) ? ra : ra * rb / (ra + rb);
  const double advance = fmax(0, at.closing);
  const double chord = fmax(at.lens.chord, sqrt(8 * effective * advance) + at.lens.chord / 2);
  return plan_substeps(m->scene, m->law.stiffness * chord, c->damping, compliance(c, e, &at));
}

/* This thread's part of `count` things; all of them where it works alone. */
struct part {
  size_t from, end;
};

static struct part part_of(size_t count, bool together)
{
  const size_t threads = together ? (size_t)omp_get_num_threads() : 1;
  const size_t thread = together ? (size_t)omp_get_thread_num() : 0;
  return (struct part){count * thread / threads, count * (thread + 1) / threads};
}

static void wait_for_team(bool together)
{
  if (!together) return;
#pragma omp barrier
}

/* All contacts are prepared, and the most sub-steps that one needs are known. */
static void prepare_all(struct contacts *c, const struct discs *d, const struct exchange *e, bool together)
{
  const struct part part = part_of(c->count, together);
  int most = 1;
  for (size_t k = part.from; k < part.end; k++) {
    prepare(c, d, k);
    if (!c->plan.substeps) continue;
    const int needed = substeps_needed(c, d, e, &c->list[k]);
    if (needed > most) most = needed;
  }
#pragma omp critical(delbm_contacts)
  if (most > c->substeps) c->substeps = most;
  wait_for_team(together);
}

/* A step of more sub-steps than a case may ask for would look like a program that hangs. */
static bool check_substeps(const struct contacts *c, struct team *team)
{
  enum { MOST = 1000000 };
  if (c->substeps <= MOST) return true;
  struct status status;
  status_fail(
      &status, DELBM_FAILED,
      "contacts so stiff need %d sub-steps a step, more than %d: use a smaller contact.stiffness, contact.alpha "
      "or contact.damping, or set contact.substeps",
      c->substeps, MOST);
  team_fail(team, &status);
  return false;
}

static void follow_disc(struct contacts *c, const struct discs *d, uint32_t i)
{
  if (i == contact_with_side || c->is_followed[i]) return;
  c->is_followed[i] = 1;
  c->followed[c->followed_count++] = i;
  c->within.x[i] = d->x[i];
  c->within.y[i] = d->y[i];
  c->within.vx[i] = d->vx[i];
  c->within.vy[i] = d->vy[i];
  c->fx[i] = c->fy[i] = 0;
}

/* Whom to follow: where one sub-step is all, nobody. */
static void follow_discs(struct contacts *c, const struct discs *d)
{
  if (c->substeps > c->most_substeps) c->most_substeps = c->substeps;
  for (size_t k = 0; k < c->count && c->substeps > 1; k++) {
    if (c->list[k].inverse_mass <= 0) continue;
    follow_disc(c, d, c->list[k].a);
    follow_disc(c, d, c->list[k].b);
  }
}

static void find_forces(struct contacts *m, const struct discs *d, const struct places *at, bool together)
{
  const struct part part = part_of(m->count, together);
  for (size_t k = part.from; k < part.end; k++) {
    struct contact *c = &m->list[k];
    c->fx = c->fy = 0;
    if (c->inverse_mass <= 0) continue;
    const struct meeting meeting = meet(m->scene, d, c, at);
    const double force = contact_force(&m->law, meeting.lens.area, meeting.closing, c->damping);
    c->fx = force * meeting.nx;
    c->fy = force * meeting.ny;
  }
  wait_for_team(together);
}

/* Adds the forces, times `kick`, to their discs; by one thread. */
static void add_forces(const struct contacts *m, double kick, double *fx, double *fy)
{
  for (size_t k = 0; k < m->count; k++) {
    const struct contact *c = &m->list[k];
    fx[c->a] -= kick * c->fx;
    fy[c->a] -= kick * c->fy;
    if (c->b == contact_with_side) continue;
    fx[c->b] += kick * c->fx;
    fy[c->b] += kick * c->fy;
  }
}

/* One sub-step of length h: its impulses change the velocities, then these the places. */
static void move_followed(struct contacts *c, const struct exchange *e, struct discs *d, double h, bool together)
{
  const struct part part = part_of(c->followed_count, together);
  for (size_t k = part.from; k < part.end; k++) {
    const uint32_t i = c->followed[k];
    const struct response *r = &e->response[i];
    const double jx = c->fx[i], jy = c->fy[i];
    d->contact_fx[i] += jx;
    d->contact_fy[i] += jy;
    c->within.vx[i] += h * r->dvx + (r->xx * jx + r->xy * jy);
    c->within.vy[i] += h * r->dvy + (r->xy * jx + r->yy * jy);
    c->within.x[i] += h * c->within.vx[i];
    c->within.y[i] += h * c->within.vy[i];
    c->fx[i] = c->fy[i] = 0;
  }
  wait_for_team(together);
}

/* The sub-steps: a leapfrog, whose velocities lie half a sub-step before its places. A kick therefore lasts from the
 * middle of the last sub-step to the middle of this one; one of h where h changes would gain energy. */
static void follow(struct contacts *c, const struct exchange *e, struct discs *d, bool together)
{
  const bool first = !together || omp_get_thread_num() == 0, moves = c->substeps > 1;
  const double h = 1.0 / c->substeps;
  const struct places start = {d->x, d->y, d->vx, d->vy};
  if (first) follow_discs(c, d);
  wait_for_team(together);
  for (int k = 0; k < c->substeps; k++) {
    find_forces(c, d, moves ? &c->within : &start, together);
    if (first) {
      add_forces(c, 0.5 * (c->last_substep + h), moves ? c->fx : d->contact_fx, moves ? c->fy : d->contact_fy);
      c->last_substep = h;
    }
    wait_for_team(together);
    if (moves) move_followed(c, e, d, h, together);
  }
}

bool stage_contact(struct contacts *c, const struct occupation *o, const struct exchange *e, struct discs *d,
                   struct team *team)
{
  if (!c->plan.pairs && !c->plan.walls) return true;
  if (c->plan.pairs && c->scene->contact.search == SEARCH_LINKED_CELL &&
      !linked_cell_find(&c->linked, d, &c->pairs, team))
    return false;
#pragma omp single
  {
    struct status status;
    if (!collect(c, o, d, &status)) {
      team_fail(team, &status);
    } else if (c->count <= ALONE) {
      prepare_all(c, d, e, false);
      if (check_substeps(c, team)) follow(c, e, d, false);
    }
    team_decide(team, TEAM_MET);
  }
  if (team->stop[TEAM_MET]) return false;
  if (c->count <= ALONE) return true;
  prepare_all(c, d, e, true);
  if (check_substeps(c, team)) follow(c, e, d, true); /* else all leave at the end of the next stage */
  return true;
}
