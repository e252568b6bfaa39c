/* Limits of many discs: overlap under their weight, large ratios of radii, several centres within one cell. */
#include "edge.h"
#include "scenes.h"
#include "sim/load.h"

#include <math.h>

/* Largest overlap of two discs or of a disc and a side, over the smaller radius, in the last call. Without periodic
 * images: boxes are closed or far larger than the cluster in them. */
static bool watch_overlap(struct simulation *simulation, void *context)
{
  const struct scene *scene = simulation_scene(simulation);
  const struct discs *d = simulation_discs(simulation);
  double *deepest = context;
  *deepest = 0;
  for (size_t i = 0; i < d->count; i++) {
    const double side =
        fmin(fmin(d->x[i], scene->domain.size[0] - d->x[i]), fmin(d->y[i], scene->domain.size[1] - d->y[i]));
    *deepest = fmax(*deepest, 1 - side / d->radius[i]);
    for (size_t j = 0; j < i; j++) {
      const double overlap = d->radius[i] + d->radius[j] - hypot(d->x[i] - d->x[j], d->y[i] - d->y[j]);
      *deepest = fmax(*deepest, overlap / fmin(d->radius[i], d->radius[j]));
    }
  }
  return true;
}

/* A map of the arguments of `scene_of`, rows and columns. */
struct crowd_map {
  struct map map;
  const double *rows;
  int row_count;
  const double *columns;
  int count;
  int64_t steps;
  struct scene (*scene_of)(double row, double column);
};

static bool put_crowds(struct edge *edge, struct crowd_map *crowds, struct status *status)
{
  struct map *map = &crowds->map;
  map_set_columns(map, crowds->columns, crowds->count);
  map_begin(map, edge->report);
  for (int r = 0; r < crowds->row_count; r += edge->report->quick ? 2 : 1) {
    struct place row[MAP_COLUMNS];
    char label[MAP_LABEL];
    for (int c = 0; c < map->columns; c++) {
      double deepest = 0;
      struct scene scene = crowds->scene_of(crowds->rows[r], crowds->columns[c]);
      struct edge_run run = {.steps = edge->report->quick ? crowds->steps / 20 : crowds->steps,
                             .every = 50,
                             .watch = watch_overlap,
                             .context = &deepest};
      const bool ok = edge_run(edge, &scene, &run, status);
      scene_clear(&scene);
      if (!ok) return false;
      row[c] = run.diverged ? map_diverged(run.end) : map_judge(map, deepest, run.end);
    }
    snprintf(label, sizeof label, crowds->rows[r] > 0 ? "%g" : "auto", crowds->rows[r]);
    map_row(map, edge->report, label, row, r == 0);
  }
  map_end(edge->report);
  return true;
}

/* 0: the stiffness for an overlap of 1 % under the expected load. */
static void set_stiffness(struct scene *scene, double stiffness)
{
  scene->contact.stiffness = stiffness;
  if (stiffness > 0) return;
  const struct loads loads = loads_of(scene);
  load_set_stiffness(scene, &loads, INFINITY);
}

/* The paper's crowd, with `weight` times its weight less buoyancy. */
static struct scene pressed(double stiffness, double weight)
{
  struct scene scene = scene_crowd(80, 80, 5, 11, 0.2);
  for (size_t i = 0; i < scene.particles.count; i++) scene.particles.discs[i].density = 1 + 0.01 * weight;
  set_stiffness(&scene, stiffness);
  return scene;
}

/* A crowd of discs of R = 2 and density 2, and one disc that is larger by the ratio, on the ground or above them. Gravity
 * makes its weight less buoyancy equal to its drag at `speed` with a drag coefficient of 1; that of discs is 1 or more. */
static struct scene mixture(double ratio, double speed, bool above)
{
  const double radius = 2, large = ratio * radius, density = 2;
  const double room = 2 * large + 2 * radius;
  const int width = (int)(2 * large + 30 * radius), height = (int)(2 * large + 40 * radius);
  struct scene scene = scene_crowd(width, height, radius, 2.5 * radius, 0.1 * radius);
  struct disc_spec *discs = scene.particles.discs;
  size_t kept = 0;
  for (size_t i = 0; i < scene.particles.count; i++)
    if (above ? discs[i].position[1] < height - room : discs[i].position[1] > room) discs[kept++] = discs[i];
  scene.particles.count = scene.particles.listed = kept;
  scene.particles.fill.present = false;
  const double bottom = large + 0.5 * radius;
  scene_add_disc(&scene, large, density, 0.5 * width, above ? height - bottom : bottom);
  for (size_t i = 0; i < kept; i++) scene.particles.discs[i].density = density;
  scene.particles.gravity[1] = -speed * speed / (M_PI * large * (density - 1));
  return scene;
}

