/* Limits of contacts: stiffness and sub-steps, speed of impact, a disc wedged between walls. */
#include "edge.h"
#include "scenes.h"

#include <math.h>

enum { ROWS = 16 };

/* Results of a head-on impact of two discs. */
struct impact {
  double density, speed, viscosity, stiffness, damping;
  int substeps;
  enum contact_area area;
  double approach, separation; /* speeds, before the first step with a contact force and after the last */
  double overlap;              /* largest */
  double momentum;             /* drift of the conserved momentum */
  bool met, diverged;
  int64_t end;
};

static const double impact_radius = 5;

static bool watch_impact(struct simulation *simulation, void *context)
{
  struct impact *impact = context;
  const struct discs *d = simulation_discs(simulation);
  const double overlap = 2 * impact_radius - hypot(d->x[1] - d->x[0], d->y[1] - d->y[0]);
  const double approach_speed = d->vx[0] - d->vx[1];
  const bool touching = d->contact_fx[0] != 0; /* during a part of this step at least */
  impact->met |= touching;
  if (!impact->met) impact->approach = approach_speed;
  if (touching) impact->separation = -approach_speed;
  impact->overlap = fmax(impact->overlap, overlap);
  return !impact->met || touching || overlap > 0;
}

static bool run_impact(struct edge *edge, struct impact *impact, struct status *status)
{
  struct scene scene = scene_box(64, 40, impact->viscosity, SIDES_PERIODIC);
  for (int k = 0; k < 2; k++)
    scene_add_disc(&scene, impact_radius, impact->density, 32.3 + (k ? 7 : -7), 20)->velocity[0] =
        k ? -impact->speed : impact->speed;
  scene.contact.stiffness = impact->stiffness;
  scene.contact.damping = impact->damping;
  scene.contact.substeps = impact->substeps;
  scene.contact.area = impact->area;
  scene.run.check = 10;
  struct edge_run run = {.steps = 3000, .every = 1, .watch = watch_impact, .context = impact};
  const bool ok = edge_run(edge, &scene, &run, status);
  scene_clear(&scene);
  impact->momentum = run.last.momentum_drift;
  impact->diverged = run.diverged;
  impact->end = run.end;
  return ok;
}

/* Maps of one set of impacts. */
enum { RESTITUTION, OVERLAP, MOMENTUM, FIGURES };
static const struct map impact_maps[FIGURES] = {
    {.value = "speed after over speed before the contact: above 1, energy gained", .threshold = 1},
    {.value = "deepest overlap over radius", .threshold = 0.1},
    {.value = "drift of momentum a cell", .threshold = 1e-13}};
static const double fluid_gain =
    0.02; /* gain of undamped discs in the first step of the contact, over the speed before */
static const char *const impact_names[FIGURES] = {"restitution", "overlap", "momentum"};

static double figure(const struct impact *impact, int which)
{
  if (which == RESTITUTION) return impact->met ? fmax(0, impact->separation) / impact->approach : 0;
  return which == OVERLAP ? impact->overlap / impact_radius : impact->momentum;
}

/* Prints the maps of figures `first` and on of impacts[row][column]. */
static void put_impacts(const struct edge *edge, const char *what, struct map *map, const struct impact *impacts,
                        int rows, char labels[][MAP_LABEL], int first)
{
  for (int f = first; f < FIGURES; f++) {
    char name[96];
    snprintf(name, sizeof name, "%s, %s", what, impact_names[f]);
    map->name = name;
    map->value = impact_maps[f].value;
    map->threshold = impact_maps[f].threshold + (f == RESTITUTION && impacts->damping == 0 ? fluid_gain : 0);
    map_begin(map, edge->report);
    for (int r = 0; r < rows; r++) {
      struct place row[MAP_COLUMNS];
      for (int c = 0; c < map->columns; c++) {
        const struct impact *at = &impacts[r * map->columns + c];
        row[c] = at->diverged ? map_diverged(at->end) : map_judge(map, figure(at, f), at->end);
      }
      map_row(map, edge->report, labels[r], row, r == 0);
    }
    map_end(edge->report);
  }
}

