/* The pair list: neighbours of all discs, as in molecular dynamics (Verlet 1967).
 *
 * The list contains all pairs with a gap below l + margin at the step of its construction, sorted by (a, b). A
 * displacement of a disc, by the nearest image, above margin/2 causes a new construction; so the list contains every
 * pair with a gap below l at any time. Its further pairs depend on the step of construction: readers test the gap
 * again, and results are independent.
 *
 * `search: grid`, the paper's method: from the runs of painted rows; two discs with a gap below g have cells at most
 * ceil(g + r) rows and columns apart, r the sum of R - R_h of both (discs.h), since R_h is painted.
 * `search: linked-cell`: from linked cells (linked_cell.h). */
#ifndef DELBM_CONTACT_PAIRS_H
#define DELBM_CONTACT_PAIRS_H

#include "contact/linked_cell.h"
#include "solid/occupation.h"

/* Cells. A larger margin means more pairs and fewer constructions. */
static const double pairs_margin = 0.9;

struct pair_list {
  struct pair *pairs; /* a < b, each once */
  size_t count, capacity;

  double within; /* l + margin */
  int cells;     /* of search: grid, largest distance of the runs of a pair, in rows and in columns */
  int size[2];   /* of the box */
  bool periodic[2];
  double *x, *y;                    /* [disc] at the construction */
  struct linked_cell linked;        /* with search: linked-cell */
  bool uses_linked_cells, searches; /* false: the list stays empty, and tells of displacements alone */
  struct pair_batch *batches;       /* [batch_count]: of a band of rows, or of a row of linked cells */
  size_t batch_count;
  struct pair *sorted; /* by a, with duplicates */
  size_t sorted_capacity;
  size_t *next;      /* [discs + 1] for the sort */
  bool stale, leave; /* new construction needed; decision after the search (team.h) */
};

/* `l`: gap below which two discs may interact in a step; without `searches` the list is always empty. */
bool pairs_create(struct pair_list *list, const struct scene *scene, const struct discs *discs, bool searches, double l,
                  struct status *status);
void pairs_destroy(struct pair_list *list);

/* Updates the list; `occupation`, which linked cells do not need, is at the discs' positions. *rebuilt: the list was
 * built anew. Called by all threads of a parallel region or outside of one. */
bool pairs_update(struct pair_list *list, const struct occupation *occupation, const struct discs *discs,
                  struct team *team, bool *rebuilt);

#endif
