#include "sim/sediment.h"

#include <math.h>

double sediment_disc_weight(const struct scene *scene, const struct disc_spec *disc, int axis)
{
  return disc_spec_area(disc) * scene_buoyant_density(scene, disc) * scene->particles.gravity[axis];
}

bool sediment_has(const struct scene *scene, const struct sediment *s, const struct disc_spec *disc)
{
  const double weight = sediment_disc_weight(scene, disc, s->axis);
  return disc->motion == DISC_FREE && weight != 0 && (weight > 0) == s->at_high_end;
}

struct sediment sediment_of(const struct scene *scene, int axis, bool at_high_end)
{
  struct sediment s = {
      .axis = axis, .at_high_end = at_high_end, .low = {INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY}};
  for (size_t i = 0; i < scene->particles.count; i++) {
    const struct disc_spec *disc = &scene->particles.discs[i];
    if (!sediment_has(scene, &s, disc)) continue;
    const double at = disc->position[axis];
    s.count++;
    s.weight += fabs(sediment_disc_weight(scene, disc, axis));
    s.area += disc_spec_area(disc);
    s.radius += (disc->radius - s.radius) / (double)s.count;
    s.farthest = fmax(s.farthest, at_high_end ? scene->domain.size[axis] - at : at);
    for (int k = 0; k < 2; k++) {
      s.low[k] = fmin(s.low[k], disc->position[k] - disc->radius);
      s.high[k] = fmax(s.high[k], disc->position[k] + disc->radius);
    }
  }
  return s;
}

/* Of a pile across the whole box. */
static double height_of(const struct scene *scene, const struct sediment *s)
{
  return s->area / sediment_packing / scene->domain.size[!s->axis];
}

double sediment_layers(const struct scene *scene, const struct sediment *s)
{
  return height_of(scene, s) / (2 * s->radius);
}

double sediment_pressure(const struct scene *scene, const struct sediment *s)
{
  const double dense = 0.6, held = (s->high[0] - s->low[0]) * (s->high[1] - s->low[1]);
  const double box = scene->domain.size[!s->axis];
  return s->weight / (s->area > dense * held ? fmin(box, s->high[!s->axis] - s->low[!s->axis]) : box);
}

double sediment_fall(const struct scene *scene, const struct sediment *s)
{
  return s->farthest - fmax(height_of(scene, s), s->radius);
}
