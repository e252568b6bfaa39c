/* The pairs of discs that were found near each other, joined from the batches in which they were found. A pair that
 * meets in several rows or bands is one contact; its area by cells (23) is their sum, in the order of bands and rows.
 * */
#ifndef DELBM_CONTACT_OVERLAP_H
#define DELBM_CONTACT_OVERLAP_H

#include "solid/occupation.h"

struct pair_list {
  struct near_pair *pairs; /* by a, then b; each once */
  size_t count, capacity;
  size_t *next; /* scratch of the join: [discs + 1] */
  struct near_pair *scratch;
  size_t scratch_capacity;
};

bool overlap_create(struct pair_list *list, size_t discs, struct status *status);
void overlap_destroy(struct pair_list *list);

/* Joins what bands of rows, or rows of cells, have found among so many discs. Called by one thread. */
bool overlap_join(struct pair_list *list, const struct pair_batch *batches, size_t count, size_t discs,
                  struct status *status);

#endif
