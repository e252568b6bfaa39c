/* Warnings about discs that come to rest on a side within the run: a pile in which the pore pressure still supports
 * a part of the weight, and overlap under load. */
#include "cli/advice.h"

#include "contact/law.h"
#include "sim/estimate.h"

#include <math.h>
#include <stdio.h>

/* Solid fraction of discs poured at random, and the exponent of hindered settling, u = u_alone (1 - fraction)^n
 * (Richardson & Zaki 1954; 4.8 measured in the case `settling`). */
static const double packing = 0.8, hindrance = 4.65;

/* Overlap under load over the radius, above which to warn: in a pile, and of single discs on the ground. */
static const double max_in_pile = 0.02, max_alone = 0.05, wanted_overlap = 0.01;

/* The discs that gravity draws to one side. */
struct sediment {
  int axis;
  bool at_high_end; /* of the axis */
  size_t count;
  double weight, area, radius; /* sums */
  double farthest;             /* distance of a centre from that side */
  double low[2], high[2];      /* bounding rectangle at the start */
};

static double buoyant_weight(const struct scene *scene, const struct disc_spec *disc, int axis)
{
  return disc_spec_area(disc) * scene_buoyant_density(scene, disc) * scene->particles.gravity[axis];
}

static bool is_drawn(const struct scene *scene, const struct sediment *s, const struct disc_spec *disc)
{
  const double weight = buoyant_weight(scene, disc, s->axis);
  return disc->motion == DISC_FREE && weight != 0 && (weight > 0) == s->at_high_end;
}

static struct sediment gather(const struct scene *scene, int axis, bool at_high_end)
{
  struct sediment s = {
      .axis = axis, .at_high_end = at_high_end, .low = {INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY}};
  for (size_t i = 0; i < scene->particles.count; i++) {
    const struct disc_spec *disc = &scene->particles.discs[i];
    if (!is_drawn(scene, &s, disc)) continue;
    const double at = disc->position[axis];
    s.count++;
    s.weight += fabs(buoyant_weight(scene, disc, axis));
    s.area += disc_spec_area(disc);
    s.radius += disc->radius;
    s.farthest = fmax(s.farthest, at_high_end ? scene->domain.size[axis] - at : at);
    for (int k = 0; k < 2; k++) {
      s.low[k] = fmin(s.low[k], disc->position[k] - disc->radius);
      s.high[k] = fmax(s.high[k], disc->position[k] + disc->radius);
    }
  }
  return s;
}

/* Width that supports the weight: of the box or, for discs densely packed from the start, of the packing. */
static double width_of(const struct scene *scene, const struct sediment *s)
{
  const double dense = 0.6, held = (s->high[0] - s->low[0]) * (s->high[1] - s->low[1]);
  const double box = scene->domain.size[!s->axis];
  return s->area > dense * held ? fmin(box, s->high[!s->axis] - s->low[!s->axis]) : box;
}

static double layers(const struct scene *scene, const struct sediment *s)
{
  return s->area / packing / scene->domain.size[!s->axis] / (2 * s->radius / (double)s->count);
}

/* True if the farthest disc arrives within 2/3 of the run. */
static bool comes_to_rest(const struct scene *scene, const struct sediment *s)
{
  const double spare = 1.5, count = (double)s->count, fraction = s->area / (double)scene_cells(scene);
  const double way = s->farthest - fmax(s->area / packing / scene->domain.size[!s->axis], s->radius / count);
  if (scene->fluid.none)
    return spare * sqrt(2 * fmax(0, way) / fabs(scene->particles.gravity[s->axis])) <= (double)scene->run.steps;
  const double alone = estimate_settling(s->radius / count, scene->fluid.viscosity, s->weight / count);
  const double speed = alone * pow(1 - fmin(fraction, 1), hindrance);
  return spare * way <= speed * (double)scene->run.steps;
}

/* Force at an overlap of two equal discs or, for a single disc, of a disc and a side. */
static double force_at(const struct contact_law *law, double overlap, double radius, bool alone)
{
  return contact_spring_at(law, (const double[2]){radius, alone ? INFINITY : radius}, overlap).force;
}

/* Overlap at which the contact force is equal to the load. */
static double overlap_under(double load, const struct contact_law *law, double radius, bool alone)
{
  double low = 0, high = radius;
  for (int k = 0; k < 50; k++) {
    const double overlap = (low + high) / 2;
    if (force_at(law, overlap, radius, alone) < load)
      low = overlap;
    else
      high = overlap;
  }
  return low;
}

/* Load on the lowest disc: its own weight if alone, in a pile the weight above its width. */
static double load_on(const struct scene *scene, const struct sediment *s, const struct disc_spec *disc, bool alone)
{
  const double own = fabs(buoyant_weight(scene, disc, s->axis));
  return alone ? own : fmax(own, s->weight / width_of(scene, s) * 2 * disc->radius);
}

static void advise_overlap(const struct scene *scene, const struct sediment *s)
{
  const struct contact_law law = contact_law_of(scene);
  struct contact_law unit = law; /* with k_n = 1 */
  unit.k_n = 1;
  const bool alone = layers(scene, s) <= 1;
  double worst = 0, stiffness = 0;
  const struct disc_spec *before = NULL;
  for (size_t i = 0; i < scene->particles.count; i++) {
    const struct disc_spec *disc = &scene->particles.discs[i];
    if (!is_drawn(scene, s, disc)) continue;
    if (before && before->radius == disc->radius && before->density == disc->density) continue;
    const double load = load_on(scene, s, disc, alone), radius = disc->radius;
    worst = fmax(worst, overlap_under(load, &law, radius, alone) / radius);
    stiffness = fmax(stiffness, load / force_at(&unit, wanted_overlap * radius, radius, alone));
    before = disc;
  }
  if (worst <= (alone ? max_alone : max_in_pile)) return;
  printf("  note: at rest %s overlap by about %.2g %% of their radius under %s; better: contact.stiffness >= %.2g, for "
         "%g %%\n",
         alone ? "discs and the side that they lie on" : "the lowest discs", 100 * worst,
         alone ? "their weight" : "the weight of the pile", stiffness, 100 * wanted_overlap);
}

static void advise_pile(const struct scene *scene, const struct sediment *s)
{
  if (layers(scene, s) <= 1) return;
  printf(
      "  note: %zu discs come to lie in a pile, about %.2g layers high; in two dimensions fluid cannot flow between "
      "discs that touch, and its pressure bears part of their weight (about half in a pile of 20): contact forces in "
      "the pile are too small; better: loads from (density - 1) particles.gravity\n",
      s->count, layers(scene, s));
}

void advise_rest(const struct scene *scene)
{
  for (int axis = 0; axis < 2; axis++)
    for (int end = 0; end < 2; end++) {
      const struct sediment s = gather(scene, axis, end == 1);
      if (s.count == 0 || scene_is_periodic(scene, axis) || !comes_to_rest(scene, &s)) continue;
      if (!scene->fluid.none) advise_pile(scene, &s);
      advise_overlap(scene, &s);
    }
}
