/* Contacts.
 *
 * The exchange (coupling/exchange.c) precedes this stage: for each disc it has found dV, the change of velocity over
 * the step without contacts, and the response K to an impulse. With the impulse J = (J_x, J_y, J_omega) of its
 * contacts a disc ends the step at V + dV + K J. This stage finds J; stage_motion (sim/motion.h) applies J.
 *
 * Table (table.h). When the pair list is built anew, so is the table of contacts: an entry for each pair of the list,
 * and for each disc beside a side that is not periodic. In a step only near entries act, with a gap below `within`: 1
 * cell with sub-steps, since two discs below Mach 0.6 approach by less than 0.7 cells in a step; 0 with one sub-step,
 * since the force is then evaluated at the start of the step; cells_area_gap with area by cells. Near entries follow from
 * positions alone, so results are independent of the steps in which the list is built.
 *
 * Sub-steps. n sub-steps of length h = 1/n, with n from the stiffest near entry (substeps.h). Within the step a disc
 * accelerates at the constant rate dV, contacts apart. The leapfrog, with velocities half a sub-step before positions:
 *   J_k = law(x_k, v_k, (h_last + h)/2),   v' = v + h dV + K sum J_k,   x' = x + h v'.
 * The impulse lasts from the middle of the last sub-step to the middle of this sub-step; with h alone as its
 * duration a change of h gains energy. The final velocity is V + dV + K sum J, as of the solve. With n = 1
 * stage_motion does the same. Area by cells is evaluated once a step: n = 1.
 *
 * State. The states (state.h) of contacts that act are kept in the table, taken over by the next table, and part of a
 * checkpoint.
 *
 * Threads. The impulses of a block of the table are computed by one thread (contact_block.c). Then each disc adds the
 * impulses of its entries, in the order of the table, and is moved by one thread. So there is no race, and the bits are
 * independent of the number of threads. A table of up to SHORT blocks is processed by one thread, in a region of its own:
 * barriers would cost more. */
#include "contact/contacts.h"

#include "base/memory.h"
#include "contact/cells_area.h"
#include "contact/substeps.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { SHORT = 2, MAX_SUBSTEPS = 1000000 };

static bool allocate_motions(struct contacts *c, size_t discs, struct status *status)
{
  const char *what = "the contacts";
  return (c->is_moving = memory_allocate(discs, sizeof *c->is_moving, what, status)) &&
         (c->at.x = memory_allocate(discs, sizeof *c->at.x, what, status)) &&
         (c->at.y = memory_allocate(discs, sizeof *c->at.y, what, status)) &&
         (c->at.vx = memory_allocate(discs, sizeof *c->at.vx, what, status)) &&
         (c->at.vy = memory_allocate(discs, sizeof *c->at.vy, what, status)) &&
         (c->at.omega = memory_allocate(discs, sizeof *c->at.omega, what, status)) &&
         (c->at.angle = memory_allocate(discs, sizeof *c->at.angle, what, status));
}

static struct lubrication lubrication_of(const struct scene *scene)
{
  return (struct lubrication){.viscosity = scene->fluid.viscosity,
                              .cutoff = scene->contact.lubrication.cutoff,
                              .least_gap = scene->contact.lubrication.least_gap};
}

/* Gap from which two bodies cannot touch in the coming step. */
static double touch_gap(struct contact_needs needs, bool cells)
{
  return cells ? cells_area_gap : needs.substeps ? 1 : 0;
}

static bool allocate(struct contacts *c, const struct discs *discs, struct status *status)
{
  return (!c->needs.substeps || allocate_motions(c, discs->count, status)) &&
         (!contacts_lubricate(c) ||
          (c->films = memory_allocate(discs->count, sizeof *c->films, "the contacts", status))) &&
         table_create(&c->table, discs->count, status) &&
         pairs_create(&c->pairs, c->scene, discs, c->needs.pairs, c->within, status);
}

bool contacts_create(struct contacts *c, const struct scene *scene, struct contact_needs needs,
                     const struct discs *discs, struct status *status)
{
  const bool cells = needs.pairs && scene->contact.area == AREA_CELLS;
  *c = (struct contacts){.scene = scene,
                         .needs = needs,
                         .law = contact_law_of(scene),
                         .kernel = contact_kernel_find(scene->fluid.kernel),
                         .lubrication = lubrication_of(scene),
                         .within = fmax(touch_gap(needs, cells), scene->contact.lubrication.cutoff),
                         .scratch_size = cells ? cells_area_scratch(discs) : 0,
                         .substeps = 1,
                         .max_substeps = 1,
                         .placed = true};
  if ((!needs.pairs && !needs.sides) || allocate(c, discs, status)) return true;
  contacts_destroy(c);
  return false;
}