static struct scene on_a_large_one(double stiffness, double ratio)
{
  struct scene scene = mixture(ratio, 0.1, false);
  set_stiffness(&scene, stiffness);
  return scene;
}

static struct scene under_a_large_one(double stiffness, double ratio)
{
  struct scene scene = mixture(ratio, 0.1, true);
  set_stiffness(&scene, stiffness);
  return scene;
}

static struct scene on_a_large_one_by_speed(double speed, double ratio)
{
  struct scene scene = mixture(ratio, speed, false);
  set_stiffness(&scene, 0);
  return scene;
}

static struct scene cluster(int discs, double radius)
{
  struct scene scene = scene_box(60, 60, 0.05, SIDES_PERIODIC);
  for (int k = 0; k < discs; k++) {
    const double angle = 2 * M_PI * k / discs + 0.1, distance = fmin(0.5, 0.5 * radius);
    scene_add_disc(&scene, radius, 2, 30.5 + distance * cos(angle), 30.5 + distance * sin(angle));
  }
  return scene;
}

/* Free discs with centres within one cell. */
static bool map_cluster(struct edge *edge, struct status *status)
{
  static const double counts[] = {2, 3, 4, 5, 6}, radii[] = {0.5, 1, 2, 5};
  struct map map = {.name = "discs within one cell, let go",
                    .value = "drift of momentum a cell",
                    .corner = "radius/discs",
                    .threshold = 1e-13};
  map_set_columns(&map, counts, 5);
  map_begin(&map, edge->report);
  for (int r = 0; r < 4; r++) {
    struct place row[MAP_COLUMNS];
    char label[MAP_LABEL];
    for (int c = 0; c < map.columns; c++) {
      double deepest = 0;
      struct scene scene = cluster((int)counts[c], radii[r]);
      struct edge_run run = {
          .steps = edge->report->quick ? 50 : 1000, .every = 10, .watch = watch_overlap, .context = &deepest};
      const bool ok = edge_run(edge, &scene, &run, status);
      scene_clear(&scene);
      if (!ok) return false;
      row[c] = run.diverged ? map_diverged(run.end) : map_judge(&map, run.last.momentum_drift, run.end);
    }
    snprintf(label, sizeof label, "%g", radii[r]);
    map_row(&map, edge->report, label, row, r == 0);
  }
  map_end(edge->report);
  return true;
}

bool edge_crowds(struct edge *edge, struct status *status)
{
  static const double stiffnesses[] = {0, 0.025, 0.25, 2.5, 25, 250}, speeds[] = {0.05, 0.1, 0.2, 0.4, 0.8};
  static const double weights[] = {1, 3, 10, 30, 100}, ratios[] = {2, 5, 10, 20};
  static const char overlap[] = "deepest overlap over the smaller radius", corner[] = "stiffness/ratio of radii";
  struct crowd_map all[] = {
      {{.name = "packing pressed by its weight", .value = overlap, .corner = "stiffness/weight", .threshold = 0.1},
       stiffnesses,
       6,
       weights,
       5,
       4000,
       pressed},
      {{.name = "small discs on a large one", .value = overlap, .corner = corner, .threshold = 0.1},
       stiffnesses,
       6,
       ratios,
       4,
       4000,
       on_a_large_one},
      {{.name = "small discs under a large one", .value = overlap, .corner = corner, .threshold = 0.1},
       stiffnesses,
       6,
       ratios,
       4,
       4000,
       under_a_large_one},
      {{.name = "small discs on a large one, by speed",
        .value = overlap,
        .corner = "speed/ratio of radii",
        .threshold = 0.1},
       speeds,
       5,
       ratios,
       4,
       3000,
       on_a_large_one_by_speed},
  };
  for (size_t k = 0; k < sizeof all / sizeof all[0]; k++)
    if (!put_crowds(edge, &all[k], status)) return false;
  return map_cluster(edge, status);
}
