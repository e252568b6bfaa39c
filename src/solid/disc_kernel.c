/* Occupation fractions of a disc, compiled once per instruction set (VARIANT).
 *
 * With the centre at the origin, let area(a, b) be the area of the disc's part {x > a, y > b}. The area in a cell is
 * the alternating sum of area(a, b) over its four corners. For a corner inside the disc the variables separate,
 *   area(a, b) = pi R^2/4 - D(a) - D(b) + a b,   D(t) = (R^2 asin(t/R) + t sqrt(R^2 - t^2))/2,
 * and outside the disc area(a, b) depends on the quadrant of the corner. Per disc t, the half chord h = sqrt(R^2 - t^2)
 * and D(t) are tabulated for its column lines and its row lines. The cost is one arcsine a line, not eight a cell, and
 * no branch depends on the cell. bench/disc_area.h has the same cell by cell, as a reference.
 *
 * extents    first and last cell of each row, and the cells wholly inside, from the chords at the row's two lines
 * fractions  eps of all touched cells. Discs up to NARROW lines wide: all corners of a row at once. Wider discs:
 *            tiles of TILE cells; cells wholly inside are set to 1, and tiles without a rim cell are skipped
 * weights    B of eps (weight.h)
 *
 * Loops run over whole vectors of VECTOR elements without a scalar remainder, so that a cell's bits do not depend on
 * its position in a row. Functions write only to their arguments and the stack: threads need no locks. */
#include "base/variant.h"
#include "solid/disc.h"
#include "solid/solid_kernel.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

/* (asin(s) - s)/s^3 as a polynomial in z = s^2 <= 1/4: interpolated at Chebyshev points from the series, error 2e-17.
 * */
static inline double arcsine_rest(double z)
{
  double p = 0.028757851367421566;
  p = p * z - 0.014851887071247204;
  p = p * z + 0.017400879442694021;
  p = p * z + 0.0054575067186403581;
  p = p * z + 0.010322814350185779;
  p = p * z + 0.011479177415184906;
  p = p * z + 0.013971212973552933;
  p = p * z + 0.017352392720869973;
  p = p * z + 0.022372172942149889;
  p = p * z + 0.030381944138531247;
  p = p * z + 0.044642857146355429;
  p = p * z + 0.074999999999984329;
  return p * z + 1.0 / 6;
}

/* Tables over grid lines: distance t from a disc's centre, half chord h (0 outside the disc), area = D(t). */
enum {
  NARROW = 64,           /* lines in a table; wider discs are split into tiles */
  TILE = NARROW - VECTOR /* cells of a tile: vectors may read past their lines */
};

struct lines {
  _Alignas(64) double t[NARROW + VECTOR], h[NARROW + VECTOR], area[NARROW + VECTOR];
};

static inline double half_chord(double radius, double t)
{
  const double away = fabs(t), inside = radius > away ? radius - away : 0;
  return sqrt(inside * (radius + away));
}

/* Fills a table with `count` lines from `first` on. asin(t/R) from t = R/2 on is pi/2 - 2 asin(sqrt((1 - t/R)/2)),
 * without cancellation in R - t. t is always formed as line - centre, so that a line has the same bits in every
 * table. */
static inline void lines_at(double radius, double centre, int first, int count, struct lines *lines)
{
  const double inverse = 1 / radius, r2 = radius * radius, quarter = M_PI / 4 * r2;
  const int n = whole_vectors(count);
#pragma omp simd
  for (int k = 0; k < n; k++) {
    const double t = (double)(first + k) - centre, away = fabs(t);
    const double inside = radius > away ? radius - away : 0;
    const double x = away * inverse;
    const bool low = x <= 0.5;
    const double z = low ? x * x : 0.5 * inside * inverse, s = low ? x : sqrt(z);
    const double rest = s + s * z * arcsine_rest(z < 0.25 ? z : 0.25);
    const double angle = low ? rest : M_PI / 2 - 2 * rest;
    const double h = half_chord(radius, t);
    const double area = inside > 0 ? 0.5 * (r2 * angle + away * h) : quarter;
    lines->t[k] = t;
    lines->h[k] = h;
    lines->area[k] = t < 0 ? -area : area;
  }
}

