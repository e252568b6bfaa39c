/* Linked cells: the standard search for pairs, as an alternative to the search in painted rows (pairs.h).
 *
 * The box is divided into rectangular cells of about equal edges; discs are sorted by cell, and partners of a disc
 * are searched in its own cell and in half of the neighbours within `span`. */
#ifndef DELBM_CONTACT_LINKED_CELL_H
#define DELBM_CONTACT_LINKED_CELL_H

#include "contact/pair.h"
#include "solid/discs.h"

struct linked_cell {
  int cells[2];
  double edge[2];
  bool periodic[2];
  double size[2];
  double within; /* largest gap of a pair */
  int span;      /* largest distance of the cells of a pair, in cells */
  size_t *start; /* [cells + 1]; discs of cell c: discs[start[c]] .. discs[start[c + 1] - 1] */
  uint32_t *discs;
  uint32_t *cell; /* [disc] */
};

/* Cells with an edge of at least `edge`; 0: the largest diameter plus `within`. */
bool linked_cell_create(struct linked_cell *linked, const struct scene *scene, const struct discs *discs, double edge,
                        double within, struct status *status);
void linked_cell_destroy(struct linked_cell *linked);

/* Sorts the discs by cell; by one thread. */
void linked_cell_sort(struct linked_cell *linked, const struct discs *discs);

/* Adds the pairs with a gap below `within` and one disc in row y of cells, the other in row y or above. */
bool linked_cell_search(const struct linked_cell *linked, const struct discs *discs, int y, struct pair_batch *batch,
                        struct status *status);

#endif
