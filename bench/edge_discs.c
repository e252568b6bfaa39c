/* Limits of single discs: density, radii below a cell, fixed spinning discs. */
#include "edge.h"
#include "scenes.h"
#include "square_array.h"

#include <math.h>
#include <stdlib.h>

static const char *const forms[] = {[FORM_UNIFIED] = "unified", [FORM_OWEN] = "owen", [FORM_MIDPOINT] = "midpoint"};
static const char *const solves[] = {[SOLVE_IMPLICIT] = "implicit", [SOLVE_EXPLICIT_AVERAGED] = "averaged"};

/* A disc of R = 5 in a channel. |weight less buoyancy| is the same for every density, and so is the terminal speed. */
static struct scene falling(double density, enum coupling_form form, enum coupling_solve solve, double speed)
{
  const double net = 2e-4;
  struct scene scene = scene_box(48, 72, 0.1, SIDES_PERIODIC);
  scene.domain.side[SIDE_LEFT].type = scene.domain.side[SIDE_RIGHT].type = SIDE_WALL;
  scene.coupling.form = form;
  scene.coupling.solve = solve;
  scene.particles.gravity[1] = -net / fabs(density - 1);
  scene_add_disc(&scene, 5, density, 24, 36)->velocity[1] = density > 1 ? -speed : speed;
  return scene;
}

/* Steps to the terminal speed. */
static int64_t steps_to_fall(const struct edge *edge, double density)
{
  return (int64_t)((edge->report->quick ? 500 : 20000) * fmin(10, fmax(1, density / 20)));
}

static bool go_on(struct simulation *simulation, void *context)
{
  (void)simulation;
  (void)context;
  return true;
}

/* Mean speed over the last fifth of a run, many cells of way. */
struct travel {
  double from, sum;
  int count;
};

static bool note_speed(struct simulation *simulation, void *context)
{
  struct travel *travel = context;
  if ((double)simulation_step(simulation) < travel->from) return true;
  travel->sum += fabs(simulation_discs(simulation)->vy[0]);
  travel->count++;
  return true;
}

static bool terminal_speed(struct edge *edge, struct scene *scene, struct edge_run *run, double *speed,
                           struct status *status)
{
  struct travel travel = {.from = 0.8 * (double)run->steps};
  run->watch = note_speed;
  run->context = &travel;
  const bool ok = edge_run(edge, scene, run, status);
  run->context = NULL;
  *speed = travel.count > 0 ? travel.sum / travel.count : 0;
  scene_clear(scene);
  return ok;
}

/* Terminal speed of the reference run of a form, at density 2. */
static bool reference_speed(struct edge *edge, enum coupling_form form, double *speed, struct status *status)
{
  struct scene scene = falling(2, form, SOLVE_IMPLICIT, 0);
  struct edge_run run = {.steps = edge->report->quick ? 2000 : 40000, .every = 25};
  return terminal_speed(edge, &scene, &run, speed, status);
}

static bool map_density(struct edge *edge, struct status *status)
{
  static const double densities[] = {0.01, 0.03, 0.1, 0.3, 0.5, 0.8, 0.99, 1.01, 1.2, 2, 5, 10, 100, 1000};
  struct map map = {.name = "density of a settling disc",
                    .value = "error of the terminal speed, which density does not change",
                    .corner = "form, solve/density",
                    .threshold = 0.02};
  map_set_columns(&map, densities, sizeof densities / sizeof densities[0]);
  map_begin(&map, edge->report);
  for (int k = 0; k < 2 * FORM_COUNT; k++) {
    const enum coupling_form form = (enum coupling_form)(k % FORM_COUNT);
    const enum coupling_solve solve = k / FORM_COUNT ? SOLVE_EXPLICIT_AVERAGED : SOLVE_IMPLICIT;
    struct place row[MAP_COLUMNS];
    double expected, speed;
    if (!reference_speed(edge, form, &expected, status)) return false;
    for (int c = 0; c < map.columns; c++) {
      struct scene scene = falling(densities[c], form, solve, expected);
      struct edge_run run = {.steps = steps_to_fall(edge, densities[c]), .every = 25};
      if (!terminal_speed(edge, &scene, &run, &speed, status)) return false;
      row[c] = run.diverged ? map_diverged(run.end) : map_judge(&map, fabs(speed / expected - 1), run.end);
    }
    char label[MAP_LABEL];
    snprintf(label, sizeof label, "%s %s", forms[form], solves[solve]);
    map_row(&map, edge->report, label, row, k == 0);
  }
  map_end(edge->report);
  return true;
}

