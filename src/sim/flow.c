#include "sim/flow.h"

#include "base/memory.h"
#include "lattice/moments.h"

#include <omp.h>
#include <stdlib.h>

bool flow_create(struct flow *f, const struct scene *scene, const struct stages *stages, struct status *status)
{
  *f = (struct flow){
      .scene = scene,
      .force = stages->force,
      .adaptive = rates_are_adaptive(&scene->fluid.rates),
      .zero_flux = zero_flux_create(scene),
      .constants = {.rates = scene->fluid.rates, .force = {scene->fluid.force[0], scene->fluid.force[1]}}};
  const int nx = scene->domain.size[0], ny = scene->domain.size[1];
  f->kernel = sweep_find(scene->fluid.kernel, scene->fluid.precision, status);
  if (!f->kernel) return false;
  if (!populations_create(&f->populations, nx, ny, scene_is_periodic(scene, 1), scene->fluid.precision, status))
    return false;
  if (!boundary_create(&f->boundary, scene->domain.side, nx, ny, status) || !flow_prepare(f, 1, status)) return false;
  if (f->zero_flux.interval == 0) return true;
  f->row_momentum = memory_allocate((size_t)ny, sizeof *f->row_momentum, "the rows' momentum", status);
  return f->row_momentum != NULL;
}

void flow_destroy(struct flow *f)
{
  for (int t = 0; f->solid_rows && t < f->threads; t++) solid_row_destroy(&f->solid_rows[t]);
  free(f->solid_rows);
  free(f->row_momentum);
  boundary_destroy(&f->boundary);
  populations_destroy(&f->populations);
}

bool flow_prepare(struct flow *f, int threads, struct status *status)
{
  if (f->scene->particles.count == 0 || threads <= f->threads) return true;
  size_t capacity = (size_t)f->threads;
  if (!memory_grow(&f->solid_rows, &capacity, (size_t)threads, sizeof *f->solid_rows, "the solid rows", status))
    return false;
  for (; f->threads < threads; f->threads++)
    if (!solid_row_create(&f->solid_rows[f->threads], f->populations.nx, f->kernel, status)) return false;
  return true;
}

/* Equilibrium, and the stress that goes with the gradient, as deviations. */
static void set_state(struct flow *f, int x, int y, const struct flow_state *state)
{
  struct populations *p = &f->populations;
  const double rho = state->density, (*du)[2] = state->gradient, *force = f->constants.force;
  const double *uniform = f->constants.uniform;
  const double jx = rho * (state->velocity[0] - force[0] / 2) - uniform[0] / 2;
  const double jy = rho * (state->velocity[1] - force[1] / 2) - uniform[1] / 2;
  const double stress = rho / (3 * f->constants.rates.s_nu);
  double m[Q], g[Q];
  moments_equilibrium(rho, jx, jy, m);
  m[M_PXX] -= 2 * stress * (du[0][0] - du[1][1]);
  m[M_PXY] -= stress * (du[0][1] + du[1][0]);
  populations_from_moments(m, g);
  for (int i = 0; i < Q; i++) populations_set(p, populations_source(p, i, x, y), g[i] - d2q9_weight[i]);
}

static struct flow_state at_rest(const void *context, int x, int y)
{
  (void)context, (void)x, (void)y;
  return (struct flow_state){.density = 1};
}

/* What a caller writes, row by row from the bottom. */
struct flow_arrays {
  const double *density, *ux, *uy;
  int nx;
};

static struct flow_state at_arrays(const void *context, int x, int y)
{
  const struct flow_arrays *arrays = context;
  const size_t at = (size_t)y * (size_t)arrays->nx + (size_t)x;
  return (struct flow_state){.density = arrays->density[at], .velocity = {arrays->ux[at], arrays->uy[at]}};
}

static double solid_at(const struct flow *f, const void *row, int x)
{
  return f->kernel->precision == PRECISION_DOUBLE ? ((const double *)row)[x] : (double)((const float *)row)[x];
}

/* Weight B of the discs in a cell, and sum over owners of w_p B v_p. */
struct covered {
  double b, bv[2];
};

/* (1 - B) of the state, and B of the discs' motion: that of a rigid body is without stress. */
static struct flow_state mixed(struct flow_state state, const struct covered *c)
{
  for (int axis = 0; axis < 2; axis++) {
    state.velocity[axis] = (1 - c->b) * state.velocity[axis] + c->bv[axis];
    for (int k = 0; k < 2; k++) state.gradient[axis][k] *= 1 - c->b;
  }
  return state;
}

/* Sets all cells of row y, or only those in which discs move. */
static void set_row(struct flow *f, flow_initial *initial, const void *context, bool all, int y,
                    const struct sweep_discs *discs)
{
  const int nx = f->populations.nx;
  const struct solid_row *row = f->solid_rows;
  size_t count = 0;
  const struct run *runs = discs->now ? occupation_row(discs->now, y, &count) : NULL;
  if (count > 0)
    f->kernel->paint(row, nx, runs, count, occupation_band(discs->now, y)->owner_weight, discs->exchange->surface);
  for (int x = 0; (all || count > 0) && x < nx; x++) {
    struct covered covered = {0};
    if (count > 0)
      covered = (struct covered){solid_at(f, row->b, x), {solid_at(f, row->bvx, x), solid_at(f, row->bvy, x)}};
    if (!all && covered.bv[0] == 0 && covered.bv[1] == 0) continue;
    const struct flow_state state = mixed(initial(context, x, y), &covered);
    set_state(f, x, y, &state);
  }
}

