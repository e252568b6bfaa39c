/* Limits of many discs: overlap under their weight, large ratios of radii, several centres within one cell. */
#include "edge.h"
#include "scenes.h"

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

/* A map of stiffness (rows) and the argument of `scene_of` (columns). */
struct crowd_map {
  struct map map;
  const double *columns;
  int count;
  int64_t steps;
  struct scene (*scene_of)(double column);
};

static bool put_crowds(struct edge *edge, struct crowd_map *crowds, struct status *status)
{
  static const double stiffnesses[] = {0.025, 0.25, 2.5, 25, 250};
  struct map *map = &crowds->map;
  map_set_columns(map, crowds->columns, crowds->count);
  map_begin(map, edge->report);
  for (int r = 0; r < 5; r += edge->report->quick ? 2 : 1) {
    struct place row[MAP_COLUMNS];
    char label[MAP_LABEL];
    for (int c = 0; c < map->columns; c++) {
      double deepest = 0;
      struct scene scene = crowds->scene_of(crowds->columns[c]);
      struct edge_run run = {.steps = edge->report->quick ? crowds->steps / 20 : crowds->steps,
                             .every = 50,
                             .watch = watch_overlap,
                             .context = &deepest};
      scene.contact.stiffness = stiffnesses[r];
      const bool ok = edge_run(edge, &scene, &run, status);
      scene_clear(&scene);
      if (!ok) return false;
      row[c] = run.diverged ? map_diverged(run.end) : map_judge(map, deepest, run.end);
    }
    snprintf(label, sizeof label, "%g", stiffnesses[r]);
    map_row(map, edge->report, label, row, r == 0);
  }
  map_end(edge->report);
  return true;
}

/* The paper's crowd, with `weight` times its weight less buoyancy. */
static struct scene pressed(double weight)
{
  struct scene scene = scene_crowd(80, 80, 5, 11, 0.2);
  for (size_t i = 0; i < scene.particles.count; i++) scene.particles.discs[i].density = 1 + 0.01 * weight;
  return scene;
}

/* Discs of R = 1 falling on one that is larger by the ratio. */
static struct scene polydisperse(double ratio)
{
  struct scene scene = scene_crowd(60, 100, 1, 2.5, 0.1);
  size_t kept = 0;
  for (size_t i = 0; i < scene.particles.count; i++)
    if (scene.particles.discs[i].position[1] > 2 * ratio + 2 && scene.particles.discs[i].position[1] < 2 * ratio + 20)
      scene.particles.discs[kept++] = scene.particles.discs[i];
  scene.particles.count = scene.particles.listed = kept;
  scene.particles.fill.present = false;
  scene_add_disc(&scene, ratio, 2, 30, ratio + 0.5);
  for (size_t i = 0; i < kept; i++) scene.particles.discs[i].density = 2;
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
  static const double weights[] = {1, 3, 10, 30, 100}, ratios[] = {2, 5, 10, 20};
  struct crowd_map packing = {{.name = "packing pressed by its weight",
                               .value = "deepest overlap over radius",
                               .corner = "stiffness/weight",
                               .threshold = 0.1},
                              weights,
                              5,
                              4000,
                              pressed};
  struct crowd_map mixture = {{.name = "small discs on a large one",
                               .value = "deepest overlap over the smaller radius",
                               .corner = "stiffness/ratio of radii",
                               .threshold = 0.1},
                              ratios,
                              4,
                              3000,
                              polydisperse};
  return put_crowds(edge, &packing, status) && put_crowds(edge, &mixture, status) && map_cluster(edge, status);
}
