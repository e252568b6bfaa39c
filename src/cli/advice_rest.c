/* Warnings about discs that come to rest on a side within the run: a pile that is sealed, so that the pore pressure
 * supports a part of the weight, and overlap under load. */
#include "cli/advice.h"

#include "sim/estimate.h"
#include "sim/load.h"

#include <math.h>
#include <stdio.h>

/* Exponent of hindered settling, u = u_alone (1 - fraction)^n (Richardson & Zaki 1954; 4.8 measured in the case
 * `settling`). */
static const double hindrance = 4.65;

/* Overlap under load over the radius, above which to warn: in a pile, and of single discs on the ground. */
static const double max_in_pile = 0.02, max_alone = 0.05;

/* Width of the passages between the hydraulic radii of discs that touch, cells, below which the fluid keeps a part of the
 * weight for longer than it takes to settle: 24 % of it after 50,000 steps without any, 3 % at 0.24 cells, 0.1 % at 0.64
 * (a pile of 20 discs, R = 10). The part R_h/R that is usual (Boutt et al. 2007; Cui et al. 2012: 0.7 to 0.9). */
static const double min_passage = 0.5, usual_part = 0.8;

/* True if the farthest disc arrives within 2/3 of the run. */
static bool comes_to_rest(const struct scene *scene, const struct sediment *s)
{
  const double spare = 1.5, count = (double)s->count, part = scene->coupling.hydraulic_radius;
  const double fraction = part * part * s->area / (double)scene_cells(scene);
  const double fall = sediment_fall(scene, s);
  if (scene->fluid.none)
    return spare * sqrt(2 * fmax(0, fall) / fabs(scene->particles.gravity[s->axis])) <= (double)scene->run.steps;
  const double alone = estimate_settling(part * s->radius, scene->fluid.viscosity, s->weight / count);
  const double speed = alone * pow(1 - fmin(fraction, 1), hindrance);
  return spare * fall <= speed * (double)scene->run.steps;
}

static void advise_overlap(const struct scene *scene, const struct sediment *s)
{
  const struct load load = load_in_sediment(scene, s);
  const double overlap = load_overlap(scene, &load);
  const bool alone = sediment_layers(scene, s) <= 1;
  if (overlap <= (alone ? max_alone : max_in_pile)) return;
  printf("  note: at rest %s overlap by about %.2g %% of their radius under %s; better: contact.stiffness >= %.2g, for "
         "%g %%, or auto\n",
         alone ? "discs and the side that they lie on" : "the lowest discs", 100 * overlap,
         alone ? "their weight" : "the weight of the pile", load_stiffness(scene, &load), 100 * scene->contact.overlap);
}

/* Passages have the width 2 (R - R_h) less the overlap under load, of the smaller disc. */
static void advise_pile(const struct scene *scene, const struct sediment *s)
{
  const struct load load = load_in_sediment(scene, s);
  const double radius = fmin(load.radius[0], load.radius[1]), overlap = load_overlap(scene, &load);
  const double part = scene->coupling.hydraulic_radius, open = radius * (2 * (1 - part) - overlap);
  const double opening = 1 - (min_passage / radius + overlap) / 2; /* R_h/R */
  if (sediment_layers(scene, s) <= 1 || open >= min_passage) return;
  printf(
      "  note: %zu discs come to lie in a pile, about %.2g layers high; in two dimensions fluid cannot flow between "
      "discs that touch%s, and its pressure bears part of their weight (about half in a pile of 20): contact forces in "
      "the pile are too small; better: coupling.hydraulic_radius%s %.2g, which opens passages for the fluid, or loads "
      "from (density - 1) particles.gravity\n",
      s->count, sediment_layers(scene, s), part < 1 ? " and overlap under load" : "",
      opening < usual_part ? " <=" : ":", fmin(usual_part, opening));
}

void advise_rest(const struct scene *scene)
{
  for (int axis = 0; axis < 2; axis++)
    for (int end = 0; end < 2; end++) {
      const struct sediment s = sediment_of(scene, axis, end == 1);
      if (s.count == 0 || scene_is_periodic(scene, axis) || !comes_to_rest(scene, &s)) continue;
      if (!scene->fluid.none) advise_pile(scene, &s);
      advise_overlap(scene, &s);
    }
}
