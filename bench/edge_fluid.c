/* Fluid alone at small viscosity and large Mach number: the doubly periodic shear layer of Minion & Brown 1997, two
 * layers tanh(30 y) that roll up, until fluid has crossed the box once. Without a force, dE/dt = -2 nu Z and
 * enstrophy Z cannot grow: deviations are the error. Derivatives are spectral. */
#include "base/memory.h"
#include "edge.h"
#include "lattice/moments.h"
#include "scenes.h"
#include "sim/diagnostics.h"
#include "sim/flow.h"

#include <fftw3.h>
#include <math.h>
#include <stdlib.h>

/* A shear layer in progress. */
struct layer {
  int size;
  double speed;
  struct flow flow;
  double *ux, *uy;
  fftw_complex *modes[2];
  fftw_plan plan[2];
};

static void set_layer(struct layer *l)
{
  for (int y = 0; y < l->size; y++)
    for (int x = 0; x < l->size; x++) {
      const double X = (x + 0.5) / l->size, Y = (y + 0.5) / l->size;
      const double ux = l->speed * tanh(Y < 0.5 ? 30 * (Y - 0.25) : 30 * (0.75 - Y));
      const double uy = 0.05 * l->speed * sin(2 * M_PI * (X + 0.25));
      double m[Q], f[Q];
      moments_equilibrium(1, ux, uy, m);
      populations_from_moments(m, f);
      struct populations *p = &l->flow.populations;
      for (int i = 0; i < Q; i++) populations_set(p, populations_source(p, i, x, y), f[i] - d2q9_weight[i]);
    }
}

static void layer_destroy(struct layer *l)
{
  for (int k = 0; k < 2; k++) {
    if (l->plan[k]) fftw_destroy_plan(l->plan[k]);
    fftw_free(l->modes[k]);
  }
  free(l->ux);
  free(l->uy);
  flow_destroy(&l->flow);
}

static bool layer_create(struct layer *l, const struct scene *scene, double speed, struct status *status)
{
  const struct stages stages = stages_of(scene);
  const int n = scene->domain.size[0];
  const size_t cells = (size_t)n * (size_t)n;
  *l = (struct layer){.size = n, .speed = speed};
  if (!flow_create(&l->flow, scene, &stages, status)) return false;
  l->ux = memory_allocate(cells, sizeof *l->ux, "the shear layer", status);
  if (l->ux) l->uy = memory_allocate(cells, sizeof *l->uy, "the shear layer", status);
  if (!l->uy) return false;
  for (int k = 0; k < 2; k++) {
    l->modes[k] = fftw_alloc_complex((size_t)n * (size_t)(n / 2 + 1));
    l->plan[k] = fftw_plan_dft_r2c_2d(n, n, k ? l->uy : l->ux, l->modes[k], FFTW_ESTIMATE);
  }
  set_layer(l);
  return true;
}

/* Means over the box of |u|^2/2 and (rot u)^2/2. */
struct energies {
  double kinetic, enstrophy;
};

static struct energies measure(struct layer *l)
{
  const int n = l->size;
  const struct fluid_force none = flow_force(&l->flow);
  const double unit = 2 * M_PI / n, all = pow(n, 4);
  struct energies sum = {0};
  diagnostics_fields(&l->flow.populations, &none, NULL, l->ux, l->uy);
  for (int k = 0; k < 2; k++) fftw_execute(l->plan[k]);
  for (int j = 0; j < n; j++)
    for (int i = 0; i <= n / 2; i++) {
      const double *u = l->modes[0][j * (n / 2 + 1) + i], *v = l->modes[1][j * (n / 2 + 1) + i];
      const double kx = unit * i, ky = unit * (j <= n / 2 ? j : j - n), twice = i == 0 || i == n / 2 ? 1 : 2;
      const double re = kx * v[0] - ky * u[0], im = kx * v[1] - ky * u[1];
      sum.kinetic += twice * (u[0] * u[0] + u[1] * u[1] + v[0] * v[0] + v[1] * v[1]) / 2 / all;
      sum.enstrophy += twice * (re * re + im * im) / 2 / all;
    }
  return sum;
}

static bool has_diverged(struct layer *l)
{
  const struct worst_cell worst = diagnostics_worst(&l->flow.populations, l->flow.kernel->scan);
  return !(sqrt(worst.speed2) <= diagnostics_speed_limit);
}

/* Runs until fluid has crossed the box once. */
static struct place advance_layer(struct layer *l, const struct map *map)
{
  const int64_t steps = (int64_t)ceil(l->size / l->speed), every = steps / 64 + 1;
  const struct energies start = measure(l);
  struct energies before = start;
  double taken = 0, error = 0;
  for (int64_t step = 1; step <= steps; step++) {
    stage_sweep(&l->flow, &(struct rows){0, l->size}, &(struct sweep_discs){0});
    if (step % every != 0 && step < steps) continue;
    if (has_diverged(l)) return map_diverged(step);
    const struct energies now = measure(l);
    const double span = (double)(step % every == 0 ? every : step % every);
    taken += span * 2 * l->flow.scene->fluid.viscosity * (now.enstrophy + before.enstrophy) / 2;
    error = fmax(error, now.enstrophy / start.enstrophy - 1);
    error = fmax(error, fabs(start.kinetic - now.kinetic - taken) / start.kinetic);
    before = now;
  }
  return map_judge(map, error, steps);
}

static bool run_layer(const struct edge_operator *o, const struct map *map, int size, double viscosity, double mach,
                      struct place *place, struct status *status)
{
  struct scene scene = scene_box(size, size, viscosity, SIDES_PERIODIC);
  scene.fluid.rates = edge_rates(o, viscosity);
  struct layer layer;
  const bool ok = layer_create(&layer, &scene, mach / sqrt(3), status);
  if (ok) *place = advance_layer(&layer, map);
  layer_destroy(&layer);
  scene_clear(&scene);
  return ok;
}

static bool map_operator(struct edge *edge, const struct edge_operator *o, struct status *status)
{
  static const double viscosities[] = {1e-4, 3e-4, 1e-3, 2e-3, 5e-3, 0.01, 0.03, 0.1};
  static const double machs[] = {0.05, 0.1, 0.2, 0.3, 0.4};
  const bool quick = edge->report->quick;
  char name[64];
  snprintf(name, sizeof name, "shear layer, %s", o->name);
  struct map map = {
      .name = name, .value = "energy or enstrophy unaccounted for", .corner = "viscosity/Mach", .threshold = 0.02};
  map_set_columns(&map, machs, sizeof machs / sizeof machs[0]);
  map_begin(&map, edge->report);
  for (size_t v = 0; v < sizeof viscosities / sizeof viscosities[0]; v += quick ? 4 : 1) {
    struct place row[MAP_COLUMNS];
    char label[MAP_LABEL];
    for (int m = 0; m < map.columns; m++)
      if (!run_layer(o, &map, quick ? 32 : 128, viscosities[v], machs[m], &row[m], status)) return false;
    snprintf(label, sizeof label, "%g", viscosities[v]);
    map_row(&map, edge->report, label, row, v == 0);
  }
  map_end(edge->report);
  return true;
}

bool edge_fluid(struct edge *edge, struct status *status)
{
  for (int k = 0; k < EDGE_OPERATORS; k++)
    if (!map_operator(edge, &edge_operators[k], status)) return false;
  return true;
}
