/* Pairs: a list of all pairs of discs that are near each other, as in molecular dynamics (Verlet 1967).
 *
 * A contact can act in a step where the gap between two discs is below some length l at its start. The list holds all pairs whose gap
 * was below l + margin when it was built, sorted by (a, b), and is built anew when a disc has since moved by more than half of the
 * margin, by the nearest image. So it holds every pair with a gap below l at any time. Which further pairs it holds depends on when it
 * was built; whoever reads it asks for the gap again, so that results do not.
 *
 * `search: grid` builds it from the runs of the painted rows, the paper's way: two discs with a gap below g have cells that are at most
 * ceil(g) rows and columns apart. `search: linked-cell` builds it from linked cells (linked_cell.h). */
#ifndef DELBM_CONTACT_PAIRS_H
#define DELBM_CONTACT_PAIRS_H

#include "contact/linked_cell.h"
#include "solid/occupation.h"

/* Cells. A larger margin lists more pairs and builds the list less often. */
static const double pairs_margin = 0.9;

struct pair_list {
  struct pair *pairs; /* a < b, each once */
  size_t count, capacity;

  double within;             /* gap below which pairs are listed when the list is built */
  double *x, *y;             /* [disc] then */
  struct linked_cell linked; /* with search: linked-cell */
  bool uses_cells;
  struct pair_batch *batches; /* of each band of rows, or row of linked cells: pairs as found */
  size_t batch_count;
  struct pair *sorted; /* as found, by a */
  size_t sorted_capacity;
  size_t *next;      /* [discs + 1] of the sort */
  bool stale, leave; /* to be built anew; after the search (team.h) */
};

/* `l` as above. */
bool pairs_create(struct pair_list *list, const struct scene *scene, const struct discs *discs, double l,
                  struct status *status);
void pairs_destroy(struct pair_list *list);

/* Brings the list up to date; `occupation` is that of where the discs are. Called by all threads of a parallel region or outside of
 * one. */
bool pairs_update(struct pair_list *list, const struct occupation *occupation, const struct discs *discs,
                  struct team *team);

#endif