/* Stiffness over eight decades against sub-steps; 0 is auto. */
static bool map_stiffness(struct edge *edge, enum contact_area area, double damping, struct status *status)
{
  static const int substeps[] = {0, 1, 4, 16, 64, 256};
  enum { COLUMNS = sizeof substeps / sizeof substeps[0] };
  const bool quick = edge->report->quick;
  const int columns = quick || area == AREA_CELLS ? 1 : COLUMNS; /* areas by cells take one */
  struct impact impacts[ROWS * COLUMNS];
  char labels[ROWS][MAP_LABEL], what[64];
  struct map map = {.corner = "stiffness/sub-steps", .columns = columns};
  int rows = 0;
  for (int c = 0; c < columns; c++) snprintf(map.column[c], MAP_LABEL, substeps[c] ? "%d" : "auto", substeps[c]);
  for (int decade = -3; decade <= 5; decade += quick ? 2 : 1, rows++) {
    snprintf(labels[rows], MAP_LABEL, "%g", 2.5 * pow(10, decade));
    for (int c = 0; c < columns; c++) {
      impacts[rows * columns + c] = (struct impact){.density = 2,
                                                    .speed = 0.05,
                                                    .viscosity = 0.01,
                                                    .stiffness = 2.5 * pow(10, decade),
                                                    .damping = damping,
                                                    .area = area,
                                                    .substeps = substeps[c]};
      if (!run_impact(edge, &impacts[rows * columns + c], status)) return false;
    }
  }
  snprintf(what, sizeof what, "impact%s, damping %g", area == AREA_CELLS ? " by cells" : "", damping);
  put_impacts(edge, what, &map, impacts, rows, labels, RESTITUTION);
  return true;
}

/* Each disc's Mach number against density. Restitution is omitted: at such speeds the impulse of the fluid between
 * the discs exceeds the contact's. */
static bool map_speed(struct edge *edge, struct status *status)
{
  static const double machs[] = {0.05, 0.1, 0.2, 0.3, 0.4, 0.5}, densities[] = {0.3, 1.01, 2, 10};
  enum { COLUMNS = sizeof machs / sizeof machs[0], DENSITIES = sizeof densities / sizeof densities[0] };
  struct impact impacts[DENSITIES * COLUMNS];
  char labels[DENSITIES][MAP_LABEL];
  struct map map = {.corner = "density/Mach of each"};
  map_set_columns(&map, machs, COLUMNS);
  for (int r = 0; r < DENSITIES; r++) {
    snprintf(labels[r], MAP_LABEL, "%g", densities[r]);
    for (int c = 0; c < COLUMNS; c++) {
      impacts[r * COLUMNS + c] = (struct impact){
          .density = densities[r], .speed = machs[c] / sqrt(3), .viscosity = 0.05, .stiffness = 0.25, .damping = 0.34};
      if (!run_impact(edge, &impacts[r * COLUMNS + c], status)) return false;
    }
  }
  put_impacts(edge, "fast impact", &map, impacts, DENSITIES, labels, OVERLAP);
  return true;
}

/* Largest distance from the middle between two walls 10 cells apart. */
static bool watch_middle(struct simulation *simulation, void *context)
{
  double *farthest = context;
  *farthest = fmax(*farthest, fabs(simulation_discs(simulation)->x[0] - 5));
  return true;
}

static bool map_wedge(struct edge *edge, struct status *status)
{
  static const double squeezes[] = {0, 0.1, 0.5, 1, 2}, stiffnesses[] = {0.025, 0.25, 25, 2500, 250000};
  struct map map = {.name = "disc wedged between walls",
                    .value = "farthest from the middle, cells",
                    .corner = "stiffness/overlap of each",
                    .threshold = 1e-6};
  map_set_columns(&map, squeezes, sizeof squeezes / sizeof squeezes[0]);
  map_begin(&map, edge->report);
  for (int r = 0; r < 5; r++) {
    struct place row[MAP_COLUMNS];
    char label[MAP_LABEL];
    for (int c = 0; c < map.columns; c++) {
      double farthest = 0;
      struct scene scene = scene_box(10, 40, 0.05, SIDES_PERIODIC);
      struct edge_run run = {
          .steps = edge->report->quick ? 100 : 2000, .every = 10, .watch = watch_middle, .context = &farthest};
      scene.domain.side[SIDE_LEFT].type = scene.domain.side[SIDE_RIGHT].type = SIDE_WALL;
      scene.contact.stiffness = stiffnesses[r];
      scene.particles.gravity[1] = -1e-4;
      scene_add_disc(&scene, 5 + squeezes[c], 2, 5, 20);
      const bool ok = edge_run(edge, &scene, &run, status);
      scene_clear(&scene);
      if (!ok) return false;
      row[c] = run.diverged ? map_diverged(run.end) : map_judge(&map, farthest, run.end);
    }
    snprintf(label, sizeof label, "%g", stiffnesses[r]);
    map_row(&map, edge->report, label, row, r == 0);
  }
  map_end(edge->report);
  return true;
}

bool edge_contacts(struct edge *edge, struct status *status)
{
  for (enum contact_area area = AREA_LENS; area <= AREA_CELLS; area++)
    if (!map_stiffness(edge, area, 0.34, status) || !map_stiffness(edge, area, 0, status)) return false;
  return map_speed(edge, status) && map_wedge(edge, status);
}
