/* Contacts.
 *
 * The exchange (coupling/exchange.c) precedes this stage: for each disc it has found dV, the change of velocity over
 * the step without contacts, and the response K to an impulse. With the impulse J = (J_x, J_y, J_omega) of its
 * contacts a disc ends the step at V + dV + K J. This stage finds J; stage_motion (sim/motion.h) applies J.
 *
 * List. A contact is a pair of discs, or a disc and a side that is not periodic. The list of a step contains the
 * contacts with a gap below `within`: 1 cell with sub-steps, since two discs below Mach 0.6 approach by less than
 * 0.7 cells in a step; 0 with one sub-step, since the force is then evaluated at the start of the step;
 * cells_area_gap with area by cells. Candidates come from the pair list (pairs.h). Order: pairs by (a, b), then
 * sides by disc, from positions and indices alone.
 *
 * Sub-steps. n sub-steps of length h = 1/n, with n from the stiffest contact of the list (substeps.h). Within the
 * step a disc accelerates at the constant rate dV, contacts apart. The leapfrog, with velocities half a sub-step
 * before positions:
 *   J_k = law(x_k, v_k, (h_last + h)/2),   v' = v + h dV + K sum J_k,   x' = x + h v'.
 * The impulse lasts from the middle of the last sub-step to the middle of this sub-step; with h alone as its
 * duration a change of h gains energy. The final velocity is V + dV + K sum J, as of the solve. With n = 1
 * stage_motion does the same. Area by cells is evaluated once a step: n = 1.
 *
 * State. The states (state.h) of contacts that have acted are saved in the order of the list and are part of a
 * checkpoint.
 *
 * Threads. A contact's impulse is written into the contact by one thread; one thread adds the impulses to the discs
 * in the order of the list; each disc is moved by one thread. So there is no race, and the bits are independent of
 * the number of threads. A list of up to SHORT contacts is processed by one thread, in a region of its own: barriers
 * would cost more. */
#include "contact/contacts.h"

#include "base/memory.h"
#include "contact/cells_area.h"
#include "contact/substeps.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { SHORT = 64, MAX_SUBSTEPS = 1000000 };

struct contact {
  uint32_t a, b; /* discs; b from contact_sides on: a side */
  bool is_new;   /* without saved state */
  double inverse_mass;
  double damping; /* eta */
  double cells_area;
  struct wrench on_a, on_b; /* impulse in this sub-step; on_b: 0 with a side */
  struct contact_state state;
};

static bool allocate_moving(struct contacts *c, size_t discs, struct status *status)
{
  const char *what = "the contacts";
  return (c->moving = memory_allocate(discs, sizeof *c->moving, what, status)) &&
         (c->is_moving = memory_allocate(discs, sizeof *c->is_moving, what, status)) &&
         (c->at.x = memory_allocate(discs, sizeof *c->at.x, what, status)) &&
         (c->at.y = memory_allocate(discs, sizeof *c->at.y, what, status)) &&
         (c->at.vx = memory_allocate(discs, sizeof *c->at.vx, what, status)) &&
         (c->at.vy = memory_allocate(discs, sizeof *c->at.vy, what, status)) &&
         (c->at.omega = memory_allocate(discs, sizeof *c->at.omega, what, status)) &&
         (c->at.angle = memory_allocate(discs, sizeof *c->at.angle, what, status)) &&
         (c->impulse = memory_allocate(discs, sizeof *c->impulse, what, status));
}

bool contacts_create(struct contacts *c, const struct scene *scene, struct contact_needs needs,
                     const struct discs *discs, struct status *status)
{
  const bool cells = needs.pairs && scene->contact.area == AREA_CELLS;
  *c = (struct contacts){.scene = scene,
                         .needs = needs,
                         .law = contact_law_of(scene),
                         .within = cells            ? cells_area_gap
                                   : needs.substeps ? 1
                                                    : 0,
                         .scratch_size = cells ? cells_area_scratch(discs) : 0,
                         .substeps = 1,
                         .max_substeps = 1,
                         .placed = true};
  if (((!needs.pairs && !needs.sides) || allocate_moving(c, discs->count, status)) &&
      (!needs.pairs || pairs_create(&c->pairs, scene, discs, c->within, status)))
    return true;
  contacts_destroy(c);
  return false;
}

