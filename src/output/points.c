#include "output/points.h"

#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

static bool grow(struct points *p, size_t count, struct status *status)
{
  const struct {
    void *array;
    size_t size;
  } arrays[] = {
      {&p->id, sizeof *p->id},         {&p->position, 3 * sizeof *p->position}, {&p->velocity, 3 * sizeof *p->velocity},
      {&p->radius, sizeof *p->radius}, {&p->angle, sizeof *p->angle},           {&p->spin, sizeof *p->spin}};
  size_t capacity = 0;
  for (size_t k = 0; k < sizeof arrays / sizeof arrays[0]; k++) {
    capacity = p->capacity;
    if (!memory_grow(arrays[k].array, &capacity, count, arrays[k].size, "discs as points", status)) return false;
  }
  p->capacity = capacity;
  return true;
}

static bool add(struct points *p, const struct discs *d, size_t i, const double at[2], struct status *status)
{
  if (!grow(p, p->count + 1, status)) return false;
  const size_t k = p->count++;
  p->id[k] = (int64_t)i;
  memcpy(p->position + 3 * k, (const double[3]){at[0], at[1], 0}, 3 * sizeof(double));
  memcpy(p->velocity + 3 * k, (const double[3]){d->vx[i], d->vy[i], 0}, 3 * sizeof(double));
  p->radius[k] = d->radius[i];
  p->angle[k] = d->angle[i];
  p->spin[k] = d->omega[i];
  return true;
}

/* Adds the images of discs, shifted by whole boxes, that overlap the box. */
static bool add_images(struct points *p, const struct scene *scene, const struct discs *d, const int shift[2],
                       struct status *status)
{
  const int *size = scene->domain.size;
  for (size_t i = 0; i < d->count; i++) {
    const double at[2] = {d->x[i] + shift[0] * size[0], d->y[i] + shift[1] * size[1]}, r = d->radius[i];
    const bool inside = at[0] + r > 0 && at[0] - r < size[0] && at[1] + r > 0 && at[1] - r < size[1];
    if (inside && !add(p, d, i, at, status)) return false;
  }
  return true;
}

bool points_take(struct points *p, const struct scene *scene, const struct discs *d, struct status *status)
{
  const int far[2] = {scene_is_periodic(scene, 0), scene_is_periodic(scene, 1)};
  p->count = 0;
  for (size_t i = 0; i < d->count; i++)
    if (!add(p, d, i, (const double[2]){d->x[i], d->y[i]}, status)) return false;
  for (int up = -far[1]; up <= far[1]; up++)
    for (int right = -far[0]; right <= far[0]; right++)
      if ((up || right) && !add_images(p, scene, d, (const int[2]){right, up}, status)) return false;
  return true;
}

void points_clear(struct points *p)
{
  void *const arrays[] = {p->id, p->position, p->velocity, p->radius, p->angle, p->spin};
  for (size_t k = 0; k < sizeof arrays / sizeof arrays[0]; k++) free(arrays[k]);
  *p = (struct points){0};
}
