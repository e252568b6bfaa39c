#include "sim/contacts.h"

#include "base/memory.h"

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
         (c->within.omega = memory_allocate(discs, sizeof *c->within.omega, what, status)) &&
         (c->impulse = memory_allocate(discs, sizeof *c->impulse, what, status));
}

bool contacts_create(struct contacts *c, const struct scene *scene, const struct stages *plan,
                     const struct discs *discs, struct status *status)
{
  *c = (struct contacts){
      .scene = scene, .plan = *plan, .law = contact_law_of(scene), .substeps = 1, .most_substeps = 1, .placed = true};
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
  contact_memory_destroy(&c->memory);
  void *const arrays[] = {c->list,      c->followed,  c->is_followed,  c->within.x, c->within.y,
                          c->within.vx, c->within.vy, c->within.omega, c->impulse};
  for (size_t k = 0; k < sizeof arrays / sizeof arrays[0]; k++) free(arrays[k]);
  *c = (struct contacts){0};
}

void contacts_placed(struct contacts *c)
{
  c->placed = true;
}

bool contacts_store(struct contacts *c, size_t discs, struct store *store, struct status *status)
{
  uint8_t placed = c->placed;
  const bool stored =
      store_mark(store, "contacts", status) && store_bytes(store, &c->last_substep, sizeof c->last_substep, status) &&
      store_bytes(store, &c->most_substeps, sizeof c->most_substeps, status) &&
      store_bytes(store, &placed, sizeof placed, status) && contact_memory_store(&c->memory, discs, store, status);
  c->placed = placed;
  if (stored && !(c->last_substep >= 0 && c->last_substep <= 1))
    return status_fail(status, DELBM_IO, "cannot read %s: a sub-step of %g steps", store->path, c->last_substep);
  return stored;
}

static double inverse_mass(const struct discs *d, uint32_t i)
{
  return d->motion[i] == DISC_FREE ? 1 / d->mass[i] : 0;
}

