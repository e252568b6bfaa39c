/* The sweep blocked in time: several steps of rows that no disc can reach in one pass through memory.
 *
 * A row may take step s once it and its two neighbours have taken step s - 1 (populations.h: a step touches no
 * further). So a wavefront can pass over the rows in which each step follows one row behind the last, and a row comes
 * from memory once for `depth` steps. Rows are cut into tiles of `width` cells, each step shifted one cell to the left
 * of the last, so that what a wavefront holds at once (depth + 2 rows of a tile) stays in the nearest cache. Where x is
 * periodic the first tile retreats by a cell each step from the left side and the last one makes that up beyond the
 * right.
 *
 * Threads take slabs of rows. Within a block a slab retreats by a row each step from slabs beside it (not from walls);
 * when all have finished, what is missing around each border, a triangle that grows by a row each step, is made up.
 * Every row takes every step once, with the same arithmetic as unblocked: the results are the same bits for any depth,
 * width and number of threads.
 *
 * With discs, the rows near them are left out and the others go ahead, retreating by a row each step from the near rows as
 * slabs do from each other. Then the near rows take the same steps one by one, with all four stages, growing by a row each
 * step: faster than any disc, whose Mach number is below 0.6, can follow. */
#ifndef DELBM_SIM_BLOCKED_H
#define DELBM_SIM_BLOCKED_H

#include "sim/flow.h"

struct blocking {
  int depth; /* steps in a block; 1: not blocked */
  int width; /* cells of a tile; 0: whole rows */
};

/* The most steps a block can have in a box of ny rows shared by so many threads. */
int blocked_deepest(int ny, int threads);

/* Advances by `steps`, at most blocking->depth and no further than to the end of an interval of zero_flux, in one block. A
 * step that ends an interval sums over whole rows, and so has no tiles. Called by all threads of a parallel region. */
void stage_sweep_blocked(struct flow *flow, const struct blocking *blocking, int steps);

/* The rows near discs at the start of a block, before they grow: rows.first .. rows.end - 1, which may lie beyond the box
 * where y is periodic. They grow at an end behind which other rows go ahead. */
struct near_rows {
  struct rows rows;
  bool grow_below, grow_above;
};

/* Steps by which rows go ahead unless the case says otherwise. */
enum { BLOCKED_AHEAD = 16 };

/* False where too few rows are left to go ahead by `steps`. */
bool blocked_near(const struct scene *scene, const struct occupation *now, int steps, struct near_rows *near);

/* The near rows of step s of the block. */
struct rows blocked_near_at(const struct near_rows *near, int s);

/* True if no disc has a row, or the next to one, outside of these. */
bool blocked_discs_within(const struct scene *scene, const struct occupation *occupation, const struct rows *rows);

/* Advances all other rows by `steps`. The parity stays as it was: the near rows are still to take those steps. */
void stage_sweep_ahead(struct flow *flow, const struct near_rows *near, int steps);

#endif
