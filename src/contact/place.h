/* Relative places of the bodies of contacts, for the overlaps of shapes (solid/shape.h). */
#ifndef DELBM_CONTACT_PLACE_H
#define DELBM_CONTACT_PLACE_H

#include "contact/state.h"
#include "model/scene.h"
#include "solid/shape.h"

/* Places disc b at element k, seen from disc a; x, y: [disc]. Not yet the nearest image. */
static inline void place_body(const double *x, const double *y, uint32_t a, uint32_t b, struct body_pairs *to, int k)
{
  to->dx[k] = x[b] - x[a];
  to->dy[k] = y[b] - y[a];
}

/* Places side b - contact_sides. */
static inline void place_side(const struct scene *scene, const double *x, const double *y, uint32_t a, uint32_t b,
                              struct body_pairs *to, int k)
{
  const enum side_name side = (enum side_name)(b - contact_sides);
  const double normal = side_is_high(side) ? 1 : -1, place[2] = {x[a], y[a]};
  to->dx[k] = side_axis(side) == 0 ? normal : 0;
  to->dy[k] = side_axis(side) == 1 ? normal : 0;
  to->distance[k] = scene_distance_to_side(scene, side, place);
}

/* Replaces displacements by those of the nearest images. */
static inline void place_nearest_images(const struct scene *scene, struct body_pairs *pairs)
{
  for (int axis = 0; axis < 2; axis++) {
    const double size = scene->domain.size[axis], half = size / 2;
    double *d = axis == 0 ? pairs->dx : pairs->dy;
    if (!scene_is_periodic(scene, axis)) continue;
#pragma omp simd
    for (int k = 0; k < pairs->count; k++) d[k] = d[k] > half ? d[k] - size : d[k] < -half ? d[k] + size : d[k];
  }
}

#endif
