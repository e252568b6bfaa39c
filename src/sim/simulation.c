/* The step. All threads of one parallel region run the four stages one after another; a stage divides its own work and
 * ends at a barrier.
 *
 *   1. stage_exchange    per disc: change of velocity without contacts, and response K to an impulse, from the sums of
 *                        the previous sweep.
 *   2. stage_contact     impulses of contacts through K, hence at the inertia of disc and fluid together.
 *      stage_motion      new velocities and positions. Timed as exchange.
 *   3. stage_occupation  occupation at the new positions; left out where no disc moves.
 *   4. stage_sweep       collision and streaming of the fluid with the discs of the present occupation, and in the same
 *                        pass through memory the sums of the next exchange, over the next occupation.
 *
 * Stage 4 imposes the present occupation on the fluid and sums over the cells of the next one. Hence there are two,
 * whose roles count_step swaps. Before the first step, and after every change by a caller, paint and
 * take_first_sums compute the occupation and sums that a sweep would have left.
 *
 * Blocking in time (blocked.h). Without discs, blocks of several steps run in one pass through memory. With discs, a
 * block advances first the rows that no disc can reach within its steps, then the disc rows step by step. A failure
 * within such a block leaves rows at different steps: block_incomplete then excludes sums over all rows.
 *
 * Without fluid, stage_contact and stage_motion are the step: no populations, no occupation, no sums, no blocking. The
 * response of the discs is constant (exchange.c).
 *
 * State. The state of a checkpoint is the fluid, the discs, and what exchange and contacts store between steps;
 * occupation and sums are derived from the state (derive_state). Failure in a thread: team.h. */
#include "sim/simulation.h"

#include "base/clock.h"
#include "base/memory.h"
#include "base/threads.h"
#include "contact/census.h"
#include "sim/diagnostics.h"
#include "sim/divergence.h"
#include "sim/flow.h"
#include "sim/motion.h"
#include "sim/tuning.h"

#include <math.h>
#include <stdlib.h>

struct simulation {
  const struct scene *scene;
  struct stages stages;
  struct flow flow;
  struct discs discs;
  struct occupation occupations[2]; /* at the present step and at the next; [0] alone where no disc moves */
  int present;                      /* index in occupations[] */
  struct exchange exchange;
  struct contacts contacts;
  struct team team;
  struct tuning tuning;
  struct stage_times times;
  int64_t step;
  int threads; /* of the parallel region */
  double initial_momentum[2];
  double max_mach;
  bool discs_left_rows;  /* flag of team.h: a disc has left the disc rows of a block */
  bool block_incomplete; /* rows are at different steps after a failure within a block */
};

/* Zero without fluid. */
static struct fluid_totals fluid_totals(const struct simulation *s)
{
  const struct fluid_force force = flow_force(&s->flow);
  return s->stages.fluid ? diagnostics_totals(&s->flow.populations, &force) : (struct fluid_totals){0};
}

/* Momentum of fluid and discs that the coupling conserves (exchange.h). */
static void conserved_momentum(struct simulation *s, double momentum[2])
{
  const struct fluid_totals fluid = fluid_totals(s);
  momentum[0] = fluid.jx;
  momentum[1] = fluid.jy;
  for (size_t i = 0; i < s->discs.count; i++) exchange_add_momentum(&s->exchange, &s->discs, i, momentum);
}

static struct occupation *present(struct simulation *s)
{
  return &s->occupations[s->present];
}

static bool create_discs(struct simulation *s, struct status *status)
{
  if (!s->stages.discs) return true;
  const bool painted = s->stages.occupation != OCCUPATION_NEVER;
  const bool moving = s->stages.occupation == OCCUPATION_EVERY_STEP;
  const struct contact_needs needs = {s->stages.pairs, s->stages.walls, s->stages.substeps};
  return discs_create(&s->discs, s->scene, status) &&
         (!painted || occupation_create(&s->occupations[0], s->scene, &s->discs, status)) &&
         (!moving || occupation_create(&s->occupations[1], s->scene, &s->discs, status)) &&
         exchange_create(&s->exchange, s->scene, &s->discs, status) &&
         contacts_create(&s->contacts, s->scene, needs, &s->discs, status);
}