void contacts_destroy(struct contacts *c)
{
  pairs_destroy(&c->pairs);
  table_destroy(&c->table);
  states_destroy(&c->saved);
  void *const arrays[] = {c->scratch, c->films, c->is_moving, c->at.x,    c->at.y,
                          c->at.vx,   c->at.vy, c->at.omega,  c->at.angle};
  for (size_t k = 0; k < sizeof arrays / sizeof arrays[0]; k++) free(arrays[k]);
  *c = (struct contacts){0};
}

void contacts_placed(struct contacts *c)
{
  c->placed = true;
}

/* Copies the states from the table to `saved`. */
static bool save_states(struct contacts *c, struct status *status)
{
  return !c->table_is_current || table_states(&c->table, &c->saved, status);
}

bool contacts_store(struct contacts *c, size_t discs, struct store *store, struct status *status)
{
  uint8_t placed = c->placed;
  if (store->saving && !save_states(c, status)) return false;
  const bool stored =
      store_mark(store, "contacts", status) && store_bytes(store, &c->last_substep, sizeof c->last_substep, status) &&
      store_bytes(store, &c->max_substeps, sizeof c->max_substeps, status) &&
      store_bytes(store, &c->max_overlap, sizeof c->max_overlap, status) &&
      store_bytes(store, &placed, sizeof placed, status) && states_store(&c->saved, discs, store, status);
  c->placed = placed;
  if (!store->saving) {
    c->table_is_current = false;
    c->pairs.stale = true;
  }
  if (stored && !(c->last_substep >= 0 && c->last_substep <= 1))
    return status_fail(status, DELBM_IO, "cannot read %s: a sub-step of %g steps", store->path, c->last_substep);
  if (stored && !(c->max_overlap >= 0 && isfinite(c->max_overlap)))
    return status_fail(status, DELBM_IO, "cannot read %s: an overlap of %g radii", store->path, c->max_overlap);
  return stored;
}

/* True if the stored energy has to limit impulses: with areas by cells, a fixed number of sub-steps below the automatic one,
 * or a damper that dissipates less than ten times the error of the sub-steps. Over N sub-steps a contact gains or loses up to
 * about 1/N^2 of its energy; the damper dissipates 2 pi eta_0 of it. */
static bool needs_limit(const struct contacts *c)
{
  const struct scene *scene = c->scene;
  const double n = scene->contact.steps_per_contact;
  const bool too_few = scene->contact.substeps > 0 && scene->contact.substeps < substeps_automatic(scene);
  return c->scratch_size > 0 || too_few || 2 * M_PI * c->law.damping * n * n < 10;
}

/* Builds the table anew; by one thread. */
static bool build_table(struct contacts *c, struct discs *d, struct status *status)
{
  const size_t bytes = d->count * sizeof(double), threads = (size_t)omp_get_num_threads();
  if (!save_states(c, status) || !table_build(&c->table, c->scene, d, &c->pairs, &c->saved, status) ||
      !memory_grow(&c->scratch, &c->scratch_capacity, threads * c->scratch_size, sizeof *c->scratch, "the contacts",
                   status))
    return false;
  c->table.has_spin = c->law.friction > 0 || c->law.rolling_friction > 0 || contacts_lubricate(c) ||
                      (d->count > 0 && !d->shape[0].kind->round);
  c->table.limited = needs_limit(c);
  c->table_is_current = true;
  memset(d->contact_fx, 0, bytes);
  memset(d->contact_fy, 0, bytes);
  memset(d->contact_torque, 0, bytes);
  if (c->is_moving) memset(c->is_moving, 0, d->count);
  return true;
}

static struct contact_pass pass_of(struct contacts *c, const struct exchange *e, struct discs *d)
{
  return (struct contact_pass){.table = &c->table,
                               .scene = c->scene,
                               .law = &c->law,
                               .kind = d->shape[0].kind,
                               .response = e->response,
                               .at = {d->x, d->y, d->angle, d->vx, d->vy, d->omega},
                               .within = c->within,
                               .moved = c->last_substep,
                               .h = 1,
                               .duration = 0.5 * (c->last_substep + 1),
                               .has_cells = c->scratch_size > 0,
                               .lubrication = contacts_lubricate(c) ? &c->lubrication : NULL,
                               .films = c->films};
}

