#include "contact/pairs.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  RECENT = 512, /* size of the cache of tested pairs of a band */
  CHUNK = 256   /* discs whose displacements one thread compares at once */
};

/* Largest R - R_h. */
static double largest_rim(const struct discs *d)
{
  double largest = 0;
  for (size_t i = 0; i < d->count; i++) largest = fmax(largest, d->radius[i] - d->hydraulic[i].radius);
  return largest;
}

bool pairs_create(struct pair_list *list, const struct scene *scene, const struct discs *discs, bool searches, double l,
                  struct status *status)
{
  const char *what = "the pairs";
  *list = (struct pair_list){.within = l + pairs_margin,
                             .uses_linked_cells = searches && scene->contact.search == SEARCH_LINKED_CELL,
                             .searches = searches,
                             .stale = true};
  list->cells = (int)ceil(list->within + 2 * largest_rim(discs));
  for (int axis = 0; axis < 2; axis++) {
    list->size[axis] = scene->domain.size[axis];
    list->periodic[axis] = scene_is_periodic(scene, axis);
  }
  const bool cells = !list->uses_linked_cells ||
                     linked_cell_create(&list->linked, scene, discs, scene->contact.edge, list->within, status);
  list->batch_count = list->uses_linked_cells ? (size_t)list->linked.cells[1]
                      : searches              ? (size_t)((scene->domain.size[1] + BAND_ROWS - 1) / BAND_ROWS)
                                              : 0;
  if (cells && (list->x = memory_allocate(discs->count, sizeof *list->x, what, status)) &&
      (list->y = memory_allocate(discs->count, sizeof *list->y, what, status)) &&
      (list->next = memory_allocate(discs->count + 1, sizeof *list->next, what, status)) &&
      (list->batches = memory_allocate(list->batch_count, sizeof *list->batches, what, status)))
    return true;
  pairs_destroy(list);
  return false;
}

void pairs_destroy(struct pair_list *list)
{
  linked_cell_destroy(&list->linked);
  for (size_t k = 0; list->batches && k < list->batch_count; k++) free(list->batches[k].pairs);
  void *const arrays[] = {list->pairs, list->x, list->y, list->batches, list->sorted, list->next};
  for (size_t k = 0; k < sizeof arrays / sizeof arrays[0]; k++) free(arrays[k]);
  *list = (struct pair_list){0};
}

/* Search of a band. */
struct search {
  const struct occupation *occupation;
  const struct discs *discs;
  struct pair_batch *batch;
  double within;
  int cells;
  struct pair recent[RECENT]; /* cache of tested pairs: most pairs appear in several rows */
};

static double gap(const struct occupation *o, const struct discs *d, uint32_t a, uint32_t b)
{
  const double dx = nearest_image(d->x[b] - d->x[a], o->size[0], o->periodic[0]);
  const double dy = nearest_image(d->y[b] - d->y[a], o->size[1], o->periodic[1]);
  return sqrt(dx * dx + dy * dy) - d->radius[a] - d->radius[b];
}

static bool test_pair(struct search *s, uint32_t a, uint32_t b, struct status *status)
{
  const struct pair pair = a < b ? (struct pair){a, b} : (struct pair){b, a};
  struct pair *recent = &s->recent[(37 * pair.a + pair.b) % RECENT];
  if (a == b || (recent->a == pair.a && recent->b == pair.b)) return true;
  *recent = pair;
  return gap(s->occupation, s->discs, a, b) >= s->within || pair_batch_add(s->batch, &pair, status);
}

/* Runs of a row, shifted by `shift` columns. */
struct row {
  const struct run *runs;
  size_t count;
  int shift;
};

/* Tests the owners of all pairs of runs, one of each row, at most s->cells columns apart. */
static bool search_rows(struct search *s, const struct row *low, const struct row *high, struct status *status)
{
  size_t open = 0; /* runs of `high` before this index end before the current run of `low` */
  for (size_t l = 0; l < low->count; l++) {
    const struct run *run = &low->runs[l];
    const int from = run->x - s->cells - high->shift, end = run->x + run->n + s->cells - high->shift;
    while (open < high->count && high->runs[open].x + high->runs[open].n <= from) open++;
    for (size_t h = open; h < high->count && high->runs[h].x < end; h++)
      if (high->runs[h].x + high->runs[h].n > from && !test_pair(s, run->owner, high->runs[h].owner, status))
        return false;
  }
  return true;
}

/* Pairs whose lower row lies in the band. */
static bool search_band(struct search *s, int band, struct status *status)
{
  const struct occupation *o = s->occupation;
  const int end = (band + 1) * BAND_ROWS < o->size[1] ? (band + 1) * BAND_ROWS : o->size[1];
  for (int y = band * BAND_ROWS; y < end; y++)
    for (int above = y; above <= y + s->cells && (above < o->size[1] || o->periodic[1]); above++) {
      struct row low = {0}, high = {0};
      low.runs = occupation_row(o, y, &low.count);
      high.runs = occupation_row(o, above % o->size[1], &high.count);
      for (int image = -o->periodic[0]; image <= o->periodic[0]; image++) {
        high.shift = image * o->size[0];
        if (!search_rows(s, &low, &high, status)) return false;
      }
    }
  return true;
}

