/* The sweep blocked in time: several steps of rows beyond the reach of discs in one pass through memory (method:
 * blocked.c). The bits are independent of depth, width and number of threads. */
#ifndef DELBM_SIM_BLOCKED_H
#define DELBM_SIM_BLOCKED_H

#include "sim/flow.h"

struct blocking {
  int depth; /* steps of a block; 1: not blocked */
  int width; /* of a tile, in cells; 0: whole rows */
};

/* Maximum depth in a box of ny rows. */
int blocked_max_depth(int ny, int threads);

/* Advances by one block of `steps`, at most blocking->depth and at most to the end of an interval of zero_flux. The
 * last step of an interval sums over whole rows, so has no tiles. Called by all threads of a parallel region. */
void stage_sweep_blocked(struct flow *flow, const struct blocking *blocking, int steps);

/* The disc rows at the start of a block: rows.first .. rows.end - 1, possibly beyond a periodic side. They grow by a
 * row each step at ends next to free rows. */
struct disc_rows {
  struct rows rows;
  bool grow_below, grow_above;
};

/* Default depth with discs. */
enum { BLOCKED_DEPTH = 16 };

/* Sets the disc rows of a block of `steps`; false if too few free rows are left. */
bool disc_rows_find(const struct scene *scene, const struct occupation *now, int steps, struct disc_rows *rows);

/* The disc rows in step s of the block. */
struct rows disc_rows_at(const struct disc_rows *rows, int s);

/* True if `rows` contain the rows of all discs and one more on each side. */
bool rows_contain_discs(const struct scene *scene, const struct occupation *occupation, const struct rows *rows);

/* Advances the free rows by `steps`, without a change of parity, since the disc rows have not advanced yet. Called
 * by all threads of a parallel region. */
void stage_sweep_free_rows(struct flow *flow, const struct disc_rows *rows, int steps);

#endif