void contacts_destroy(struct contacts *c)
{
  pairs_destroy(&c->pairs);
  states_destroy(&c->states);
  void *const arrays[] = {c->list,  c->scratch, c->moving,   c->is_moving, c->at.x,   c->at.y,
                          c->at.vx, c->at.vy,   c->at.omega, c->at.angle,  c->impulse};
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
      store_bytes(store, &c->max_substeps, sizeof c->max_substeps, status) &&
      store_bytes(store, &placed, sizeof placed, status) && states_store(&c->states, discs, store, status);
  c->placed = placed;
  if (stored && !(c->last_substep >= 0 && c->last_substep <= 1))
    return status_fail(status, DELBM_IO, "cannot read %s: a sub-step of %g steps", store->path, c->last_substep);
  return stored;
}

static double inverse_mass(const struct discs *d, uint32_t i)
{
  return d->motion[i] == DISC_FREE ? 1 / d->mass[i] : 0;
}

/* Adds a disc to the moving discs; no effect for a side. */
static void start_moving(struct contacts *c, const struct discs *d, uint32_t i)
{
  if (contact_is_with_side(i) || c->is_moving[i]) return;
  c->is_moving[i] = 1;
  c->moving[c->moving_count++] = i;
  c->at.x[i] = d->x[i];
  c->at.y[i] = d->y[i];
  c->at.vx[i] = d->vx[i];
  c->at.vy[i] = d->vy[i];
  c->at.angle[i] = d->angle[i];
  c->at.omega[i] = d->omega[i];
  c->impulse[i] = (struct wrench){0};
}

/* Adds a contact to the list, with its saved state, which is searched from *at on. */
static bool add_contact(struct contacts *c, const struct discs *d, uint32_t a, uint32_t b, size_t *at,
                        struct status *status)
{
  const double inverse = inverse_mass(d, a) + (contact_is_with_side(b) ? 0 : inverse_mass(d, b));
  if (inverse <= 0) return true;
  if (!memory_grow(&c->list, &c->capacity, c->count + 1, sizeof *c->list, "the contacts", status)) return false;
  const struct contact_state *saved = states_next(&c->states, at, a, b);
  struct contact *contact = &c->list[c->count++];
  *contact = (struct contact){.a = a, .b = b, .is_new = !saved, .inverse_mass = inverse};
  if (saved) contact->state = *saved;
  start_moving(c, d, a);
  start_moving(c, d, b);
  return true;
}

static bool add_pairs(struct contacts *c, const struct discs *d, size_t *at, struct status *status)
{
  const int *size = c->scene->domain.size;
  const bool periodic[2] = {scene_is_periodic(c->scene, 0), scene_is_periodic(c->scene, 1)};
  for (size_t k = 0; k < c->pairs.count; k++) {
    const uint32_t a = c->pairs.pairs[k].a, b = c->pairs.pairs[k].b;
    const double dx = nearest_image(d->x[b] - d->x[a], size[0], periodic[0]);
    const double dy = nearest_image(d->y[b] - d->y[a], size[1], periodic[1]);
    const double near = d->radius[a] + d->radius[b] + c->within;
    if (dx * dx + dy * dy < near * near && !add_contact(c, d, a, b, at, status)) return false;
  }
  return true;
}

static bool add_sides(struct contacts *c, const struct discs *d, size_t *at, struct status *status)
{
  const double nx = c->scene->domain.size[0], ny = c->scene->domain.size[1];
  for (uint32_t i = 0; i < d->count; i++) {
    const double x = d->x[i], y = d->y[i], near = d->radius[i] + c->within;
    const bool clear = (x >= near) & (nx - x >= near) & (y >= near) & (ny - y >= near);
    for (enum side_name side = 0; side < SIDE_COUNT && !clear; side++)
      if (c->scene->domain.side[side].type != SIDE_PERIODIC &&
          scene_distance_to_side(c->scene, side, (const double[2]){x, y}) < near &&
          !add_contact(c, d, i, contact_sides + side, at, status))
        return false;
  }
  return true;
}

