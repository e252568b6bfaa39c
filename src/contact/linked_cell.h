/* Linked cells: the usual way to find pairs, as the real alternative to the grid that occupation paints.
 *
 * The box is cut into square cells of a given edge; a counting sort files discs by cell, and each disc looks for partners in its
 * own cell and half of those around it, as far apart as a pair can be. */
#ifndef DELBM_CONTACT_LINKED_CELL_H
#define DELBM_CONTACT_LINKED_CELL_H

#include "contact/pair.h"
#include "solid/discs.h"

struct linked_cell {
  int cells[2];
  double edge[2];
  bool periodic[2];
  double size[2];
  double within; /* pairs are found up to this gap */
  int span;      /* neighbouring cells over which a pair can extend */
  size_t *start; /* [cells + 1] discs of cell c: discs[start[c]] .. */
  uint32_t *discs;
  uint32_t *cell; /* of each disc */
};

/* Cells with an edge of at least `edge`; 0: one largest diameter and `within`. */
bool linked_cell_create(struct linked_cell *linked, const struct scene *scene, const struct discs *discs, double edge,
                        double within, struct status *status);
void linked_cell_destroy(struct linked_cell *linked);

/* Files the discs by cell; by one thread. */
void linked_cell_sort(struct linked_cell *linked, const struct discs *discs);

/* Adds the pairs with a gap below `within` between the discs of row y of cells and those of this and higher rows. */
bool linked_cell_search(const struct linked_cell *linked, const struct discs *discs, int y, struct pair_batch *batch,
                        struct status *status);

#endif
