/* Occupation: which cells each disc covers, and how much of them.
 *
 * A disc is convex, so it covers one run of cells in each row. Nothing is as large as the box: a band of rows holds the
 * runs of its own rows, and the shares of the weight B of their cells; the occupation fractions eps, from which these follow,
 * stay in cache while a band is painted. The step then needs,
 * per row, the runs of all discs from left to right:
 *
 *   1. places    per disc, in parallel: the rows it covers, and whether it has moved.
 *   2. bands     of each band, which discs lie in it, along x; and whether one of them has come, gone or moved. If none
 *                has, the band stays as it is.
 *   3. rows      per band, in parallel: the runs of its rows, sorted by first cell. eps come from line tables
 *                (disc_kernel.c), of wide discs for the rim only: where it ends follows from the chords of the row's two lines,
 *                so that no list of boundary cells need be kept from step to step, as the modified Verlet list does.
 *                Runs that overlap share cells; there B follows from the total eps = min(1, sum eps_p), of which owner
 *                p has the share w_p B with w_p = eps_p/sum eps (22), for any number of owners.
 *
 * A band's runs, and the shares of cells in its rows, are written by the one thread that has the band: no races. All
 * orders (discs along x, runs in a row, owners of a cell, bands) follow from positions and indices alone, never from
 * threads or history: results are the same for any number of threads and after a restart.
 *
 * Discs may reach beyond walls (their runs are cut there) and across periodic sides (their runs wrap). */
#ifndef DELBM_SOLID_OCCUPATION_H
#define DELBM_SOLID_OCCUPATION_H

#include "base/team.h"
#include "fluid/runs.h"
#include "fluid/weight.h"
#include "solid/discs.h"

enum { BAND_ROWS = 16 };

struct solid_kernel;

struct band {
  struct run *runs;
  size_t run_capacity;
  size_t row_start[BAND_ROWS], row_end[BAND_ROWS]; /* runs of the band's row k: row_start[k] .. row_end[k] - 1 */
  double *owner_weight;                            /* w_p B of their cells, row by row as the sweep meets them */
  size_t weight_capacity;
  struct moment_sums *sums; /* of each run: taken by the sweep, added up by the exchange */
  size_t sums_capacity;
  size_t shared_cells;  /* cells of the band with more than one owner */
  size_t shared_owners; /* and their owners, all told */
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
  double *x, *y, *angle;       /* pose of each disc when it was painted; angle only of shapes that are not round */
  double *damping;             /* and the damping in its cells (weight.h) */
  int32_t *column;             /* of its leftmost cell, before wrapping */
  int32_t *row, *rows;         /* its lowest cell, and how many rows it covers */
  uint8_t *moved;              /* since it was last painted */
  int32_t *old_row, *old_rows; /* of those, then */
  size_t *first_row;           /* of the disc's rows in run_index[] */
  size_t *run_index;           /* [2 row + piece] the run's number in its band, or no_run */

  uint32_t *order;      /* discs by x, then index */
  size_t *band_start;   /* [bands + 1] discs of band k: band_discs[band_start[k]] .. */
  uint32_t *band_discs; /* in the order above */
  size_t band_discs_capacity;
  uint8_t *changed; /* of each band: to be painted anew */
  struct band *bands;
  struct band_draft *drafts; /* of each thread: what is needed of a band only while it is painted */
  size_t draft_count;
  int band_count;
  bool leave_unlisted, leave_unpainted; /* after the listing of bands, after the painting (team.h) */
};

/* Sets up tables for the scene's discs. */
bool occupation_create(struct occupation *occupation, const struct scene *scene, const struct discs *discs,
                       struct status *status);
void occupation_destroy(struct occupation *occupation);

/* The stage, called by all threads of a parallel region or outside of one. Bands whose discs have not moved since they were
 * painted are not painted again. Fails if memory runs out. */
bool stage_occupation(struct occupation *occupation, const struct discs *discs, struct team *team);

static const size_t no_run = SIZE_MAX;

/* The band that row y lies in. */
static inline struct band *occupation_band(const struct occupation *o, int y)
{
  return &o->bands[y / BAND_ROWS];
}

/* The runs of row y, from left to right. */
static inline const struct run *occupation_row(const struct occupation *o, int y, size_t *count)
{
  const struct band *band = occupation_band(o, y);
  const size_t start = band->row_start[y % BAND_ROWS];
  *count = band->row_end[y % BAND_ROWS] - start;
  return band->runs + start;
}

/* Whether row y, or cell (x, y), lies next to a side that discs cannot leave through. */
static inline bool occupation_row_at_side(const struct occupation *o, int y)
{
  return !o->periodic[1] && (y == 0 || y == o->size[1] - 1);
}

static inline bool occupation_at_side(const struct occupation *o, int x, int y)
{
  return (!o->periodic[0] && (x == 0 || x == o->size[0] - 1)) || occupation_row_at_side(o, y);
}

/* Of cells with at most this damping in their owners; `between`: a disc and another, or a side. */
static inline struct weight_law occupation_law(const struct occupation *o, double damping, bool between)
{
  const double min_damping = between ? weight_damping_between(o->form) : 0;
  return weight_law(o->form, o->viscosity, damping > min_damping ? damping : min_damping);
}

/* The part of each cell of row y that discs cover, min(1, sum eps_p), for all columns. `scratch` has room for the cells of
 * a row of any disc and SHAPE_PAD more. */
void occupation_fractions(const struct occupation *occupation, const struct discs *discs, int y, double *eps,
                          double *scratch);

/* The sums of one piece of the disc's row k, and that row before wrapping; NULL where nothing of it lies in the box. */
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
