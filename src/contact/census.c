/* Candidates come from linked cells of the largest diameter (linked_cell.h), so that the cost is in proportion to the
 * number of discs. Sorted, a pair that was found twice is counted once. Count and maximum do not depend on the order. */
#include "contact/census.h"

#include "base/variant.h"
#include "contact/linked_cell.h"
#include "contact/place.h"

#include <math.h>
#include <stdlib.h>

/* Cells. Above the round-off of the search; the sign of the depth decides. */
static const double search_gap = 1e-6;

/* Candidates of one kind, pairs or sides, evaluated in blocks. */
struct tally {
  const struct scene *scene;
  const struct discs *discs;
  bool sides;
  struct contact_census *census;
  struct body_pairs places; /* count: candidates in the block */
};

/* Copies the last candidate up to a whole number of vectors; returns their number. */
static int fill_vectors(struct body_pairs *p)
{
  const int count = p->count, last = count - 1;
  for (; p->count % VECTOR != 0; p->count++) {
    const int k = p->count;
    p->dx[k] = p->dx[last];
    p->dy[k] = p->dy[last];
    p->distance[k] = p->distance[last];
    for (int end = 0; end < 2; end++) p->radius[end][k] = p->radius[end][last];
  }
  return count;
}

/* Evaluates the block and empties it. */
static void finish_block(struct tally *t)
{
  struct body_pairs *p = &t->places;
  struct body_overlaps overlaps;
  if (p->count == 0) return;
  const struct shape_kind *kind = t->discs->shape[0].kind;
  const int count = fill_vectors(p);
  if (!t->sides) place_nearest_images(t->scene, p);
  (t->sides ? kind->overlaps_half_plane : kind->overlaps)(p, &overlaps);
  for (int k = 0; k < count; k++) {
    if (!(overlaps.depth[k] > 0)) continue;
    const double overlap = overlaps.depth[k] / fmin(p->radius[0][k], p->radius[1][k]);
    t->census->contacts++;
    t->census->max_overlap = fmax(t->census->max_overlap, overlap);
  }
  p->count = 0;
}

static void add_candidate(struct tally *t, uint32_t a, uint32_t b)
{
  const struct discs *d = t->discs;
  const int k = t->places.count++;
  t->places.radius[0][k] = d->radius[a];
  t->places.radius[1][k] = t->sides ? INFINITY : d->radius[b];
  if (t->sides)
    place_side(t->scene, d->x, d->y, a, b, &t->places, k);
  else
    place_body(d->x, d->y, a, b, &t->places, k);
  if (t->places.count == BODY_PAIRS) finish_block(t);
}

static void count_sides(const struct scene *scene, const struct discs *d, struct contact_census *census)
{
  struct tally tally = {.scene = scene, .discs = d, .sides = true, .census = census};
  for (uint32_t i = 0; i < d->count; i++)
    for (enum side_name side = 0; side < SIDE_COUNT; side++)
      if (d->motion[i] == DISC_FREE && scene->domain.side[side].type != SIDE_PERIODIC)
        add_candidate(&tally, i, contact_sides + side);
  finish_block(&tally);
}

static int compare_pairs(const void *first, const void *second)
{
  const struct pair *p = first, *q = second;
  if (p->a != q->a) return p->a < q->a ? -1 : 1;
  return (p->b > q->b) - (p->b < q->b);
}

static void count_pairs(const struct scene *scene, const struct discs *d, const struct pair_batch *found,
                        struct contact_census *census)
{
  struct tally tally = {.scene = scene, .discs = d, .census = census};
  if (found->count > 1) qsort(found->pairs, found->count, sizeof *found->pairs, compare_pairs);
  for (size_t k = 0; k < found->count; k++) {
    const struct pair *pair = &found->pairs[k];
    const bool again = k > 0 && compare_pairs(pair - 1, pair) == 0;
    if (!again && (d->motion[pair->a] == DISC_FREE || d->motion[pair->b] == DISC_FREE))
      add_candidate(&tally, pair->a, pair->b);
  }
  finish_block(&tally);
}

static bool find_pairs(const struct linked_cell *linked, const struct discs *d, struct pair_batch *found,
                       struct status *status)
{
  for (int y = 0; y < linked->cells[1]; y++)
    if (!linked_cell_search(linked, d, y, found, status)) return false;
  return true;
}

bool contact_census(const struct scene *scene, const struct discs *d, struct contact_census *census,
                    struct status *status)
{
  struct linked_cell linked;
  struct pair_batch found = {0};
  *census = (struct contact_census){0};
  if (d->free == 0) return true;
  count_sides(scene, d, census);
  if (d->count == 1) return true;
  if (!linked_cell_create(&linked, scene, d, 0, search_gap, status)) return false;
  linked_cell_sort(&linked, d);
  const bool complete = find_pairs(&linked, d, &found, status);
  if (complete) count_pairs(scene, d, &found, census);
  free(found.pairs);
  linked_cell_destroy(&linked);
  return complete;
}