/* A fixed disc in a periodic square of 16 cells; K = F/(mu U) of a dilute square array (Hasimoto 1959), exact within
 * 0.1 % up to a solid fraction of 0.11. */
enum { SMALL_BOX = 16, SMALL_MIDDLE = SMALL_BOX / 2, RADII = 9 };
static const double small_radii[RADII] = {0.5, 0.6, 0.7, 0.8, 0.9, 1, 1.5, 2, 3};

static double dilute_drag(double fraction)
{
  return 4 * M_PI / (-0.5 * log(fraction) - 0.738 + fraction - 0.887 * fraction * fraction + 2.038 * pow(fraction, 3));
}

/* Relative error of the drag, over places within a cell. */
static bool small_disc_errors(double radius, double viscosity, enum coupling_form form, struct deviations *all,
                              struct status *status)
{
  const double exact = dilute_drag(M_PI * radius * radius / (SMALL_BOX * SMALL_BOX));
  *all = (struct deviations){0};
  for (int k = 0; k < PLACES; k++) {
    const struct offset offset = place_offset(k);
    struct scene scene = scene_box(SMALL_BOX, SMALL_BOX, viscosity, SIDES_PERIODIC);
    struct accuracy_outcome cost = {0};
    double drag = NAN;
    scene.coupling.form = form;
    scene.fluid.force[0] = 1e-6 * viscosity;
    scene_add_disc(&scene, radius, 1, SMALL_MIDDLE + offset.x, SMALL_MIDDLE + offset.y)->motion = DISC_FIXED;
    const bool ok = square_array_drag(&scene, &drag, &cost, status);
    scene_clear(&scene);
    if (!ok) return false;
    deviations_add(all, drag / exact - 1, offset.weight);
  }
  return true;
}

/* Two maps of the same runs: the largest error and the mean. A quick run omits the smaller viscosity. */
static bool map_radius(struct edge *edge, struct status *status)
{
  static const double viscosities[] = {0.1, 0.01};
  static const char *const names[] = {"drag of small discs", "drag of small discs, mean"};
  static const char *const values[] = {"largest error of the drag of a square array over places within a cell",
                                       "mean error of the drag of a square array over places within a cell"};
  const int rows = edge->report->quick ? FORM_COUNT : 2 * FORM_COUNT;
  struct deviations all[2 * FORM_COUNT][RADII];
  for (int k = 0; k < rows; k++)
    for (int c = 0; c < RADII; c++)
      if (!small_disc_errors(small_radii[c], viscosities[k / FORM_COUNT], (enum coupling_form)(k % FORM_COUNT),
                             &all[k][c], status))
        return false;
  for (int mean = 0; mean < 2; mean++) {
    struct map map = {
        .name = names[mean], .value = values[mean], .corner = "form, viscosity/radius", .threshold = 0.05};
    map_set_columns(&map, small_radii, RADII);
    map_begin(&map, edge->report);
    for (int k = 0; k < rows; k++) {
      struct place row[MAP_COLUMNS];
      char label[MAP_LABEL];
      for (int c = 0; c < RADII; c++) row[c] = map_judge(&map, mean ? all[k][c].error : all[k][c].worst, 0);
      snprintf(label, sizeof label, "%s %g", forms[k % FORM_COUNT], viscosities[k / FORM_COUNT]);
      map_row(&map, edge->report, label, row, k == 0);
    }
    map_end(edge->report);
  }
  return true;
}

/* A disc of R = 8 driven through a periodic box, once along it. Potential flow around a cylinder reaches twice its
 * speed at most; the wake may exceed that. */
static bool drive_disc(struct edge *edge, const struct edge_operator *choice, double viscosity, double mach,
                       struct edge_run *run, struct status *status)
{
  const double speed = mach / sqrt(3);
  const int length = edge->report->quick ? 40 : 160;
  struct scene scene = scene_box(length, length / 2, viscosity, SIDES_PERIODIC);
  struct disc_spec *disc = scene_add_disc(&scene, 8, 1, length / 2.0, length / 4.0 + 0.2);
  disc->motion = DISC_DRIVEN;
  disc->velocity[0] = speed;
  scene.fluid.rates = edge_rates(choice, viscosity);
  *run = (struct edge_run){.steps = (int64_t)(length / speed), .every = 100, .watch = go_on};
  const bool ok = edge_run(edge, &scene, run, status);
  scene_clear(&scene);
  return ok;
}