void flow_start(struct flow *f, flow_initial *initial, const void *context, const struct sweep_discs *discs)
{
  populations_rest(&f->populations);
  const bool all = initial || f->force;
  for (int y = 0; y < f->populations.ny; y++) set_row(f, initial ? initial : at_rest, context, all, y, discs);
  boundary_reset(&f->boundary, &f->populations);
}

void flow_set(struct flow *f, const double *density, const double *ux, const double *uy,
              const struct sweep_discs *discs)
{
  const struct flow_arrays arrays = {density, ux, uy, f->populations.nx};
  f->populations.parity = 0; /* the one in which no cell reads ghosts */
  for (int y = 0; y < f->populations.ny; y++) set_row(f, at_arrays, &arrays, true, y, discs);
  boundary_reset(&f->boundary, &f->populations);
}

void flow_load(struct flow *f, const struct exchange *exchange, const struct discs *discs)
{
  const double cells = (double)scene_cells(f->scene);
  double on_discs[2] = {0, 0};
  for (size_t i = 0; discs && i < discs->count; i++) exchange_add_load(exchange, discs, i, on_discs);
  for (int axis = 0; axis < 2; axis++) f->load[axis] = f->constants.force[axis] + on_discs[axis] / cells;
}

void flow_balance(struct flow *f)
{
  if (f->zero_flux.interval > 0) zero_flux_start(&f->zero_flux, f->load, f->constants.uniform);
}

bool flow_store(struct flow *f, int64_t step, struct store *store, struct status *status)
{
  struct zero_flux *z = &f->zero_flux;
  if (z->interval > 0) z->phase = (int)(step % z->interval);
  return populations_store(&f->populations, store, status) &&
         store_bytes(store, f->constants.uniform, sizeof f->constants.uniform, status) &&
         store_bytes(store, z->mean_momentum, sizeof z->mean_momentum, status) &&
         store_bytes(store, z->load, sizeof z->load, status) && boundary_store(&f->boundary, store, status);
}

static void sweep_row_at(struct flow *f, int y, const struct sweep_discs *discs)
{
  const struct occupation *o = discs->now;
  const enum sweep_terms terms = flow_terms(f, 0);
  double *momentum = f->row_momentum ? f->row_momentum[y] : NULL;
  const int nx = f->populations.nx;
  size_t count = 0;
  const struct run *runs = o ? occupation_row(o, y, &count) : NULL;
  void *a[Q];
  populations_cells(&f->populations, 0, y, a);
  if (count == 0) {
    f->kernel->fluid[f->adaptive][terms](a, nx, &f->constants, NULL, momentum);
    return;
  }
  const struct solid_row *solid = &f->solid_rows[omp_get_thread_num()];
  f->kernel->paint(solid, nx, runs, count, occupation_band(o, y)->owner_weight, discs->exchange->surface);
  f->kernel->discs[f->scene->coupling.form][f->adaptive][terms](a, nx, &f->constants, solid, momentum);
}

/* Mean momentum of a cell; rows are added from the lowest up. */
static void mean_momentum(const struct flow *f, double mean[2])
{
  const double cells = (double)f->populations.nx * f->populations.ny;
  double sum[2] = {0, 0};
  for (int y = 0; y < f->populations.ny; y++)
    for (int axis = 0; axis < 2; axis++) sum[axis] += f->row_momentum[y][axis];
  for (int axis = 0; axis < 2; axis++) mean[axis] = sum[axis] / cells;
}

void flow_advance(struct flow *f, int steps)
{
  struct zero_flux *z = &f->zero_flux;
  f->populations.parity ^= steps & 1;
  if (z->interval == 0) return;
  z->phase += steps;
  if (z->phase < z->interval) return;
  double mean[2];
  mean_momentum(f, mean);
  zero_flux_update(z, mean, f->load, f->constants.uniform);
  z->phase = 0;
}

/* Takes the moments of row y, about to be collided in the state `p`, for the discs that cover it. */
static void take_sums(const struct flow *f, const struct populations *p, struct occupation *o, int y)
{
  const struct band *band = occupation_band(o, y);
  const size_t first = band->row_start[y % BAND_ROWS], end = band->row_end[y % BAND_ROWS];
  if (first == end) return;
  void *a[Q];
  populations_cells(p, 0, y, a);
  f->kernel->gather(a, band->runs + first, end - first, band->owner_weight, band->sums + first);
}

void stage_first_sums(struct flow *f, struct occupation *o)
{
#pragma omp for schedule(static)
  for (int y = 0; y < f->populations.ny; y++) take_sums(f, &f->populations, o, y);
}

void stage_sweep(struct flow *f, const struct rows *rows, const struct sweep_discs *discs)
{
  struct populations *p = &f->populations;
  struct populations after = *p; /* the same populations, as the next step will read them */
  const int64_t thread = omp_get_thread_num(), threads = omp_get_num_threads(), count = rows->end - rows->first;
  const int first = rows->first + (int)(count * thread / threads);
  const int end = rows->first + (int)(count * (thread + 1) / threads);
  after.parity ^= 1;
  for (int k = first; k < end; k++) {
    const int y = populations_row(p, k);
    boundary_prefetch(p, y);
    sweep_row_at(f, y, discs);
    boundary_after(&f->boundary, p, y, 0, p->nx);
    if (discs->next && k > first + 1) take_sums(f, &after, discs->next, populations_row(p, k - 1));
  }
#pragma omp barrier
  /* the ends of a thread's rows wait for their neighbours, which are another thread's */
  if (discs->next && first < end) take_sums(f, &after, discs->next, populations_row(p, first));
  if (discs->next && first < end - 1) take_sums(f, &after, discs->next, populations_row(p, end - 1));
#pragma omp barrier
#pragma omp single
  {
    flow_advance(f, 1);
  }
}
