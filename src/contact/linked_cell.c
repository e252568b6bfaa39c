#include "contact/linked_cell.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double largest_radius(const struct discs *discs)
{
  double largest = 0;
  for (size_t i = 0; i < discs->count; i++) largest = fmax(largest, discs->radius[i]);
  return largest;
}

bool linked_cell_create(struct linked_cell *l, const struct scene *scene, const struct discs *discs, double edge,
                        double within, struct status *status)
{
  const char *what = "the linked cells";
  const double furthest = 2 * largest_radius(discs) + within;
  *l = (struct linked_cell){.within = within};
  if (!(edge > 0)) edge = furthest;
  for (int axis = 0; axis < 2; axis++) {
    l->size[axis] = scene->domain.size[axis];
    l->periodic[axis] = scene_is_periodic(scene, axis);
    l->cells[axis] = (int)fmax(1, floor(l->size[axis] / edge));
    l->edge[axis] = l->size[axis] / l->cells[axis];
  }
  l->span = (int)ceil(furthest / fmin(l->edge[0], l->edge[1]));
  const size_t cells = (size_t)l->cells[0] * (size_t)l->cells[1];
  if ((l->start = memory_allocate(cells + 1, sizeof *l->start, what, status)) &&
      (l->discs = memory_allocate(discs->count, sizeof *l->discs, what, status)) &&
      (l->cell = memory_allocate(discs->count, sizeof *l->cell, what, status)))
    return true;
  linked_cell_destroy(l);
  return false;
}

void linked_cell_destroy(struct linked_cell *l)
{
  free(l->start);
  free(l->discs);
  free(l->cell);
  *l = (struct linked_cell){0};
}

static int cell_along(const struct linked_cell *l, int axis, double at)
{
  const int cell = (int)floor(at / l->edge[axis]);
  return cell < 0 ? 0 : cell >= l->cells[axis] ? l->cells[axis] - 1 : cell;
}

/* Counting sort by cell, within a cell by index. start[c + 1] is the insertion point of cell c while discs are
 * entered. */
void linked_cell_sort(struct linked_cell *l, const struct discs *discs)
{
  const size_t cells = (size_t)l->cells[0] * (size_t)l->cells[1];
  memset(l->start, 0, (cells + 1) * sizeof *l->start);
  for (size_t i = 0; i < discs->count; i++) {
    l->cell[i] = (uint32_t)(cell_along(l, 1, discs->y[i]) * l->cells[0] + cell_along(l, 0, discs->x[i]));
    l->start[l->cell[i] + 1]++;
  }
  size_t total = 0;
  for (size_t c = 1; c <= cells; c++) {
    const size_t count = l->start[c];
    l->start[c] = total;
    total += count;
  }
  for (size_t i = 0; i < discs->count; i++) l->discs[l->start[l->cell[i] + 1]++] = (uint32_t)i;
}

static double nearest(const struct linked_cell *l, int axis, double d)
{
  return nearest_image(d, l->size[axis], l->periodic[axis]);
}

/* Pairs of disc i with the discs of a cell; within the disc's own cell each pair once. */
static bool search_cell(const struct linked_cell *l, const struct discs *d, struct pair_batch *row, uint32_t i,
                        size_t cell, struct status *status)
{
  const bool own = l->cell[i] == cell;
  for (size_t at = l->start[cell]; at < l->start[cell + 1]; at++) {
    const uint32_t k = l->discs[at];
    if (own && k <= i) continue;
    const double dx = nearest(l, 0, d->x[k] - d->x[i]), dy = nearest(l, 1, d->y[k] - d->y[i]);
    const double near = d->radius[i] + d->radius[k] + l->within;
    const struct pair pair = i < k ? (struct pair){i, k} : (struct pair){k, i};
    if (dx * dx + dy * dy < near * near && !pair_batch_add(row, &pair, status)) return false;
  }
  return true;
}

/* Index of the cell at distance `by` along an axis; -1 outside of the box. */
static int step_along(const struct linked_cell *l, int axis, int cell, int by)
{
  const int n = l->cells[axis], to = cell + by;
  if (to >= 0 && to < n) return to;
  return l->periodic[axis] ? (to % n + n) % n : -1;
}

/* Half of the neighbouring cells: above, and to the right in the same row. On a periodic axis of at most 2 span
 * cells a pair may be found twice. */
bool linked_cell_search(const struct linked_cell *l, const struct discs *d, int y, struct pair_batch *row,
                        struct status *status)
{
  for (int x = 0; x < l->cells[0]; x++) {
    const size_t cell = (size_t)y * (size_t)l->cells[0] + (size_t)x;
    for (size_t at = l->start[cell]; at < l->start[cell + 1]; at++)
      for (int dy = 0; dy <= l->span; dy++)
        for (int dx = dy == 0 ? 0 : -l->span; dx <= l->span; dx++) {
          const int cx = step_along(l, 0, x, dx), cy = step_along(l, 1, y, dy);
          if (cx < 0 || cy < 0) continue;
          if (!search_cell(l, d, row, l->discs[at], (size_t)cy * (size_t)l->cells[0] + (size_t)cx, status))
            return false;
        }
  }
  return true;
}