static bool map_driven(struct edge *edge, const struct edge_operator *choice, struct status *status)
{
  static const double viscosities[] = {1e-4, 3e-4, 1e-3, 2e-3, 5e-3, 0.01, 0.03, 0.1}, machs[] = {0.05, 0.1, 0.2, 0.3};
  char name[64];
  snprintf(name, sizeof name, "driven disc, %s", choice->name);
  struct map map = {
      .name = name, .value = "fastest fluid over the speed of the disc", .corner = "viscosity/Mach", .threshold = 2.5};
  map_set_columns(&map, machs, sizeof machs / sizeof machs[0]);
  map_begin(&map, edge->report);
  for (size_t v = 0; v < sizeof viscosities / sizeof viscosities[0]; v += edge->report->quick ? 4 : 1) {
    struct place row[MAP_COLUMNS];
    char label[MAP_LABEL];
    for (int c = 0; c < map.columns; c++) {
      struct edge_run run;
      if (!drive_disc(edge, choice, viscosities[v], machs[c], &run, status)) return false;
      row[c] = run.diverged ? map_diverged(run.end) : map_judge(&map, run.last.max_mach / machs[c], run.end);
    }
    snprintf(label, sizeof label, "%g", viscosities[v]);
    map_row(&map, edge->report, label, row, v == 0);
  }
  map_end(edge->report);
  return true;
}

/* A driver of the fluid, and a bound of all speeds. `mach`: Mach number of the driver for a value of 1. */
struct driver {
  struct map map;
  double mach;
  int64_t steps;
  void (*scene)(struct scene *scene, double value);
};

/* Map over forms and values. */
static bool map_driver(struct edge *edge, struct driver *driver, const double *values, struct status *status)
{
  struct map *map = &driver->map;
  map_begin(map, edge->report);
  for (int form = 0; form < FORM_COUNT; form++) {
    struct place row[MAP_COLUMNS];
    for (int c = 0; c < map->columns; c++) {
      struct scene scene;
      struct edge_run run = {.steps = edge->report->quick ? 1000 : driver->steps, .every = 1000, .watch = go_on};
      driver->scene(&scene, values[c]);
      scene.coupling.form = (enum coupling_form)form;
      const bool ok = edge_run(edge, &scene, &run, status);
      scene_clear(&scene);
      if (!ok) return false;
      const double excess = run.last.max_mach / (driver->mach * values[c]) - 1;
      row[c] = run.diverged ? map_diverged(run.end) : map_judge(map, excess, run.end);
    }
    map_row(map, edge->report, forms[form], row, form == 0);
  }
  map_end(edge->report);
  return true;
}

static void spinning_disc(struct scene *scene, double spin)
{
  *scene = scene_box(60, 60, 0.05, SIDES_PERIODIC);
  struct disc_spec *disc = scene_add_disc(scene, 10, 1, 30, 30);
  disc->motion = DISC_FIXED;
  disc->spin = spin;
}

static bool map_spin(struct edge *edge, struct status *status)
{
  static const double spins[] = {0.001, 0.002, 0.004, 0.008, 0.015, 0.03};
  struct driver driver = {.map = {.name = "fixed disc that spins",
                                  .value = "fastest fluid over the speed of the rim, less 1",
                                  .corner = "form/spin",
                                  .threshold = 0.1},
                          .mach = 10 * sqrt(3),
                          .steps = 100000,
                          .scene = spinning_disc};
  map_set_columns(&driver.map, spins, sizeof spins / sizeof spins[0]);
  return map_driver(edge, &driver, spins, status);
}

/* A disc overlapped by a sliding lid by half a cell. */
static void disc_under_a_lid(struct scene *scene, double mach)
{
  *scene = scene_box(90, 60, 0.01, SIDES_CLOSED);
  scene->domain.side[SIDE_TOP].velocity[0] = mach / sqrt(3);
  scene_add_disc(scene, 5, 1, 40.3, 55.5)->motion = DISC_FIXED;
}

static bool map_lid(struct edge *edge, struct status *status)
{
  static const double machs[] = {0.02, 0.05, 0.1, 0.15, 0.2, 0.3};
  struct driver driver = {.map = {.name = "fixed disc under a lid",
                                  .value = "fastest fluid over the speed of the lid, less 1",
                                  .corner = "form/Mach",
                                  .threshold = 0.5},
                          .mach = 1,
                          .steps = 20000,
                          .scene = disc_under_a_lid};
  map_set_columns(&driver.map, machs, sizeof machs / sizeof machs[0]);
  return map_driver(edge, &driver, machs, status);
}

bool edge_discs(struct edge *edge, struct status *status)
{
  for (int k = 0; k < EDGE_OPERATORS; k++)
    if (!map_driven(edge, &edge_operators[k], status)) return false;
  return map_density(edge, status) && map_radius(edge, status) && map_spin(edge, status) && map_lid(edge, status);
}
