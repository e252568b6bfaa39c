/* The tables of the occupation: runs, owner weights and sums, band by band, and their accessors. occupation.c fills them. */
#ifndef DELBM_SOLID_TABLES_H
#define DELBM_SOLID_TABLES_H

#include "fluid/runs.h"
#include "fluid/weight.h"
#include "solid/discs.h"

enum { BAND_ROWS = 16 };

struct solid_kernel;

struct band {
  struct run *runs;
  size_t run_capacity;
  size_t row_start[BAND_ROWS], row_end[BAND_ROWS]; /* runs of the band's row k: row_start[k] .. row_end[k] - 1 */
  double *owner_weight;                            /* of the cells of all runs, in the order of the sweep */
  size_t weight_capacity;
  struct moment_sums *sums; /* [run], written by the sweep and read by the exchange */
  size_t sums_capacity;
  size_t shared_cells;  /* cells of the band with more than one owner */
  size_t shared_owners; /* number of owners of these cells together */
};

struct band_draft;

struct occupation {
  int size[2];
  bool periodic[2];
  enum coupling_form form;
  double viscosity;

  const struct solid_kernel *kernel;

  size_t discs;
  bool painted;                /* at least once */
  double *x, *y, *angle;       /* pose of each disc in the tables; angle: of shapes that are not round */
  double *damping;             /* of each disc, in its cells (weight.h) */
  int32_t *column;             /* of the leftmost cell of each disc, before wrapping */
  int32_t *row, *rows;         /* lowest row of each disc before wrapping, number of rows */
  uint8_t *moved;              /* pose or damping differs from the previous call */
  int32_t *old_row, *old_rows; /* rows of a moved disc in the previous call */
  size_t *first_row;           /* index of the first row of each disc in run_index[] */
  size_t *run_index;           /* [2 row + piece] index of the run in its band, or no_run */

  uint32_t *order;      /* discs by x, then index */
  size_t *band_start;   /* [bands + 1] discs of band k: band_discs[band_start[k]] .. */
  uint32_t *band_discs; /* within a band in the order of order[] */
  size_t band_discs_capacity;
  uint8_t *changed; /* [band] a disc in it has moved, entered or left */
  struct band *bands;
  struct band_draft *drafts; /* [thread] scratch memory (band.h) */
  size_t draft_count;
  int band_count;
  bool leave_unlisted, leave_unpainted; /* flags of team.h, after the lists and after the painting */
};

static const size_t no_run = SIZE_MAX;

static inline struct band *occupation_band(const struct occupation *o, int y)
{
  return &o->bands[y / BAND_ROWS];
}

/* The runs of row y, in the order of their first cells. */
static inline const struct run *occupation_row(const struct occupation *o, int y, size_t *count)
{
  const struct band *band = occupation_band(o, y);
  const size_t start = band->row_start[y % BAND_ROWS];
  *count = band->row_end[y % BAND_ROWS] - start;
  return band->runs + start;
}

/* True for rows, and cells, beside a side that is not periodic. */
static inline bool occupation_row_at_side(const struct occupation *o, int y)
{
  return !o->periodic[1] && (y == 0 || y == o->size[1] - 1);
}

static inline bool occupation_at_side(const struct occupation *o, int x, int y)
{
  return (!o->periodic[0] && (x == 0 || x == o->size[0] - 1)) || occupation_row_at_side(o, y);
}

/* Weight of cells; `damping`: maximum over their owners. `between`: cells with several owners or beside a side. */
static inline struct weight_law occupation_law(const struct occupation *o, double damping, bool between)
{
  const double min_damping = between ? weight_damping_between(o->form) : 0;
  return weight_law(o->form, o->viscosity, damping > min_damping ? damping : min_damping);
}

/* The sums of one piece of row k of the disc; NULL if no cell of the piece lies in the box. *y: the row before
 * wrapping. */
static inline const struct moment_sums *occupation_sums(const struct occupation *o, size_t disc, int k, int piece,
                                                        int *y)
{
  const size_t run = o->run_index[2 * (o->first_row[disc] + (size_t)k) + (size_t)piece];
  const int ny = o->size[1];
  *y = o->row[disc] + k;
  const int row = !o->periodic[1] ? *y : *y < 0 ? *y + ny : *y >= ny ? *y - ny : *y;
  return run == no_run || row < 0 || row >= ny ? NULL : &occupation_band(o, row)->sums[run];
}

#endif