/* The near entries of a block, with areas by cells, and the energy of new contacts of placed discs. */
static void select_near(struct contacts *c, const struct contact_pass *pass, const struct discs *d, size_t block)
{
  struct contact_table *t = &c->table;
  c->kernel->select(pass, block);
  if (!c->placed && (!pass->has_cells || table_is_of_sides(t, block))) return;
  for (int k = 0; k < t->near_count[block]; k++) {
    const size_t e = table_first(block) + t->near[table_first(block) + (size_t)k];
    const bool side = contact_is_with_side(t->b[e]);
    if (pass->has_cells && !side)
      t->cells_area[e] =
          cells_area(c->scene, d, t->a[e], t->b[e], c->scratch + (size_t)omp_get_thread_num() * c->scratch_size);
    if (c->placed && t->limited && !t->live[e]) {
      const double radius[2] = {t->radius[0][e], t->radius[1][e]};
      t->stored[e] = contact_energy(&c->law, radius, table_depth(t, c->scene, d, e));
    }
  }
}

/* Sum of the resistances of the films of each disc, in the order of the table. */
static void sum_films(struct contacts *c, const struct contact_pass *pass)
{
  const struct contact_table *t = &c->table;
#pragma omp for schedule(static)
  for (size_t block = 0; block < t->blocks; block++) c->kernel->films(pass, block);
#pragma omp for schedule(static)
  for (size_t m = 0; m < t->members; m++) {
    double sum = 0;
    for (size_t k = t->first[m]; k < t->first[m + 1]; k++) sum += t->film[t->end[k] / 2];
    c->films[t->member[m]] = sum;
  }
}

/* MAX_SUBSTEPS is the upper bound of the key contact.substeps. */
static void set_substeps(struct contacts *c, struct team *team)
{
  struct status status;
  c->substeps = substeps_needed(c->scene, &c->rates);
  if (c->substeps > MAX_SUBSTEPS) {
    status_fail(
        &status, DELBM_FAILED,
        "contacts so stiff need %d sub-steps a step, more than %d: use a smaller contact.stiffness, contact.alpha "
        "or contact.damping, or set contact.substeps",
        c->substeps, MAX_SUBSTEPS);
    team_fail(team, &status);
  } else if (c->substeps > c->max_substeps) {
    c->max_substeps = c->substeps;
  }
  team_decide(team, &c->leave_too_stiff);
}

/* Chooses the number of sub-steps, at the largest overlaps that the near entries may reach in the step. */
static void choose_substeps(struct contacts *c, const struct contact_pass *pass, struct team *team)
{
  struct contact_rates max = {0};
#pragma omp single
  c->rates = (struct contact_rates){0};
#pragma omp for schedule(static) nowait
  for (size_t block = 0; block < c->table.blocks; block++) c->kernel->rates(pass, block, &max);
#pragma omp critical(delbm_contacts)
  {
    c->rates.any |= max.any;
    c->rates.spring = fmax(c->rates.spring, max.spring);
    c->rates.damper = fmax(c->rates.damper, max.damper);
  }
#pragma omp barrier
#pragma omp single
  set_substeps(c, team);
}

static void note_overlap(struct contacts *c, double max_overlap)
{
#pragma omp critical(delbm_contacts)
  c->max_overlap = fmax(c->max_overlap, max_overlap);
}

static struct wrench impulse_on(const struct contact_table *t, size_t m)
{
  struct wrench sum = {0};
  for (size_t k = t->first[m]; k < t->first[m + 1]; k++) {
    const size_t e = t->end[k] / 2;
    const bool b = t->end[k] & 1;
    sum.fx += b ? t->fx[e] : -t->fx[e];
    sum.fy += b ? t->fy[e] : -t->fy[e];
    if (t->has_spin) sum.torque += b ? t->torque_b[e] : t->torque_a[e];
  }
  return sum;
}

static bool has_near_entry(const struct contact_table *t, size_t m)
{
  bool any = false;
  for (size_t k = t->first[m]; k < t->first[m + 1]; k++) any |= t->is_near[t->end[k] / 2];
  return any;
}

/* One sub-step, from the discs' own arrays. */
static void run_one_substep(struct contacts *c, const struct contact_pass *pass, struct discs *d)
{
  double max_overlap = 0;
#pragma omp for schedule(static) nowait
  for (size_t block = 0; block < c->table.blocks; block++) c->kernel->impulses(pass, block, &max_overlap);
  note_overlap(c, max_overlap);
#pragma omp barrier
#pragma omp for schedule(static)
  for (size_t m = 0; m < c->table.members; m++) {
    const uint32_t i = c->table.member[m];
    const struct wrench impulse = impulse_on(&c->table, m);
    d->contact_fx[i] = impulse.fx;
    d->contact_fy[i] = impulse.fy;
    d->contact_torque[i] = impulse.torque;
  }
}