/* Occupation at the present positions. In a parallel region of its own: a stage divides its work among the threads of
 * the innermost region, and the caller may be one thread of another region. */
static bool paint(struct simulation *s, struct status *status)
{
  if (s->stages.exchange) {
#pragma omp parallel num_threads(threads_for(scene_cells(s->scene)))
    stage_occupation(present(s), &s->discs, &s->team);
  }
  return simulation_usable(s, status);
}

/* Sums of the coming exchange, in a parallel region of its own as in paint. */
static void take_first_sums(struct simulation *s)
{
  if (!s->stages.exchange) return;
#pragma omp parallel num_threads(threads_for(scene_cells(s->scene)))
  stage_first_sums(&s->flow, present(s));
}

/* The discs at their present velocities, for functions that replace the populations. */
static struct sweep_discs discs_between_steps(struct simulation *s)
{
  const struct discs *d = &s->discs;
  if (!s->stages.exchange) return (struct sweep_discs){0};
  for (size_t i = 0; i < d->count; i++)
    s->exchange.surface[i] = (struct surface_velocity){d->vx[i], d->vy[i], d->omega[i]};
  return (struct sweep_discs){.now = present(s), .exchange = &s->exchange};
}

void simulation_start(struct simulation *s, flow_initial *initial, const void *context)
{
  if (s->stages.fluid) {
    const struct sweep_discs discs = discs_between_steps(s);
    flow_start(&s->flow, initial, context, &discs);
    take_first_sums(s);
  }
  conserved_momentum(s, s->initial_momentum);
}

static bool create_fluid(struct simulation *s, struct status *status)
{
  if (!s->stages.fluid) return true;
  if (!flow_create(&s->flow, s->scene, &s->stages, status)) return false;
  flow_load(&s->flow, &s->exchange, s->stages.exchange ? &s->discs : NULL);
  flow_balance(&s->flow);
  return true;
}

/* Populations are created last: they are mapped but not written, and the budget (memory.h) counts only resident
 * memory. */
static struct simulation *create(const struct scene *scene, struct status *status)
{
  struct simulation *s = memory_allocate(1, sizeof *s, "the simulation", status);
  if (!s) return NULL;
  s->scene = scene;
  s->stages = stages_of(scene);
  if (create_discs(s, status) && paint(s, status) && create_fluid(s, status)) return s;
  simulation_destroy(s);
  return NULL;
}

bool simulation_create(struct simulation **simulation, const struct scene *scene, struct status *status)
{
  *simulation = create(scene, status);
  if (*simulation) simulation_start(*simulation, NULL, NULL);
  return *simulation;
}

void simulation_destroy(struct simulation *s)
{
  if (!s) return;
  contacts_destroy(&s->contacts);
  exchange_destroy(&s->exchange);
  for (int k = 0; k < 2; k++) occupation_destroy(&s->occupations[k]);
  discs_destroy(&s->discs);
  flow_destroy(&s->flow);
  free(s);
}

/* Adds the time since *since to a stage, by the master thread; all threads have passed the same barrier. */
static void add_time(struct simulation *s, enum stage stage, double *since)
{
#pragma omp master
  {
    const double now = clock_now();
    s->times.seconds[stage] += now - *since;
    *since = now;
  }
}

/* False, by agreement of all threads, if a disc is outside of `rows`, to which a block confines the coming sweep. */
static bool discs_stay_within(struct simulation *s, const struct occupation *next, const struct rows *rows)
{
  if (rows->end - rows->first == s->scene->domain.size[1]) return true;
#pragma omp single
  {
    if (!rows_contain_discs(s->scene, next, rows)) {
      struct status status;
      status_fail(&status, DELBM_FAILED, "diverged at step %lld: a disc moved by more than a cell in one step",
                  (long long)s->step);
      team_fail(&s->team, &status);
    }
    team_decide(&s->team, &s->discs_left_rows);
  }
  return !s->discs_left_rows;
}

/* Stages 1 to 3 of a step, by all threads of the parallel region. False in all threads after a failure in one. `next`:
 * NULL without fluid. */