/* area(a, b) at the corners of row line b with `count` column lines from line `first` on. */
static inline void corners(double radius, const struct lines *rows, int b, int first, int count,
                           const struct lines *columns, double *restrict corner)
{
  const double t_b = rows->t[b], h_b = rows->h[b], area_b = rows->area[b];
  const double whole = M_PI * radius * radius, above = 0.5 * whole - 2 * area_b; /* of the part y > b */
  const double left =
      t_b < 0 ? above - 0.5 * whole : above; /* area(a, b) of a corner outside and left, without its term -2 D(a) */
  const int n = whole_vectors(count);
#pragma omp simd
  for (int k = 0; k < n; k++) {
    const double t = columns->t[first + k], area = columns->area[first + k];
    const double within = 0.25 * whole - area - area_b + t * t_b;
    const double right = t_b < 0 ? 0.5 * whole - 2 * area : 0;
    const double leftward = t_b < 0 ? left - 2 * area : left;
    const double outside = t < 0 ? leftward : right;
    corner[k] = fabs(t) < h_b ? within : outside;
  }
}

/* eps of cells first .. end - 1 between two lines of corners; 1 in cells full .. full_end - 1. */
static inline void cells(const double *restrict low, const double *restrict high, int first, int end, int full,
                         int full_end, double *restrict eps)
{
  const int n = whole_vectors(end - first);
#pragma omp simd
  for (int k = 0; k < n; k++) {
    const int c = first + k;
    double area = low[c] - low[c + 1] - (high[c] - high[c + 1]);
    area = area > 0 ? area : 0; /* round-off */
    area = area < 1 ? area : 1;
    eps[k] = c >= full && c < full_end ? 1 : area;
  }
}

static void KERNEL(extents)(const struct shape *disc, const struct pose *pose, int first_row, int rows,
                            struct row_extents *e)
{
  const double radius = disc->radius, x = pose->x, y = pose->y;
  const double left = floor(x - radius) - x; /* from the centre to the line of the leftmost cell */
  const int n = whole_vectors(rows);
#pragma omp simd
  for (int r = 0; r < n; r++) {
    const double t_low = (double)(first_row + r) - y, t_high = (double)(first_row + r + 1) - y;
    const double h_low = half_chord(radius, t_low), h_high = half_chord(radius, t_high);
    const double wider = h_low > h_high ? h_low : h_high, narrow = h_low > h_high ? h_high : h_low;
    const double wide = t_low < 0 && t_high > 0 ? radius : wider; /* R if the centre lies in this row */
    const int first = (int)floor(-wide - left), end = (int)ceil(wide - left);
    const int full = (int)ceil(-narrow - left), full_end = (int)floor(narrow - left);
    const bool some = narrow > 0 && full < full_end;
    e->first[r] = first > 0 ? first : 0; /* round-off in wide */
    e->end[r] = end;
    e->full[r] = some ? full : end;
    e->full_end[r] = some ? full_end : end;
  }
}

/* Rows from .. end - 1 of a disc whose lines fit one table. One line is added, since round-off may put the right
 * edge past the last column. All corners are computed before all cells: an unaligned load across two pending stores
 * would stall (no store forwarding). */
static void narrow_rows(double radius, double x, const struct lines *row_lines, int from, int end,
                        const struct row_extents *e, double *eps)
{
  const int column = (int)floor(x - radius), columns = (int)ceil(x + radius) - column + 2;
  _Alignas(64) double table[SHAPE_ROWS + 1][NARROW + 2 * VECTOR];
  struct lines column_lines;
  lines_at(radius, x, column, columns, &column_lines);
  for (int r = from; r <= end; r++) {
    corners(radius, row_lines, r - from, 0, columns, &column_lines, table[r - from]);
    memset(table[r - from] + whole_vectors(columns), 0, VECTOR * sizeof table[0][0]); /* read by the last vector */
  }
  for (int r = from; r < end; r++) {
    cells(table[r - from], table[r - from + 1], e->first[r], e->end[r], e->full[r], e->full_end[r], eps);
    eps += e->end[r] - e->first[r];
  }
}