/* Makes the list of the step; by one thread. */
static bool make_list(struct contacts *c, struct discs *d, struct status *status)
{
  const size_t bytes = d->count * sizeof(double), threads = (size_t)omp_get_num_threads();
  size_t at = 0;
  memset(d->contact_fx, 0, bytes);
  memset(d->contact_fy, 0, bytes);
  memset(d->contact_torque, 0, bytes);
  for (size_t k = 0; k < c->moving_count; k++) c->is_moving[c->moving[k]] = 0;
  c->moving_count = c->count = 0;
  c->substeps = 1;
  return add_pairs(c, d, &at, status) && (!c->needs.sides || add_sides(c, d, &at, status)) &&
         states_reserve(&c->states, c->count, status) &&
         memory_grow(&c->scratch, &c->scratch_capacity, threads * c->scratch_size, sizeof *c->scratch, "the contacts",
                     status);
}

static bool is_by_cells(const struct contacts *m, const struct contact *c)
{
  return m->scratch_size > 0 && !contact_is_with_side(c->b);
}

/* Prepares a contact for the step; returns its number of sub-steps, at the largest overlap that it may reach in the
 * step. */
static int prepare(const struct contacts *m, const struct discs *d, const struct exchange *e, struct contact *c)
{
  const bool is_placed = c->is_new && m->placed;
  c->damping = contact_damping(&m->law, c->inverse_mass);
  if (is_by_cells(m, c))
    c->cells_area = cells_area(m->scene, d, c->a, c->b, m->scratch + (size_t)omp_get_thread_num() * m->scratch_size);
  if (!is_placed && !m->needs.substeps) return 1;
  struct kinematics k = kinematics_of(m->scene, d, c->a, c->b, &m->at);
  const double overlap = k.overlap.depth;
  if (is_placed) c->state.stored = contact_energy(&m->law, k.overlap.radius, overlap);
  if (!m->needs.substeps) return 1;
  const double reached = fmax(0, overlap) + fmax(0, k.approach_speed);
  kinematics_respond(&k, e, c->a, c->b, 0);
  return substeps_needed(m->scene, contact_spring_at(&m->law, k.overlap.radius, reached).stiffness, c->damping,
                         k.compliance);
}

/* Prepares all contacts; sets the number of sub-steps. */
static void prepare_all(struct contacts *c, const struct discs *d, const struct exchange *e)
{
  int max = 1;
#pragma omp for schedule(static) nowait
  for (size_t k = 0; k < c->count; k++) {
    const int needed = prepare(c, d, e, &c->list[k]);
    if (needed > max) max = needed;
  }
#pragma omp critical(delbm_contacts)
  if (max > c->substeps) c->substeps = max;
#pragma omp barrier
}

/* MAX_SUBSTEPS is the upper bound of the key contact.substeps. */
static void check_substeps(const struct contacts *c, struct team *team)
{
  if (c->substeps <= MAX_SUBSTEPS) return;
  struct status status;
  status_fail(
      &status, DELBM_FAILED,
      "contacts so stiff need %d sub-steps a step, more than %d: use a smaller contact.stiffness, contact.alpha "
      "or contact.damping, or set contact.substeps",
      c->substeps, MAX_SUBSTEPS);
  team_fail(team, &status);
}

/* Sets the impulse of a contact over `duration`, in a sub-step of length h, as wrenches about the bodies' centres. */
static void find_impulse(const struct contacts *m, const struct discs *d, const struct exchange *e, double duration,
                         double h, struct contact *c)
{
  struct kinematics k = kinematics_of(m->scene, d, c->a, c->b, &m->at);
  if (is_by_cells(m, c)) k.overlap.lens.area = c->cells_area;
  if (k.overlap.lens.area > 0) kinematics_respond(&k, e, c->a, c->b, h);
  k.damping = c->damping;
  const struct contact_impulse j = contact_law_impulse(&m->law, &c->state, &k, duration);
  const double fx = j.normal * k.overlap.nx - j.tangential * k.overlap.ny,
               fy = j.normal * k.overlap.ny + j.tangential * k.overlap.nx;
  const double *arm = k.overlap.arm, *offset = k.overlap.offset;
  c->on_a = (struct wrench){-fx, -fy, offset[0] * j.normal - arm[0] * j.tangential};
  if (!contact_is_with_side(c->b)) c->on_b = (struct wrench){fx, fy, -offset[1] * j.normal - arm[1] * j.tangential};
}