static bool step_discs(struct simulation *s, struct occupation *next, double *since)
{
  struct occupation *now = s->stages.fluid ? present(s) : NULL;
  if (now && !stage_exchange(&s->exchange, &s->flow.constants, now, &s->discs, s->step, &s->team)) return false;
  add_time(s, STAGE_EXCHANGE, since);
  if (!stage_contact(&s->contacts, now, &s->exchange, &s->discs, &s->team)) return false;
  add_time(s, STAGE_CONTACT, since);
  if (!stage_motion(&s->contacts, &s->exchange, &s->discs, s->step, &s->team)) return false;
  add_time(s, STAGE_EXCHANGE, since);
  if (next != now && !stage_occupation(next, &s->discs, &s->team)) return false;
  add_time(s, STAGE_OCCUPATION, since);
  return true;
}

/* Occupation at the next step: the present one where no disc moves; NULL without fluid. */
static struct occupation *next_occupation(struct simulation *s)
{
  if (!s->stages.fluid) return NULL;
  return s->stages.occupation == OCCUPATION_EVERY_STEP ? &s->occupations[!s->present] : present(s);
}

/* One step of the rows; false as in step_discs. */
static bool step(struct simulation *s, const struct rows *rows, double *since)
{
  struct sweep_discs discs = {0};
  if (!s->stages.fluid) return step_discs(s, NULL, since);
  if (s->stages.exchange) {
    struct occupation *next = next_occupation(s);
    if (!step_discs(s, next, since) || !discs_stay_within(s, next, rows)) return false;
    discs = (struct sweep_discs){.now = present(s), .exchange = &s->exchange, .next = next};
    if (flow_terms(&s->flow, 0) == SWEEP_FORCE_AND_SUM) {
#pragma omp single
      flow_load(&s->flow, &s->exchange, &s->discs);
    }
  }
  stage_sweep(&s->flow, rows, &discs);
  add_time(s, STAGE_SWEEP, since);
  return true;
}

bool simulation_measure(const struct scene *scene, struct simulation_memory *memory, struct status *status)
{
  const double before = memory_handed_out();
  struct simulation *s = create(scene, status);
  if (!s) return false;
  take_first_sums(s);
  if (s->stages.discs) {
#pragma omp parallel num_threads(stages_threads(scene))
    step_discs(s, next_occupation(s), &(double){clock_now()});
  }
  const double populations = (double)s->flow.populations.bytes;
  *memory = (struct simulation_memory){populations, memory_handed_out() - before - populations};
  const bool good =
      simulation_usable(s, status) || !status->out_of_memory; /* divergence leaves the measurement valid */
  simulation_destroy(s);
  return good;
}

/* Steps of a scene without discs, in blocks of equal length, up to the depth that tuning.h has chosen and not across
 * the end of an interval of zero_flux. */
static void run_blocks(struct simulation *s, int64_t steps)
{
  const int64_t end = s->step + steps;
  while (s->step < end) {
    const int64_t left = zero_flux_steps_left(&s->flow.zero_flux, end - s->step);
    const struct blocking blocking = tuning_next(&s->tuning, left);
    const int64_t blocks = (left + blocking.depth - 1) / blocking.depth;
    const int length = s->tuning.decided ? (int)((left + blocks - 1) / blocks) : blocking.depth;
    const int block = length < left ? length : (int)left;
    const double begun = clock_now();
#pragma omp parallel num_threads(s->threads)
    stage_sweep_blocked(&s->flow, &blocking, block);
    const double seconds = clock_now() - begun;
    s->times.seconds[STAGE_SWEEP] += seconds;
    s->step += block;
    if (block == blocking.depth) tuning_note(&s->tuning, &blocking, seconds / block);
  }
}

static void count_step(struct simulation *s)
{
#pragma omp single
  {
    s->step++;
    if (s->stages.occupation == OCCUPATION_EVERY_STEP) s->present ^= 1;
  }
}

/* Steps without blocking, in one parallel region. */
static void run_single_steps(struct simulation *s, int64_t steps)
{
  const struct rows all = {0, s->scene->domain.size[1]};
#pragma omp parallel num_threads(s->threads)
  {
    double since = clock_now();
    for (int64_t k = 0; k < steps && step(s, &all, &since); k++) count_step(s);
  }
}

