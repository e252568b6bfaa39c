#include "contact/overlap.h"

#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

bool overlap_create(struct pair_list *list, size_t discs, struct status *status)
{
  *list = (struct pair_list){0};
  list->next = memory_allocate(discs + 1, sizeof *list->next, "the pairs", status);
  return list->next != NULL;
}

void overlap_destroy(struct pair_list *list)
{
  free(list->pairs);
  free(list->next);
  free(list->scratch);
  *list = (struct pair_list){0};
}

/* Stable counting sort by the lower index: what a disc a met, in the order of bands and rows. */
static void gather_by_first(struct pair_list *list, const struct pair_batch *batches, size_t count, size_t discs)
{
  memset(list->next, 0, (discs + 1) * sizeof *list->next);
  for (size_t k = 0; k < count; k++)
    for (size_t p = 0; p < batches[k].count; p++) list->next[batches[k].pairs[p].a + 1]++;
  for (size_t d = 1; d <= discs; d++) list->next[d] += list->next[d - 1];
  for (size_t k = 0; k < count; k++)
    for (size_t p = 0; p < batches[k].count; p++) {
      const struct near_pair *pair = &batches[k].pairs[p];
      list->scratch[list->next[pair->a]++] = *pair;
    }
}

/* Adds one meeting to the few contacts of disc a, which stand from `start` on, sorted by b. */
static void merge(struct pair_list *list, size_t start, const struct near_pair *meeting)
{
  size_t at = list->count;
  while (at > start && list->pairs[at - 1].b > meeting->b) at--;
  if (at > start && list->pairs[at - 1].b == meeting->b) {
    list->pairs[at - 1].cells_area += meeting->cells_area;
    return;
  }
  memmove(&list->pairs[at + 1], &list->pairs[at], (list->count - at) * sizeof *list->pairs);
  list->pairs[at] = *meeting;
  list->count++;
}

bool overlap_join(struct pair_list *list, const struct pair_batch *batches, size_t count, size_t discs,
                  struct status *status)
{
  size_t meetings = 0;
  for (size_t k = 0; k < count; k++) meetings += batches[k].count;
  list->count = 0;
  if (meetings == 0) return true;
  if (!memory_grow(&list->scratch, &list->scratch_capacity, meetings, sizeof *list->scratch, "the pairs", status) ||
      !memory_grow(&list->pairs, &list->capacity, meetings, sizeof *list->pairs, "the pairs", status))
    return false;
  gather_by_first(list, batches, count, discs);
  size_t start = 0;
  for (size_t p = 0; p < meetings; p++) {
    if (p == 0 || list->scratch[p].a != list->scratch[p - 1].a) start = list->count;
    merge(list, start, &list->scratch[p]);
  }
  return true;
}
