#include "fluid/populations.h"

#include "base/memory.h"
#include "base/threads.h"

#include <string.h>

static size_t value_size(enum precision precision)
{
  return precision == PRECISION_DOUBLE ? sizeof(double) : sizeof(float);
}

static size_t round_up(size_t n, size_t to)
{
  return (n + to - 1) / to * to;
}

/* A cache line before each row, the row, its ghost, padding to a whole line. Never a multiple of 4 KiB, which would
 * map a cell and its upper neighbour to one cache set. */
static size_t row_pitch(int nx, enum precision precision)
{
  size_t line = populations_line(precision);
  size_t pitch = line + round_up((size_t)nx + 1, line);
  return pitch % (64 * line) ? pitch : pitch + line;
}

/* Seven lines past a multiple of 4 KiB. */
static size_t plane_size(int nx, int ny, enum precision precision)
{
  size_t line = populations_line(precision);
  return round_up(row_pitch(nx, precision) * ((size_t)ny + 2), 64 * line) + 7 * line;
}

static size_t populations_bytes(int nx, int ny, enum precision precision)
{
  size_t slack = 2 * populations_line(precision); /* a vector may be read past the end of the last row */
  return (Q * plane_size(nx, ny, precision) + slack) * value_size(precision);
}

bool populations_create(struct populations *p, int nx, int ny, bool periodic_y, enum precision precision,
                        struct status *status)
{
  *p = (struct populations){.nx = nx,
                            .ny = ny,
                            .periodic_y = periodic_y,
                            .precision = precision,
                            .pitch = row_pitch(nx, precision),
                            .plane = plane_size(nx, ny, precision),
                            .bytes = populations_bytes(nx, ny, precision)};
  p->block = memory_map(p->bytes, "the populations (domain.size)", status);
  return p->block != NULL;
}

void populations_rest(struct populations *p)
{
  const size_t size = value_size(p->precision), row = p->pitch * size;
#pragma omp parallel for schedule(static) num_threads(threads_for((int64_t)p->nx * p->ny))
  for (int y = 0; y < p->ny; y++)
    for (size_t i = 0; i < Q; i++) memset((char *)p->block + i * p->plane * size + (size_t)(y + 1) * row, 0, row);
}

void populations_destroy(struct populations *p)
{
  memory_unmap(p->block, p->bytes);
  p->block = NULL;
}

bool populations_store(struct populations *p, struct store *store, struct status *status)
{
  if (!store_mark(store, "populations", status) || !store_bytes(store, &p->parity, sizeof p->parity, status))
    return false;
  if (p->parity != 0 && p->parity != 1)
    return status_fail(status, DELBM_IO, "cannot read %s: parity %d", store->path, p->parity);
  const size_t size = value_size(p->precision);
  for (int i = 0; i < Q; i++)
    for (int y = 0; y < p->ny; y++) {
      char *row = (char *)p->block + populations_slot(p, i, 0, y) * size;
      if (!store_bytes(store, row, (size_t)p->nx * size, status)) return false;
    }
  return true;
}

void populations_cells(const struct populations *p, int x, int y, void *a[Q])
{
  for (int i = 0; i < Q; i++) a[i] = (char *)p->block + populations_source(p, i, x, y) * value_size(p->precision);
}

void populations_cell(const struct populations *p, int x, int y, double g[Q])
{
  for (int i = 0; i < Q; i++) g[i] = populations_get(p, populations_source(p, i, x, y));
}