static void add_wrench(struct wrench *sum, const struct wrench *w)
{
  sum->fx += w->fx;
  sum->fy += w->fy;
  sum->torque += w->torque;
}

/* Adds the impulses of the sub-step to the discs; by one thread. */
static void add_impulses(struct contacts *m)
{
  for (size_t k = 0; k < m->count; k++) {
    const struct contact *c = &m->list[k];
    add_wrench(&m->impulse[c->a], &c->on_a);
    if (!contact_is_with_side(c->b)) add_wrench(&m->impulse[c->b], &c->on_b);
  }
}

/* Moves disc i through a sub-step of length h. */
static void move_disc(struct contacts *c, const struct exchange *e, struct discs *d, double h, uint32_t i)
{
  struct disc_motions *at = &c->at;
  const struct response *r = &e->response[i];
  const struct wrench *impulse = &c->impulse[i];
  double dv[3];
  d->contact_fx[i] += impulse->fx;
  d->contact_fy[i] += impulse->fy;
  d->contact_torque[i] += impulse->torque;
  response_to(r, (const double[3]){impulse->fx, impulse->fy, impulse->torque}, dv);
  at->vx[i] += h * r->dvx + dv[0];
  at->vy[i] += h * r->dvy + dv[1];
  at->omega[i] += h * r->domega + dv[2];
  at->x[i] += h * at->vx[i];
  at->y[i] += h * at->vy[i];
  at->angle[i] += h * at->omega[i];
  c->impulse[i] = (struct wrench){0};
}

static void save_states(struct contacts *m)
{
  states_clear(&m->states);
  for (size_t k = 0; k < m->count; k++) {
    const struct contact *c = &m->list[k];
    if (c->state.stored > 0 || c->state.impulse > 0) states_add(&m->states, c->a, c->b, &c->state);
  }
  m->placed = false;
  if (m->substeps > m->max_substeps) m->max_substeps = m->substeps;
}

/* The step of the contacts in the list, by all threads of a region. */
static void run_contacts(struct contacts *c, const struct exchange *e, struct discs *d, struct team *team)
{
  prepare_all(c, d, e);
#pragma omp single
  {
    check_substeps(c, team);
    team_decide(team, &c->leave_too_stiff);
  }
  if (c->leave_too_stiff) return;
  const double h = 1.0 / c->substeps;
  for (int n = 0; n < c->substeps; n++) {
    const double duration = 0.5 * (c->last_substep + h);
#pragma omp for schedule(static)
    for (size_t k = 0; k < c->count; k++) find_impulse(c, d, e, duration, h, &c->list[k]);
#pragma omp single
    {
      add_impulses(c);
      c->last_substep = h;
    }
#pragma omp for schedule(static)
    for (size_t k = 0; k < c->moving_count; k++) move_disc(c, e, d, h, c->moving[k]);
  }
#pragma omp single
  save_states(c);
}

bool stage_contact(struct contacts *c, const struct occupation *o, const struct exchange *e, struct discs *d,
                   struct team *team)
{
  if (!c->needs.pairs && !c->needs.sides) return true;
  if (c->needs.pairs && !pairs_update(&c->pairs, o, d, team)) return false;
#pragma omp single
  {
    struct status status;
    if (!make_list(c, d, &status)) {
      team_fail(team, &status);
    } else if (c->count <= SHORT) {
#pragma omp parallel num_threads(1)
      run_contacts(c, e, d, team);
    }
    team_decide(team, &c->leave);
  }
  if (c->leave) return false;
  if (c->count <= SHORT) return true;
  run_contacts(c, e, d, team);
  return !c->leave_too_stiff;
}
