#include "case/case_overlaps.h"

#include "base/memory.h"
#include "solid/discs.h"

#include <math.h>
#include <stdlib.h>

static bool add(struct case_overlaps *found, size_t a, size_t b, double depth, struct status *status)
{
  if (!memory_grow(&found->list, &found->capacity, found->count + 1, sizeof *found->list, "overlaps", status))
    return false;
  found->list[found->count++] = (struct case_overlap){a, b, depth};
  return true;
}

static bool add_sides(const struct scene *scene, size_t i, struct case_overlaps *found, struct status *status)
{
  const struct disc_spec *disc = &scene->particles.discs[i];
  for (enum side_name side = 0; side < SIDE_COUNT && disc->motion == DISC_FREE; side++) {
    const double depth = disc->radius - scene_distance_to_side(scene, side, disc->position);
    if (scene->domain.side[side].type == SIDE_PERIODIC || depth <= 0) continue;
    if (!add(found, i, overlap_sides + side, depth, status)) return false;
  }
  return true;
}

static double along(const struct scene *scene, int axis, double d)
{
  return nearest_image(d, scene->domain.size[axis], scene_is_periodic(scene, axis));
}

static bool add_pair(const struct scene *scene, size_t i, size_t j, struct case_overlaps *found, struct status *status)
{
  const struct disc_spec *a = &scene->particles.discs[i], *b = &scene->particles.discs[j];
  if (a->motion != DISC_FREE && b->motion != DISC_FREE) return true;
  const double dx = along(scene, 0, b->position[0] - a->position[0]);
  const double dy = along(scene, 1, b->position[1] - a->position[1]);
  const double depth = a->radius + b->radius - hypot(dx, dy);
  return depth <= 0 || add(found, i < j ? i : j, i < j ? j : i, depth, status);
}

/* Interval of a disc on the x axis. */
struct span {
  double left, right;
  size_t disc;
};

static int compare_spans(const void *a, const void *b)
{
  const struct span *l = a, *r = b;
  if (l->left != r->left) return l->left < r->left ? -1 : 1;
  return l->disc < r->disc ? -1 : l->disc > r->disc;
}

/* Sweep and prune along x. Each disc is tested against the discs that begin before its right end, and across a
 * periodic side against the images of the leftmost ones. */
static bool sweep(const struct scene *scene, const struct span *s, size_t n, struct case_overlaps *found,
                  struct status *status)
{
  const double size = scene->domain.size[0];
  for (size_t k = 0; k < n; k++) {
    if (!add_sides(scene, s[k].disc, found, status)) return false;
    for (size_t l = k + 1; l < n && s[l].left < s[k].right; l++)
      if (!add_pair(scene, s[k].disc, s[l].disc, found, status)) return false;
    for (size_t l = 0; scene_is_periodic(scene, 0) && l < k && s[l].left + size < s[k].right; l++)
      if (s[k].left >= s[l].right && !add_pair(scene, s[k].disc, s[l].disc, found, status)) return false;
  }
  return true;
}

bool case_overlaps_find(const struct scene *scene, size_t discs, struct case_overlaps *found, struct status *status)
{
  *found = (struct case_overlaps){0};
  struct span *spans = memory_allocate(discs, sizeof *spans, "the search for overlaps", status);
  if (!spans) return false;
  for (size_t i = 0; i < discs; i++) {
    const struct disc_spec *disc = &scene->particles.discs[i];
    spans[i] = (struct span){disc->position[0] - disc->radius, disc->position[0] + disc->radius, i};
  }
  qsort(spans, discs, sizeof *spans, compare_spans);
  const bool ok = sweep(scene, spans, discs, found, status);
  free(spans);
  return ok;
}

void case_overlaps_clear(struct case_overlaps *found)
{
  free(found->list);
  *found = (struct case_overlaps){0};
}