static bool search_grid(struct pair_list *list, size_t band, const struct occupation *o, const struct discs *d,
                        struct status *status)
{
  struct search s = {
      .occupation = o, .discs = d, .batch = &list->batches[band], .within = list->within, .cells = list->cells};
  return search_band(&s, (int)band, status);
}

/* Counting sort of all batches by a. */
static void sort_by_first(struct pair_list *list, size_t discs)
{
  memset(list->next, 0, (discs + 1) * sizeof *list->next);
  for (size_t k = 0; k < list->batch_count; k++)
    for (size_t p = 0; p < list->batches[k].count; p++) list->next[list->batches[k].pairs[p].a + 1]++;
  for (size_t d = 1; d <= discs; d++) list->next[d] += list->next[d - 1];
  for (size_t k = 0; k < list->batch_count; k++)
    for (size_t p = 0; p < list->batches[k].count; p++) {
      const struct pair *pair = &list->batches[k].pairs[p];
      list->sorted[list->next[pair->a]++] = *pair;
    }
}

/* Inserts a pair, if new, into the pairs of disc a, which begin at `start`, by b. */
static void insert(struct pair_list *list, size_t start, const struct pair *pair)
{
  size_t at = list->count;
  while (at > start && list->pairs[at - 1].b > pair->b) at--;
  if (at > start && list->pairs[at - 1].b == pair->b) return;
  memmove(&list->pairs[at + 1], &list->pairs[at], (list->count - at) * sizeof *list->pairs);
  list->pairs[at] = *pair;
  list->count++;
}

static bool join(struct pair_list *list, const struct discs *d, struct status *status)
{
  size_t found = 0, start = 0;
  for (size_t k = 0; k < list->batch_count; k++) found += list->batches[k].count;
  if (!memory_grow(&list->sorted, &list->sorted_capacity, found, sizeof *list->sorted, "the pairs", status) ||
      !memory_grow(&list->pairs, &list->capacity, found, sizeof *list->pairs, "the pairs", status))
    return false;
  sort_by_first(list, d->count);
  list->count = 0;
  for (size_t p = 0; p < found; p++) {
    if (p == 0 || list->sorted[p].a != list->sorted[p - 1].a) start = list->count;
    insert(list, start, &list->sorted[p]);
  }
  memcpy(list->x, d->x, d->count * sizeof *list->x);
  memcpy(list->y, d->y, d->count * sizeof *list->y);
  list->stale = false;
  return true;
}

/* Distance along a periodic axis of this length; INFINITY: not periodic. */
static inline double apart(double a, double b, double length)
{
  const double d = fabs(a - b), around = fabs(length - d);
  return d < around ? d : around;
}

/* True if one of the discs from `first` on has moved by more than half of the margin, or its position is NAN. */
static bool any_has_moved(const struct pair_list *list, const struct discs *d, size_t first, size_t end)
{
  const double limit = pairs_margin * pairs_margin / 4, infinite = (double)INFINITY;
  const double width = list->periodic[0] ? list->size[0] : infinite,
               height = list->periodic[1] ? list->size[1] : infinite;
  int moved = 0;
#pragma omp simd reduction(| : moved)
  for (size_t i = first; i < end; i++) {
    const double dx = apart(d->x[i], list->x[i], width), dy = apart(d->y[i], list->y[i], height);
    moved |= !(dx * dx + dy * dy <= limit);
  }
  return moved;
}

bool pairs_update(struct pair_list *list, const struct occupation *o, const struct discs *d, struct team *team,
                  bool *rebuilt)
{
  struct status status;
#pragma omp for schedule(static)
  for (size_t first = 0; first < d->count; first += CHUNK)
    if (any_has_moved(list, d, first, first + CHUNK < d->count ? first + CHUNK : d->count)) {
#pragma omp atomic write
      list->stale = true;
    }
  *rebuilt = list->stale;
  if (!*rebuilt) return true;
#pragma omp single
  if (list->uses_linked_cells) linked_cell_sort(&list->linked, d);
#pragma omp for schedule(dynamic, 1)
  for (size_t k = 0; k < list->batch_count; k++) {
    list->batches[k].count = 0;
    if (!(list->uses_linked_cells ? linked_cell_search(&list->linked, d, (int)k, &list->batches[k], &status)
                                  : search_grid(list, k, o, d, &status)))
      team_fail(team, &status);
  }
#pragma omp single
  {
    if (!team->failed && !join(list, d, &status)) team_fail(team, &status);
    team_decide(team, &list->leave);
  }
  return !list->leave;
}
