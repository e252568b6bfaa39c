/* Linked cells: the usual way to find pairs, as the real alternative to the grid that occupation paints.
 *
 * The box is cut into square cells of a given edge; discs are sorted by cell, and each looks for partners in its own
 * cell and half of those around it, as far as a pair can reach. Cells are filled by a counting sort, pairs found per
 * row of cells, in parallel, and joined in the order of rows: the same list for any number of threads. */
#ifndef DELBM_CONTACT_LINKED_CELL_H
#define DELBM_CONTACT_LINKED_CELL_H

#include "contact/overlap.h"

struct linked_cell {
  int cells[2];
  double edge[2];
  bool periodic[2];
  double size[2];
  double skin;   /* pairs are found up to this gap */
  int span;      /* neighbouring cells that a pair can reach across */
  size_t *start; /* [cells + 1] discs of cell c: discs[start[c]] .. */
  uint32_t *discs;
  uint32_t *cell;          /* of each disc */
  struct pair_batch *rows; /* of each row of cells */
  bool leave;              /* after the search (team.h) */
};

/* Cells with an edge of at least `edge`; 0: one largest diameter plus the skin. */
bool linked_cell_create(struct linked_cell *linked, const struct scene *scene, const struct discs *discs, double edge,
                        double skin, struct status *status);
void linked_cell_destroy(struct linked_cell *linked);

/* All pairs with a gap below the skin, by lower index, then higher; their cells_area is 0. Called by all threads of a
 * parallel region or outside of one; the list is complete behind the barrier that ends it. */
bool linked_cell_find(struct linked_cell *linked, const struct discs *discs, struct pair_list *list, struct team *team);

#endif