/* A block with discs: first all steps of the free rows, then the disc rows step by step. */
static void run_disc_block(struct simulation *s, const struct disc_rows *disc_rows, int steps)
{
#pragma omp parallel num_threads(s->threads)
  {
    double since = clock_now();
    stage_sweep_free_rows(&s->flow, disc_rows, steps);
    add_time(s, STAGE_SWEEP, &since);
    for (int k = 0; k < steps; k++) {
      const struct rows rows = disc_rows_at(disc_rows, k);
      if (!step(s, &rows, &since)) break;
      count_step(s);
    }
  }
  s->block_incomplete = s->team.failed;
}

/* Steps of a scene with discs, in blocks where enough rows are free, else without blocking. */
static void run_disc_blocks(struct simulation *s, int64_t steps)
{
  const int64_t end = s->step + steps;
  while (s->step < end && !s->team.failed) {
    const int64_t left = zero_flux_steps_left(&s->flow.zero_flux, end - s->step);
    const int64_t depth = s->tuning.best.depth, length = depth < left ? depth : left;
    struct disc_rows disc_rows;
    if (length > 1 && disc_rows_find(s->scene, present(s), (int)length, &disc_rows))
      run_disc_block(s, &disc_rows, (int)length);
    else
      run_single_steps(s, length);
  }
}

static void run_steps(struct simulation *s, int64_t steps)
{
  const bool blocked = !s->tuning.decided || s->tuning.best.depth > 1;
  if (!blocked)
    run_single_steps(s, steps);
  else if (s->stages.exchange)
    run_disc_blocks(s, steps);
  else
    run_blocks(s, steps);
}

/* Relative excess of the mean density in a box with an inlet, else 0. */
static double congestion(struct simulation *s)
{
  const struct side *side = s->scene->domain.side;
  bool inlet = false;
  for (enum side_name name = 0; name < SIDE_COUNT; name++) inlet |= side[name].type == SIDE_INLET;
  return inlet ? fluid_totals(s).excess_mass / (double)scene_cells(s->scene) : 0;
}

/* Adds the probable cause of a divergence at cell (x, y) (-1: not known) to its message, and updates max_mach. */
static void explain(struct simulation *s, int x, int y, struct status *status)
{
  struct divergence divergence = {
      .scene = s->scene, .discs = &s->discs, .step = s->step, .excess = NAN, .cell = {x, y}};
  if (!s->block_incomplete && s->stages.fluid) {
    divergence.excess = congestion(s);
    s->max_mach = fmax(s->max_mach, sqrt(3) * diagnostics_largest_speed(&s->flow.populations));
  }
  divergence_explain(&divergence, status);
}

bool simulation_usable(const struct simulation *s, struct status *status)
{
  if (s->team.failed) *status = s->team.first;
  return !s->team.failed;
}

bool simulation_check(struct simulation *s, struct status *status)
{
  if (!simulation_usable(s, status)) return false;
  if (!s->stages.fluid) return true; /* discs are checked each step */
  const struct worst_cell worst = diagnostics_worst(&s->flow.populations, s->flow.kernel->scan);
  const double speed = sqrt(worst.speed2), mach = speed * sqrt(3), max_congestion = 0.5;
  const long long step = (long long)s->step;
  if (isnan(speed)) {
    status_fail(status, DELBM_FAILED, "diverged by step %lld: cell (%d, %d) is no longer finite", step, worst.x,
                worst.y);
  } else if (speed > diagnostics_speed_limit) {
    status_fail(status, DELBM_FAILED, "diverged by step %lld: the fluid at cell (%d, %d) moves at Mach %.3g, above 0.6",
                step, worst.x, worst.y, mach);
  } else if (congestion(s) > max_congestion) {
    status_fail(status, DELBM_FAILED, "diverged by step %lld: the fluid is denser than the method can describe", step);
  } else {
    s->max_mach = fmax(s->max_mach, mach);
    return true;
  }
  explain(s, worst.x, worst.y, status);
  team_fail(&s->team, status);
  return false;
}

