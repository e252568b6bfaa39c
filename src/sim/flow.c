/* The sweep: collision, immersed boundary and streaming of all cells, the links to the sides, and the sums of the
 * next exchange.
 *
 * Order. Each thread sweeps a contiguous range of rows, from the lowest up. Per row: the populations of the sides to
 * be written after the row are prefetched; the kernel collides and streams the row in place; the links of the row's
 * edge cells write what the edge receives in the next step (fluid/boundary.c). No branches per cell: a row without
 * discs uses the kernel without discs; in a row with discs the runs of the occupation are first painted into the
 * thread's solid_row, as the weight B and the sum of w_p B v_p of each cell. Storage is the array of populations
 * (fluid/populations.h), nx * ny cells of nine planes, and one solid_row per thread.
 *
 * Sums. With discs the moments of row y, as input of the next collision, are summed for the next exchange
 * (coupling/exchange.c) once rows y - 1, y and y + 1 are swept: one row behind the sweep, while the row is in cache.
 * The first and the last row of a thread depend on rows of other threads and are summed after a barrier.
 *
 * Races. In a step a cell reads and writes nine slots that belong to the cell alone, in either parity; each link
 * writes a slot of its own (fluid/boundary.c). So rows are independent, and the bits are independent of their order
 * and of the threads. Sums per row are written by one thread and added by the exchange in a fixed order; likewise
 * the momenta of the rows, which the last step of an interval of zero_flux sums (zero_flux.h).
 *
 * Initial state: f_i = f_i^eq(rho, j) plus the viscous stress at first order in the gradient, in moments
 *   p_xx = p_xx^eq - 2 rho/(3 s_nu) (du_x/dx - du_y/dy),  p_xy = p_xy^eq - rho/(3 s_nu) (du_x/dy + du_y/dx),
 * with j = rho (u - g/2) - z/2 for the body force rho g + z. */
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

/* Stores the initial state of a cell as deviations g_i = f_i - w_i. */
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

/* Fields of a caller, row by row from the bottom. */
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
struct solid_cell {
  double b, bv[2];
};

/* (1 - B) of the state plus the discs' motion at the weight B; rigid motion is without stress. */
static struct flow_state mixed(struct flow_state state, const struct solid_cell *c)
{
  for (int axis = 0; axis < 2; axis++) {
    state.velocity[axis] = (1 - c->b) * state.velocity[axis] + c->bv[axis];
    for (int k = 0; k < 2; k++) state.gradient[axis][k] *= 1 - c->b;
  }
  return state;
}

/* Sets all cells of row y, or with `all` false only cells with moving discs. */
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
    struct solid_cell solid = {0};
    if (count > 0)
      solid = (struct solid_cell){solid_at(f, row->b, x), {solid_at(f, row->bvx, x), solid_at(f, row->bvy, x)}};
    if (!all && solid.bv[0] == 0 && solid.bv[1] == 0) continue;
    const struct flow_state state = mixed(initial(context, x, y), &solid);
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
  f->populations.parity = 0; /* in which no cell reads ghosts */
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

/* Mean momentum of a cell; rows added from the lowest up. */
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

/* Sums the moments of row y before its collision in the state `p`, per run of each disc in the row. */
static void sum_moments(const struct flow *f, const struct populations *p, struct occupation *o, int y)
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
  for (int y = 0; y < f->populations.ny; y++) sum_moments(f, &f->populations, o, y);
}

void stage_sweep(struct flow *f, const struct rows *rows, const struct sweep_discs *discs)
{
  struct populations *p = &f->populations;
  struct populations after = *p; /* the same storage, with the parity of the next step */
  const int64_t thread = omp_get_thread_num(), threads = omp_get_num_threads(), count = rows->end - rows->first;
  const int first = rows->first + (int)(count * thread / threads);
  const int end = rows->first + (int)(count * (thread + 1) / threads);
  after.parity ^= 1;
  for (int k = first; k < end; k++) {
    const int y = populations_row(p, k);
    boundary_prefetch(p, y);
    sweep_row_at(f, y, discs);
    boundary_after(&f->boundary, p, y, 0, p->nx);
    if (discs->next && k > first + 1) sum_moments(f, &after, discs->next, populations_row(p, k - 1));
  }
#pragma omp barrier
  /* first and last row: their neighbours belong to other threads */
  if (discs->next && first < end) sum_moments(f, &after, discs->next, populations_row(p, first));
  if (discs->next && first < end - 1) sum_moments(f, &after, discs->next, populations_row(p, end - 1));
#pragma omp barrier
#pragma omp single
  {
    flow_advance(f, 1);
  }
}