static bool add_sides_of(struct contacts *c, const struct discs *d, uint32_t i, double reach, struct status *status)
{
  for (enum side_name side = 0; side < SIDE_COUNT; side++) {
    if (c->scene->domain.side[side].type == SIDE_PERIODIC) continue;
    if (distance_to_side(c->scene, side, d->x[i], d->y[i]) >= d->radius[i] + reach) continue;
    if (!memory_grow(&c->list, &c->capacity, c->count + 1, sizeof *c->list, "the contacts", status)) return false;
    c->list[c->count++] = (struct contact){.a = i, .b = contact_sides + side};
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
  memset(d->contact_torque, 0, d->count * sizeof *d->contact_torque);
  for (size_t k = 0; k < c->followed_count; k++) c->is_followed[c->followed[k]] = 0;
  c->followed_count = 0;
  const bool linked = c->scene->contact.search == SEARCH_LINKED_CELL;
  if (c->plan.pairs && !linked && !overlap_join(&c->pairs, o->batches, (size_t)o->band_count, d->count, status))
    return false;
  c->count = c->pairs.count;
  c->substeps = 1;
  return memory_grow(&c->list, &c->capacity, c->count, sizeof *c->list, "the contacts", status) &&
         (!c->plan.walls || add_sides(c, d, status)) && contact_memory_reserve(&c->memory, c->count, status);
}

/* Of a pair that the search has found. */
static struct contact contact_of(const struct near_pair *pair)
{
  return (struct contact){.a = pair->a, .b = pair->b, .cells_area = pair->cells_area};
}

/* A spring holds 2/5 of its force times the overlap. */
static double energy_held(const struct contacts *m, const struct contact *c, double area)
{
  return 0.4 * m->law.stiffness * area * lens_small_overlap(c->small, area);
}

static double overlap_that_holds(const struct contacts *m, const struct contact *c, double energy)
{
  return pow(energy / (0.4 * m->law.stiffness * c->small), 0.4);
}

/* Sub-steps that a contact needs, at the overlap that it may reach within the step. */
static int substeps_needed(const struct contacts *m, const struct contact *c, const struct exchange *e,
                           const struct meeting *at)
{
  const bool cells = m->scene->contact.area == AREA_CELLS && !contact_is_with_side(c);
  const double chord = cells ? lens_small_chord(c->small, lens_small_overlap(c->small, at->lens.area)) : at->lens.chord;
  const double most = fmax(chord, lens_small_chord(c->small, fmax(0, at->closing)) + chord / 2);
  return plan_substeps(m->scene, m->law.stiffness * most, c->damping, meeting_compliance(at, c, e));
}

/* Readies a contact, whose account is looked for from *memory on, and returns the sub-steps that it needs. */
static int prepare(struct contacts *m, const struct discs *d, const struct exchange *e, struct contact *c,
                   size_t *memory)
{
  const bool side = contact_is_with_side(c);
  const struct meeting at = meeting_of(m->scene, d, c, &(struct places){d->x, d->y, d->vx, d->vy, d->omega});
  const double reach = d->radius[c->a] + (side ? 0 : d->radius[c->b]) + m->plan.reach;
  if (!side && at.distance >= reach && c->cells_area <= 0) return 1;
  c->inverse_mass = inverse_mass(d, c->a) + (side ? 0 : inverse_mass(d, c->b));
  if (c->inverse_mass <= 0) return 1;
  c->damping = contact_damping(&m->law, c->inverse_mass);
  c->small = lens_small(d->radius[c->a], side ? INFINITY : d->radius[c->b]);
  const struct contact_account *account = contact_memory_walk(&m->memory, memory, c->a, c->b);
  if (account)
    c->account = *account;
  else if (m->placed)
    c->account.stored = energy_held(m, c, at.lens.area);
  account_settle(&c->account, at.closing);
  return m->plan.substeps ? substeps_needed(m, c, e, &at) : 1;
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
  size_t memory = 0;
  int most = 1;
  for (size_t k = part.from; k < part.end; k++) {
    struct contact *contact = &c->list[k];
    if (k < c->pairs.count) *contact = contact_of(&c->pairs.pairs[k]);
    if (k == part.from) memory = contact_memory_seek(&c->memory, contact->a, contact->b);
    const int needed = prepare(c, d, e, contact, &memory);
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
  if (c->is_followed[i]) return;
  c->is_followed[i] = 1;
  c->followed[c->followed_count++] = i;
  c->within.x[i] = d->x[i];
  c->within.y[i] = d->y[i];
  c->within.vx[i] = d->vx[i];
  c->within.vy[i] = d->vy[i];
  c->within.omega[i] = d->omega[i];
  c->impulse[i] = (struct wrench){0};
}

/* Whom to follow: where one sub-step is all, nobody. */
static void follow_discs(struct contacts *c, const struct discs *d)
{
  if (c->substeps > c->most_substeps) c->most_substeps = c->substeps;
  for (size_t k = 0; k < c->count && c->substeps > 1; k++) {
    const struct contact *contact = &c->list[k];
    if (contact->inverse_mass <= 0) continue;
    follow_disc(c, d, contact->a);
    if (!contact_is_with_side(contact)) follow_disc(c, d, contact->b);
  }
}

/* In sub-steps the area by cells is followed as that of a lens, from the overlap that the cells say, but from no more than
 * what the contact has taken allows: cells that come into play at once would throw stiff discs apart. */
static void follow_cells(const struct contacts *m, const struct discs *d, struct contact *c)
{
  const struct meeting at = meeting_of(m->scene, d, c, &(struct places){d->x, d->y, d->vx, d->vy, d->omega});
  const double overlap = lens_small_overlap(c->small, c->cells_area);
  c->touch = c->cells_area > 0 ? at.distance + fmin(overlap, overlap_that_holds(m, c, c->account.stored))
                               : fmin(at.distance, d->radius[c->a] + d->radius[c->b]);
}

static void follow_all_cells(struct contacts *m, const struct discs *d, bool together)
{
  const struct part part = part_of(m->count, together);
  for (size_t k = part.from; k < part.end; k++)
    if (m->list[k].inverse_mass > 0 && !contact_is_with_side(&m->list[k])) follow_cells(m, d, &m->list[k]);
}

/* Impulses of a contact, `normal` along and `tangential` across (counter-clockwise of) its normal, which b receives and a
 * returns, as wrenches about their centres. */
static void apply(struct contact *c, const struct meeting *at, double normal, double tangential)
{
  const double fx = normal * at->nx - tangential * at->ny, fy = normal * at->ny + tangential * at->nx;
  c->on_a = (struct wrench){-fx, -fy, -at->arm[0] * tangential};
  if (!contact_is_with_side(c)) c->on_b = (struct wrench){fx, fy, -at->arm[1] * tangential};
}

/* The impulse of a contact that presses over `kick`, in a sub-step of length h. */
static void press(const struct contacts *m, const struct exchange *e, const struct meeting *at, double kick, double h,
                  struct contact *c)
{
  struct contact_account *account = &c->account;
  const double mean = at->closing + 0.5 * h * meeting_gain(at, c, e);
  const double most = account_most(account, mean, meeting_compliance(at, c, e), kick * c->damping);
  account->closing = at->closing;
  account->spring = fmin(kick * m->law.stiffness * at->lens.area, most);
  account->impulse = fmin(kick * contact_force(&m->law, at->lens.area, at->closing, c->damping), most);
  apply(c, at, account->impulse, 0);
}

static void find_impulses(struct contacts *m, const struct discs *d, const struct exchange *e, const struct places *at,
                          double kick, double h, bool together)
{
  const struct part part = part_of(m->count, together);
  for (size_t k = part.from; k < part.end; k++) {
    struct contact *c = &m->list[k];
    c->on_a = c->on_b = (struct wrench){0};
    if (c->inverse_mass <= 0) continue;
    const struct meeting meeting = meeting_of(m->scene, d, c, at);
    account_settle(&c->account, meeting.closing);
    if (meeting.lens.area > 0)
      press(m, e, &meeting, kick, h, c);
    else
      c->account.stored = 0;
  }
  wait_for_team(together);
}

static void add_wrench(struct wrench *sum, const struct wrench *w)
{
  sum->fx += w->fx;
  sum->fy += w->fy;
  sum->torque += w->torque;
}

static void add_to_disc(struct discs *d, uint32_t i, const struct wrench *w)
{
  d->contact_fx[i] += w->fx;
  d->contact_fy[i] += w->fy;
  d->contact_torque[i] += w->torque;
}

/* Adds the impulses to their discs, or with sub-steps to those of the sub-step; by one thread. */
static void add_impulses(struct contacts *m, struct discs *d, bool substeps)
{
  for (size_t k = 0; k < m->count; k++) {
    const struct contact *c = &m->list[k];
    const int ends = contact_is_with_side(c) ? 1 : 2;
    for (int end = 0; end < ends && c->inverse_mass > 0; end++) {
      const uint32_t i = end ? c->b : c->a;
      const struct wrench *w = end ? &c->on_b : &c->on_a;
      if (substeps)
        add_wrench(&m->impulse[i], w);
      else
        add_to_disc(d, i, w);
    }
  }
}

/* One sub-step of length h: its impulses change the velocities, then these the places. */
static void move_followed(struct contacts *c, const struct exchange *e, struct discs *d, double h, bool together)
{
  const struct part part = part_of(c->followed_count, together);
  for (size_t k = part.from; k < part.end; k++) {
    const uint32_t i = c->followed[k];
    const struct response *r = &e->response[i];
    const struct wrench *impulse = &c->impulse[i];
    double dv[3];
    add_to_disc(d, i, impulse);
    response_to(r, (const double[3]){impulse->fx, impulse->fy, impulse->torque}, dv);
    c->within.vx[i] += h * r->dvx + dv[0];
    c->within.vy[i] += h * r->dvy + dv[1];
    c->within.omega[i] += h * r->domega + dv[2];
    c->within.x[i] += h * c->within.vx[i];
    c->within.y[i] += h * c->within.vy[i];
    c->impulse[i] = (struct wrench){0};
  }
  wait_for_team(together);
}

/* Of the contacts that have pressed, what the next step goes on from; by one thread. */
static void remember(struct contacts *m)
{
  contact_memory_clear(&m->memory);
  for (size_t k = 0; k < m->count; k++) {
    const struct contact *c = &m->list[k];
    if (c->account.stored > 0 || c->account.impulse > 0) contact_memory_add(&m->memory, c->a, c->b, &c->account);
  }
  m->placed = false;
}

/* The sub-steps: a leapfrog, whose velocities lie half a sub-step before its places. A kick therefore lasts from the
 * middle of the last sub-step to the middle of this one; one of h where h changes would gain energy. */
static void follow(struct contacts *c, const struct exchange *e, struct discs *d, bool together)
{
  const bool first = !together || omp_get_thread_num() == 0, moves = c->substeps > 1;
  const double h = 1.0 / c->substeps;
  const struct places start = {d->x, d->y, d->vx, d->vy, d->omega};
  if (moves && c->scene->contact.area == AREA_CELLS) follow_all_cells(c, d, together);
  if (first) follow_discs(c, d);
  wait_for_team(together);
  for (int k = 0; k < c->substeps; k++) {
    find_impulses(c, d, e, moves ? &c->within : &start, 0.5 * (c->last_substep + h), h, together);
    if (first) {
      add_impulses(c, d, moves);
      c->last_substep = h;
    }
    wait_for_team(together);
    if (moves) move_followed(c, e, d, h, together);
  }
  if (first) remember(c);
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
    team_decide(team, &c->leave);
  }
  if (c->leave) return false;
  if (c->count <= ALONE) return true;
  prepare_all(c, d, e, true);
  if (check_substeps(c, team)) follow(c, e, d, true); /* else all leave at the end of the next stage */
  return true;
}