static bool advance_to_check(struct simulation *s, int64_t steps, struct status *status)
{
  run_steps(s, steps);
  if (!s->team.failed) return true;
  if (!s->team.first.out_of_memory) explain(s, -1, -1, &s->team.first);
  *status = s->team.first;
  return false;
}

bool simulation_advance(struct simulation *s, int64_t steps, struct status *status)
{
  if (!simulation_usable(s, status)) return false;
  if (s->threads != stages_threads(s->scene)) {
    s->threads = stages_threads(s->scene);
    tuning_start(&s->tuning, s->scene, s->threads);
  }
  if (s->stages.fluid && !flow_prepare(&s->flow, s->threads, status)) return false;
  const int64_t end = s->step + steps, check = s->scene->run.check;
  while (s->step < end) {
    const int64_t until_check = check - s->step % check;
    if (!advance_to_check(s, end - s->step < until_check ? end - s->step : until_check, status)) return false;
    if (s->step % check == 0 && !simulation_check(s, status)) return false;
  }
  return true;
}

/* The state without its derived parts (derive_state). */
static bool store_state(struct simulation *s, struct store *store, struct status *status)
{
  return store_mark(store, "simulation", status) && store_bytes(store, &s->step, sizeof s->step, status) &&
         store_bytes(store, s->initial_momentum, sizeof s->initial_momentum, status) &&
         store_bytes(store, &s->max_mach, sizeof s->max_mach, status) &&
         (!s->stages.fluid || flow_store(&s->flow, s->step, store, status)) &&
         (!s->stages.discs ||
          (discs_store(&s->discs, store, status) && exchange_store(&s->exchange, s->discs.count, store, status) &&
           contacts_store(&s->contacts, s->discs.count, store, status))) &&
         store_bytes(store, &s->times, sizeof s->times, status); /* last, since times differ between runs */
}

bool simulation_save(struct simulation *s, struct store *store, struct status *status)
{
  const double max_mach = s->max_mach;
  if (!simulation_check(s, status)) return false;
  s->max_mach = max_mach; /* so that the figures of a run do not depend on its checkpoints */
  return store_state(s, store, status);
}

/* Refuses positions that no run can reach: painting them would exceed the tables. */
static bool check_places(const struct simulation *s, const struct store *store, struct status *status)
{
  const double far = 1e9;
  for (size_t i = 0; i < s->discs.count; i++) {
    const double at[2] = {s->discs.x[i], s->discs.y[i]};
    for (int axis = 0; axis < 2; axis++) {
      const bool periodic = scene_is_periodic(s->scene, axis);
      const bool sane = periodic ? at[axis] >= 0 && at[axis] < s->scene->domain.size[axis] : fabs(at[axis]) <= far;
      if (!sane)
        return status_fail(status, DELBM_IO, "cannot read %s: disc %zu at (%g, %g)", store->path, i, at[0], at[1]);
    }
  }
  return true;
}

/* The derived state: occupation, and sums of the coming exchange. */
static bool derive_state(struct simulation *s, struct status *status)
{
  if (!paint(s, status)) return false;
  take_first_sums(s);
  return true;
}

bool simulation_changed(struct simulation *s, struct status *status)
{
  if (!simulation_usable(s, status) || !derive_state(s, status)) return false;
  contacts_placed(&s->contacts);
  return true;
}

/* Tables never shrink, so that the former positions fit. */
bool simulation_unchanged(struct simulation *s)
{
  struct status ignored;
  s->team.failed = false;
  return derive_state(s, &ignored);
}

bool simulation_restore(struct simulation *s, struct store *store, struct status *status)
{
  if (!store_state(s, store, status) || !check_places(s, store, status)) return false;
  if (s->stages.fluid) boundary_refill(&s->flow.boundary, &s->flow.populations);
  return derive_state(s, status);
}

void simulation_set_fluid(struct simulation *s, const double *density, const double *ux, const double *uy)
{
  const struct sweep_discs discs = discs_between_steps(s);
  flow_set(&s->flow, density, ux, uy, &discs);
}

const char *simulation_kernel(const struct simulation *s)
{
  return s->stages.fluid ? s->flow.kernel->name : "none";
}