/* Copies the motion of member m to `at`. */
static void start_moving(struct contacts *c, struct discs *d, size_t m)
{
  const uint32_t i = c->table.member[m];
  c->is_moving[i] = has_near_entry(&c->table, m);
  d->contact_fx[i] = d->contact_fy[i] = d->contact_torque[i] = 0;
  c->at.x[i] = d->x[i];
  c->at.y[i] = d->y[i];
  c->at.vx[i] = d->vx[i];
  c->at.vy[i] = d->vy[i];
  c->at.angle[i] = d->angle[i];
  c->at.omega[i] = d->omega[i];
}

/* Moves member m through a sub-step of length h. */
static void move_disc(struct contacts *c, const struct exchange *e, struct discs *d, double h, size_t m)
{
  const uint32_t i = c->table.member[m];
  struct disc_motions *at = &c->at;
  const struct response *r = &e->response[i];
  double dv[3];
  if (!c->is_moving[i]) return;
  const struct wrench impulse = impulse_on(&c->table, m);
  d->contact_fx[i] += impulse.fx;
  d->contact_fy[i] += impulse.fy;
  d->contact_torque[i] += impulse.torque;
  response_to(r, (const double[3]){impulse.fx, impulse.fy, impulse.torque}, dv);
  at->vx[i] += h * r->dvx + dv[0];
  at->vy[i] += h * r->dvy + dv[1];
  at->omega[i] += h * r->domega + dv[2];
  at->x[i] += h * at->vx[i];
  at->y[i] += h * at->vy[i];
  at->angle[i] += h * at->omega[i];
}

static void run_substeps(struct contacts *c, struct contact_pass *pass, const struct exchange *e, struct discs *d)
{
  const double h = 1.0 / c->substeps;
  double max_overlap = 0;
#pragma omp for schedule(static)
  for (size_t m = 0; m < c->table.members; m++) start_moving(c, d, m);
  pass->at = c->at;
  pass->h = h;
  for (int n = 0; n < c->substeps; n++) {
    pass->duration = 0.5 * (pass->moved + h);
#pragma omp for schedule(static)
    for (size_t block = 0; block < c->table.blocks; block++) c->kernel->impulses(pass, block, &max_overlap);
    pass->moved = h;
#pragma omp for schedule(static)
    for (size_t m = 0; m < c->table.members; m++) move_disc(c, e, d, h, m);
  }
  note_overlap(c, max_overlap);
}

/* The step of the contacts in the table, by all threads of a region. */
static void run_contacts(struct contacts *c, const struct exchange *e, struct discs *d, struct team *team)
{
  struct contact_pass pass = pass_of(c, e, d);
#pragma omp for schedule(static)
  for (size_t block = 0; block < c->table.blocks; block++) select_near(c, &pass, d, block);
  if (pass.lubrication) sum_films(c, &pass);
  if (c->needs.substeps) choose_substeps(c, &pass, team);
  if (c->leave_too_stiff) return;
  if (c->substeps == 1)
    run_one_substep(c, &pass, d);
  else
    run_substeps(c, &pass, e, d);
#pragma omp single
  {
    c->last_substep = 1.0 / c->substeps;
    c->placed = false;
  }
}

bool stage_contact(struct contacts *c, const struct occupation *o, const struct exchange *e, struct discs *d,
                   struct team *team)
{
  if (!c->needs.pairs && !c->needs.sides) return true;
  bool rebuilt;
  if (!pairs_update(&c->pairs, o, d, team, &rebuilt)) return false;
  if (rebuilt) {
#pragma omp single
    {
      struct status status;
      if (!build_table(c, d, &status)) team_fail(team, &status);
      team_decide(team, &c->leave);
    }
    if (c->leave) return false;
#pragma omp for schedule(static)
    for (size_t block = 0; block < c->table.blocks; block++) table_fill(&c->table, c->scene, d, &c->law, block);
  }
  if (c->table.blocks > SHORT) {
    run_contacts(c, e, d, team);
  } else {
#pragma omp single
    {
#pragma omp parallel num_threads(1)
      run_contacts(c, e, d, team);
    }
  }
  return !c->leave_too_stiff;
}