/* Rim cells (partly inside) of a row, between row lines r and r + 1: cells first .. end - 1, cut to the tile that
 * begins at line `tile`. eps[0] belongs to cell `first`. */
static void rim_cells(double radius, const struct lines *row_lines, int r, const struct lines *column_lines, int tile,
                      int first, int end, double *eps)
{
  const int low = first > tile ? first : tile, high = end < tile + TILE ? end : tile + TILE, n = high - low;
  _Alignas(64) double below[TILE + 2 * VECTOR], above[TILE + 2 * VECTOR], area[TILE + VECTOR];
  if (n <= 0) return;
  corners(radius, row_lines, r, low - tile, n + 1, column_lines, below);
  corners(radius, row_lines, r + 1, low - tile, n + 1, column_lines, above);
  cells(below, above, 0, n, n, n, area);
  memcpy(eps + (low - first), area, (size_t)n * sizeof *eps);
}

/* True if a rim cell of any row lies in the tile. */
static bool rim_in_tile(const struct row_extents *e, int from, int end, int tile)
{
  for (int r = from; r < end; r++)
    if ((e->first[r] < tile + TILE && e->full[r] > tile) || (e->full_end[r] < tile + TILE && e->end[r] > tile))
      return true;
  return false;
}

/* Rows of a disc with more than NARROW lines, tile by tile. */
static void wide_rows(double radius, double x, const struct lines *row_lines, int from, int end,
                      const struct row_extents *e, double *eps)
{
  const int column = (int)floor(x - radius), columns = (int)ceil(x + radius) - column + 1;
  double *row[SHAPE_ROWS];
  for (int r = from; r < end; r++) {
    row[r] = eps;
    for (int k = e->full[r]; k < e->full_end[r]; k++) eps[k - e->first[r]] = 1;
    eps += e->end[r] - e->first[r];
  }
  for (int tile = 0; tile < columns; tile += TILE) {
    struct lines column_lines;
    if (!rim_in_tile(e, from, end, tile)) continue;
    lines_at(radius, x, column + tile, TILE + 1, &column_lines);
    for (int r = from; r < end; r++) {
      rim_cells(radius, row_lines, r - from, &column_lines, tile, e->first[r], e->full[r], row[r]);
      rim_cells(radius, row_lines, r - from, &column_lines, tile, e->full_end[r], e->end[r],
                row[r] + (e->full_end[r] - e->first[r]));
    }
  }
}

static void KERNEL(fractions)(const struct shape *disc, const struct pose *pose, int first_row, int from, int end,
                              const struct row_extents *e, double *eps)
{
  const double radius = disc->radius, x = pose->x, y = pose->y;
  struct lines row_lines;
  lines_at(radius, y, first_row + from, end - from + 1, &row_lines);
  if ((int)ceil(x + radius) - (int)floor(x - radius) + 2 <= NARROW)
    narrow_rows(radius, x, &row_lines, from, end, e, eps);
  else
    wide_rows(radius, x, &row_lines, from, end, e, eps);
}

static void KERNEL(weights)(const double *restrict eps, int count, struct weight_law law, double *restrict weight)
{
  const int n = whole_vectors(count);
#pragma omp simd
  for (int k = 0; k < n; k++) weight[k] = weight_of(law, eps[k]);
}

extern shape_overlaps KERNEL(disc_overlaps), KERNEL(disc_overlaps_half_plane); /* overlap_kernel.c */
extern const struct solid_kernel KERNEL(solid_kernel);
const struct solid_kernel KERNEL(solid_kernel) = {.disc = {.name = "disc",
                                                           .round = true,
                                                           .area = disc_area,
                                                           .gyration2 = disc_gyration2,
                                                           .box = disc_box,
                                                           .extents = KERNEL(extents),
                                                           .fractions = KERNEL(fractions),
                                                           .overlaps = KERNEL(disc_overlaps),
                                                           .overlaps_half_plane = KERNEL(disc_overlaps_half_plane)},
                                                  .weights = KERNEL(weights)};