int64_t simulation_step(const struct simulation *s)
{
  return s->step;
}

const struct scene *simulation_scene(const struct simulation *s)
{
  return s->scene;
}

const struct discs *simulation_discs(const struct simulation *s)
{
  return &s->discs;
}

const struct occupation *simulation_occupation(const struct simulation *s)
{
  return s->stages.exchange ? &s->occupations[s->present] : NULL;
}

void simulation_fields(struct simulation *s, double *density, double *ux, double *uy)
{
  const struct fluid_force force = flow_force(&s->flow);
  diagnostics_fields(&s->flow.populations, &force, density, ux, uy);
}

bool simulation_instant(struct simulation *s, struct instant *instant, struct status *status)
{
  const struct fluid_force force = flow_force(&s->flow);
  const struct instant_fluid fluid = {&s->flow.populations, &force, s->flow.kernel ? s->flow.kernel->scan : NULL};
  return instant_take(s->scene, s->stages.fluid ? &fluid : NULL, &s->discs, instant, status);
}

bool simulation_sample(struct simulation *s, const struct sample_grid *grid, const struct sample *sample,
                       struct status *status)
{
  const struct fluid_force force = flow_force(&s->flow);
  const bool periodic[2] = {scene_is_periodic(s->scene, 0), scene_is_periodic(s->scene, 1)};
  return sample_take(&s->flow.populations, periodic, &force, simulation_occupation(s), &s->discs, grid, sample, status);
}

/* As in struct simulation_report. */
static double momentum_drift(struct simulation *s)
{
  if (s->block_incomplete) return NAN;
  const bool closed_system = scene_is_periodic(s->scene, 0) && scene_is_periodic(s->scene, 1) &&
                             s->discs.free == s->discs.count && s->scene->coupling.solve == SOLVE_IMPLICIT;
  if (!closed_system) return NAN;
  const double cells = s->stages.fluid ? (double)scene_cells(s->scene) : 0;
  double buoyant_mass = 0, momentum[2], largest = 0;
  for (size_t i = 0; i < s->discs.count; i++) buoyant_mass += s->discs.buoyant_mass[i];
  const double mass = s->stages.fluid ? cells : buoyant_mass;
  conserved_momentum(s, momentum);
  for (int axis = 0; axis < 2; axis++) {
    const double applied = cells * s->scene->fluid.force[axis] + buoyant_mass * s->scene->particles.gravity[axis];
    const double unexplained = momentum[axis] - s->initial_momentum[axis] - (double)s->step * applied;
    largest = fmax(largest, fabs(unexplained) / mass);
  }
  return largest;
}

/* Mass and mean velocity of the fluid. */
static void report_fluid(const struct simulation *s, struct simulation_report *report)
{
  const double cells = (double)scene_cells(s->scene);
  const struct fluid_force force = flow_force(&s->flow);
  struct fluid_totals totals = fluid_totals(s);
  if (s->block_incomplete) totals.excess_mass = NAN;
  report->mass_drift = fabs(totals.excess_mass) / cells;
  fluid_mean_velocity(&totals, cells, &force, report->mean_velocity);
}

/* Over all steps, and at the present positions, which are those of the next. */
static double max_overlap(const struct simulation *s)
{
  struct contact_census now;
  struct status ignored;
  if (!s->stages.discs || s->team.failed) return s->contacts.max_overlap;
  return contact_census(s->scene, &s->discs, &now, &ignored) ? fmax(s->contacts.max_overlap, now.max_overlap) : NAN;
}

void simulation_report(struct simulation *s, struct simulation_report *report)
{
  *report = (struct simulation_report){.threads = stages_threads(s->scene),
                                       .kernel = simulation_kernel(s),
                                       .times = s->times,
                                       .momentum_drift = momentum_drift(s),
                                       .max_mach = s->max_mach,
                                       .max_substeps = s->stages.discs ? s->contacts.max_substeps : 1,
                                       .max_overlap = max_overlap(s)};
  if (s->stages.fluid) report_fluid(s, report);
  tuning_text(&s->tuning, report->blocking);
  threads_binding(report->binding);
}
