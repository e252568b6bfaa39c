#include "heap.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

static bool touch(const struct discs *d, size_t i, size_t j, double gap)
{
  const double reach = d->radius[i] + d->radius[j] + gap, dx = d->x[i] - d->x[j], dy = d->y[i] - d->y[j];
  return dx * dx + dy * dy < reach * reach;
}

/* Marks with `label` the unmarked discs that disc `first` is connected with; returns their number. list: [count] */
static size_t mark_group(const struct discs *d, size_t first, double gap, size_t label, size_t *group, size_t *list)
{
  size_t size = 1;
  list[0] = first;
  group[first] = label;
  for (size_t next = 0; next < size; next++)
    for (size_t j = 0; j < d->count; j++)
      if (group[j] == 0 && d->motion[j] == DISC_FREE && touch(d, list[next], j, gap)) {
        group[j] = label;
        list[size++] = j;
      }
  return size;
}

/* Label of the largest group; groups are numbered from 1. */
static size_t largest_group(const struct discs *d, double gap, size_t *group, size_t *list, size_t *count)
{
  size_t best = 0;
  *count = 0;
  for (size_t i = 0, label = 1; i < d->count; i++) {
    if (group[i] != 0 || d->motion[i] != DISC_FREE) continue;
    const size_t size = mark_group(d, i, gap, label, group, list);
    if (size > *count) *count = size, best = label;
    label++;
  }
  return best;
}

/* Height of the outline of the mass at x; 0 where there is none. */
static double outline(const struct discs *d, const size_t *group, size_t label, double x)
{
  double top = 0;
  for (size_t i = 0; i < d->count; i++) {
    const double dx = x - d->x[i], r = d->radius[i];
    if (group[i] == label && fabs(dx) < r) top = fmax(top, d->y[i] + sqrt(r * r - dx * dx));
  }
  return top;
}

static double mean_outline(const struct discs *d, const size_t *group, size_t label, double width)
{
  enum { SAMPLES = 16 };
  double sum = 0;
  for (int k = 0; k < SAMPLES; k++) sum += outline(d, group, label, (k + 0.5) * width / SAMPLES);
  return sum / SAMPLES;
}

static double slope_of(const struct discs *d, const size_t *group, size_t label, double front)
{
  enum { SAMPLES = 200 };
  const double step = 0.8 * front / SAMPLES, middle = 0.5 * front;
  double above = 0, below = 0;
  for (int k = 0; k < SAMPLES; k++) {
    const double x = 0.1 * front + (k + 0.5) * step;
    above += (middle - x) * outline(d, group, label, x);
    below += (middle - x) * (middle - x);
  }
  return above / below;
}

bool heap_of(struct heap *heap, const struct discs *d, double gap, double floor, double radius, struct status *status)
{
  size_t *group = memory_allocate(2 * d->count, sizeof *group, "a heap", status);
  *heap = (struct heap){0};
  if (!group) return false;
  const size_t label = largest_group(d, gap, group, group + d->count, &heap->count);
  for (size_t i = 0; i < d->count; i++) {
    if (group[i] != label) continue;
    heap->front = fmax(heap->front, d->x[i] + d->radius[i]);
    heap->kinetic += (d->vx[i] * d->vx[i] + d->vy[i] * d->vy[i]) / (double)heap->count;
  }
  heap->height = mean_outline(d, group, label, 3 * radius) - floor;
  heap->slope = slope_of(d, group, label, heap->front);
  free(group);
  return true;
}
