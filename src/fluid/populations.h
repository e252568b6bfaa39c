/* Populations in place: one array of nine planes, stored as deviations g_i = f_i - w_i from the fluid at rest.
 *
 * A step collides a cell and streams the result without a second array (the AA pattern). Two kinds of step alternate:
 *
 *   parity 0   plane i at x holds f_i(x), already streamed. The step reads f_i from plane i at x and leaves the
 *              collided f_i* in plane opposite(i) at x: it touches only its own cell.
 *   parity 1   f_i(x) is therefore in plane opposite(i) at x - e_i. The step reads it there and writes f_i* to plane
 *              i at x + e_i, from where parity 0 reads it.
 *
 * With a_i the address from which cell x reads f_i, both kinds write f_i* to a_opposite(i): one kernel takes the
 * nine addresses of either parity. In either parity no two cells access the same slot, so cells may be updated in
 * any order and by any thread without a race.
 *
 * A plane is ny + 2 rows of `pitch` values: a ring of ghost cells surrounds the box, x = 0 starts on a cache line, and
 * planes are skewed so that nine of them never compete for one cache set. Where y is periodic the row below the first
 * is the last, by address alone. */
#ifndef DELBM_FLUID_POPULATIONS_H
#define DELBM_FLUID_POPULATIONS_H

#include "base/store.h"
#include "lattice/d2q9.h"
#include "model/scene.h"

#include <stddef.h>

struct populations {
  int nx, ny;
  bool periodic_y;
  enum precision precision;
  int parity;
  size_t pitch; /* values from one row to the next */
  size_t plane; /* values from one plane to the next */
  void *block;
  size_t bytes;
};

/* Fluid at rest at the reference density, to which nothing has been written. */
bool populations_create(struct populations *populations, int nx, int ny, bool periodic_y, enum precision precision,
                        struct status *status);

/* Sets the fluid to rest, before the first step. First touch by rows, in the threads' partition of the sweep. */
void populations_rest(struct populations *populations);
void populations_destroy(struct populations *populations);

/* Saves or restores the populations and their parity, without ghosts (boundary_refill). */
bool populations_store(struct populations *populations, struct store *store, struct status *status);

/* Values in a cache line, which is also the room before x = 0 in each row. */
static inline size_t populations_line(enum precision precision)
{
  return precision == PRECISION_DOUBLE ? 8 : 16;
}

/* Position in the array of plane i at (x, y), ghosts included: -1 <= x <= nx, -1 <= y <= ny. */
static inline size_t populations_slot(const struct populations *p, int i, int x, int y)
{
  if (p->periodic_y) y = y < 0 ? p->ny - 1 : y == p->ny ? 0 : y;
  return (size_t)i * p->plane + (size_t)(y + 1) * p->pitch + populations_line(p->precision) + (size_t)(ptrdiff_t)x;
}

/* Position of the slot from which cell (x, y) reads f_i in the coming step. */
static inline size_t populations_source(const struct populations *p, int i, int x, int y)
{
  if (p->parity == 0) return populations_slot(p, i, x, y);
  return populations_slot(p, d2q9_opposite[i], x - d2q9_ex[i], y - d2q9_ey[i]);
}

/* Row y of the box, wrapped at a periodic side. */
static inline int populations_row(const struct populations *p, int y)
{
  return !p->periodic_y ? y : y < 0 ? y + p->ny : y >= p->ny ? y - p->ny : y;
}

/* Position at which cell (x, y) wrote population i in the last step, of parity p->parity. */
static inline size_t populations_sent(const struct populations *p, int i, int x, int y)
{
  return populations_source(p, d2q9_opposite[i], x, y);
}

/* Position from which cell (x, y) will read population i in the step after the last step, of parity p->parity. */
static inline size_t populations_received(const struct populations *p, int i, int x, int y)
{
  if (p->parity == 1) return populations_slot(p, i, x, y);
  return populations_slot(p, d2q9_opposite[i], x - d2q9_ex[i], y - d2q9_ey[i]);
}

static inline double populations_get(const struct populations *p, size_t slot)
{
  return p->precision == PRECISION_DOUBLE ? ((const double *)p->block)[slot] : (double)((const float *)p->block)[slot];
}

static inline void populations_set(struct populations *p, size_t slot, double value)
{
  if (p->precision == PRECISION_DOUBLE)
    ((double *)p->block)[slot] = value;
  else
    ((float *)p->block)[slot] = (float)value;
}

/* Addresses a[i] from which cell (x, y), and then the cells to its right, read f_i in the coming step. */
void populations_cells(const struct populations *populations, int x, int y, void *a[Q]);

/* Deviations of cell (x, y) that the coming step will collide. */
void populations_cell(const struct populations *populations, int x, int y, double g[Q]);

#endif
