/* Occupation: how much of each cell each disc covers, who shares a cell, and who is near whom. */
#include "contact/linked_cell.h"
#include "contact/overlap.h"
#include "scenes.h"
#include "solid/disc_area.h"
#include "solid/occupation.h"

#include <criterion/criterion.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* A scene's discs and where they are; its box may be any. */
struct painting {
  struct scene scene;
  struct discs discs;
  struct occupation occupation;
};

static void paint(struct painting *p)
{
  struct team team = {0};
  stage_occupation(&p->occupation, &p->discs, &team);
  cr_assert_not(team.failed, "%s", team.first.message);
}

static void begin(struct painting *p, int reach)
{
  struct status status;
  cr_assert(discs_create(&p->discs, &p->scene, &status), "%s", status.message);
  cr_assert(occupation_create(&p->occupation, &p->scene, &p->discs, reach, &status), "%s", status.message);
}

static void end(struct painting *p)
{
  occupation_destroy(&p->occupation);
  discs_destroy(&p->discs);
  scene_clear(&p->scene);
}

static gsl_rng *random_from(unsigned long seed)
{
  gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
  cr_assert(random);
  gsl_rng_set(random, seed);
  return random;
}

static double log_uniform(gsl_rng *random, double low, double high)
{
  return low * pow(high / low, gsl_rng_uniform(random));
}

static void *cells_of(const struct painting *p)
{
  void *cells = calloc((size_t)p->scene.domain.size[0] * (size_t)p->scene.domain.size[1], sizeof(double));
  cr_assert(cells);
  return cells;
}

/* Spreads one disc's shares over all cells of the box. */
static void spread_shares(const struct painting *p, size_t disc, double *cells)
{
  const int nx = p->scene.domain.size[0], ny = p->scene.domain.size[1];
  memset(cells, 0, sizeof *cells * (size_t)nx * (size_t)ny);
  for (int y = 0; y < ny; y++) {
    size_t count;
    const struct run *row = occupation_row(&p->occupation, y, &count);
    for (size_t r = 0; r < count; r++)
      for (int k = 0; row[r].disc == disc && k < row[r].n; k++)
        cells[y * nx + row[r].x + k] += occupation_band(&p->occupation, y)->share[row[r].share + (size_t)k];
  }
}

/* One disc's eps in all cells of the box: from its shares where it is alone, in a form whose B determines eps (19). */
static void spread(const struct painting *p, size_t disc, double *cells)
{
  struct painting alone = {.scene = p->scene};
  alone.scene.particles.count = 1;
  alone.scene.particles.discs = &(struct disc_spec){.radius = p->discs.radius[disc], .density = 2};
  alone.scene.coupling.form = FORM_OWEN;
  begin(&alone, p->occupation.reach);
  alone.discs.x[0] = p->discs.x[disc];
  alone.discs.y[0] = p->discs.y[disc];
  paint(&alone);
  spread_shares(&alone, 0, cells);
  const double t = 3 * p->scene.fluid.viscosity;
  for (int k = 0; k < p->scene.domain.size[0] * p->scene.domain.size[1]; k++) cells[k] *= (1 + t) / (t + cells[k]);
  alone.scene = (struct scene){0}; /* is p's */
  end(&alone);
}

static double covered_area(const struct painting *p, size_t disc)
{
  double *cells = cells_of(p), sum = 0;
  spread(p, disc, cells);
  for (int k = 0; k < p->scene.domain.size[0] * p->scene.domain.size[1]; k++) sum += cells[k];
  free(cells);
  return sum;
}

/* The nearest image's displacement along one axis. */
static double nearest(const struct painting *p, int axis, double displacement)
{
  const double size = p->scene.domain.size[axis];
  return scene_is_periodic(&p->scene, axis) ? displacement - size * rint(displacement / size) : displacement;
}

/* Lower left corner of a cell, seen from the disc. */
static void corner_of(const struct painting *p, size_t disc, int x, int y, double corner[2])
{
  corner[0] = nearest(p, 0, x + 0.5 - p->discs.x[disc]) - 0.5;
  corner[1] = nearest(p, 1, y + 0.5 - p->discs.y[disc]) - 0.5;
}

/* Largest difference between the painted fractions of a disc and disc_cell_area, over all cells of the box. */
static double worst_cell(const struct painting *p, size_t disc)
{
  double *cells = cells_of(p), worst = 0;
  const int nx = p->scene.domain.size[0], ny = p->scene.domain.size[1];
  spread(p, disc, cells);
  for (int k = 0; k < nx * ny; k++) {
    double corner[2];
    corner_of(p, disc, k % nx, k / nx, corner);
    worst = fmax(worst, fabs(cells[k] - disc_cell_area(p->discs.radius[disc], corner[0], corner[1])));
  }
  free(cells);
  return worst;
}

/* A disc at the origin and the horizontal lines that cut it. */
struct strip {
  double radius, low, high;
};

static double chord_in_strip(double x, void *data)
{
  const struct strip *s = data;
  const double h = sqrt(fmax(0, (s->radius - x) * (s->radius + x)));
  return fmax(0, fmin(s->high, h) - fmax(s->low, -h));
}

/* Where the circle meets the strip's lines, between at[0] and at[1]: break points in order, none upon another. */
static size_t break_points(const struct strip *s, double at[6])
{
  size_t count = 2;
  for (int k = 0; k < 4; k++) {
    const double y = k < 2 ? s->low : s->high, h = sqrt(fmax(0, (s->radius - y) * (s->radius + y)));
    const double x = k % 2 ? h : -h;
    size_t place = 1;
    while (place < count && at[place] < x) place++;
    if (place == count || x - at[place - 1] < 1e-9 || at[place] - x < 1e-9) continue;
    memmove(&at[place + 1], &at[place], (count++ - place) * sizeof *at);
    at[place] = x;
  }
  return count;
}

/* Area of the disc at the origin inside a rectangle, by adaptive quadrature between the places where the circle meets
 * the rectangle's lines. */
static double area_by_quadrature(double radius, const double low[2], const double high[2], double accuracy)
{
  static gsl_integration_workspace *workspace;
  if (!workspace) workspace = gsl_integration_workspace_alloc(1000);
  struct strip strip = {radius, low[1], high[1]};
  double at[6] = {fmax(low[0], -radius), fmin(high[0], radius)};
  if (at[0] >= at[1]) return 0;
  gsl_function f = {chord_in_strip, &strip};
  double area, error;
  gsl_set_error_handler_off(); /* judged by its estimate of the error */
  gsl_integration_qagp(&f, at, break_points(&strip, at), accuracy / 100, 0, 1000, workspace, &area, &error);
  cr_assert(error < accuracy / 2, "quadrature: error %g", error);
  return area;
}

/* Quadrature of a few of the partly covered cells. */
static void check_some_cells(const struct painting *p, gsl_rng *random, unsigned long seed)
{
  const int nx = p->scene.domain.size[0], cells_count = nx * p->scene.domain.size[1];
  double *cells = cells_of(p);
  int *partly = calloc((size_t)cells_count, sizeof *partly), count = 0;
  spread(p, 0, cells);
  for (int k = 0; k < cells_count; k++)
    if (cells[k] > 0 && cells[k] < 1) partly[count++] = k;
  cr_assert(count > 0);
  for (int k = 0; k < 5; k++) {
    const int cell = partly[gsl_rng_uniform_int(random, (unsigned long)count)];
    double low[2], high[2];
    corner_of(p, 0, cell % nx, cell / nx, low);
    high[0] = low[0] + 1, high[1] = low[1] + 1;
    const double area = area_by_quadrature(p->discs.radius[0], low, high, 1e-10);
    cr_expect_float_eq(cells[cell], area, 1e-10, "seed %lu: R = %.17g, cell at (%.17g, %.17g): %.17g, not %.17g", seed,
                       p->discs.radius[0], low[0], low[1], cells[cell], area);
  }
  free(partly);
  free(cells);
}

static void one_disc(struct painting *p, int nx, int ny, enum sides sides, double radius, double x, double y)
{
  p->scene = scene_box(nx, ny, 0.05, sides);
  scene_add_disc(&p->scene, radius, 2, x, y);
  begin(p, 0);
  paint(p);
}

Test(occupation, fractions_are_the_areas_that_disc_and_cell_share)
{
  const unsigned long seed = 11;
  gsl_rng *random = random_from(seed);
  for (int n = 0; n < 1000; n++) {
    struct painting p;
    const double radius = log_uniform(random, 0.5, 100);
    const int size = (int)ceil(2 * radius) + 5;
    const double x = radius + 1 + 2 * gsl_rng_uniform(random), y = radius + 1 + 2 * gsl_rng_uniform(random);
    one_disc(&p, size, size, SIDES_PERIODIC, radius, x, y);
    check_some_cells(&p, random, seed);
    const double worst = worst_cell(&p, 0);
    cr_expect(worst <= 1e-12 * fmax(1, radius * radius), "R = %.17g at (%.17g, %.17g): cell by cell, off by %g", radius,
              x, y, worst);
    end(&p);
  }
  gsl_rng_free(random);
}

Test(occupation, fractions_add_up_to_the_disc_wherever_it_lies_in_a_periodic_box)
{
  static const double radii[] = {0.5, 0.51, 1, 2.5, 5, 10, 31.7, 100, 316.2, 1000};
  for (size_t k = 0; k < sizeof radii / sizeof radii[0]; k++) {
    const double radius = radii[k], whole = M_PI * radius * radius;
    const int nx = (int)ceil(2 * radius) + 4, ny = nx + 3;
    const double places[][2] = {{nx / 2.0, ny / 2.0}, {0.3, ny / 2.0}, {nx / 2.0, ny - 0.2}, {0, 0}, {nx - 0.7, 0.1}};
    for (size_t n = 0; n < sizeof places / sizeof places[0]; n++) {
      struct painting p;
      one_disc(&p, nx, ny, SIDES_PERIODIC, radius, places[n][0], places[n][1]);
      cr_expect_float_eq(covered_area(&p, 0) / whole, 1, 1e-10, "R = %g, place %zu", radius, n);
      if (radius < 101) cr_expect(worst_cell(&p, 0) < 1e-12 * fmax(1, radius * radius), "R = %g, place %zu", radius, n);
      end(&p);
    }
  }
}

Test(occupation, fractions_beyond_walls_are_left_out)
{
  static const double radii[] = {0.5, 3.3, 10, 47, 400};
  for (size_t k = 0; k < sizeof radii / sizeof radii[0]; k++) {
    const double radius = radii[k];
    const int nx = (int)ceil(1.5 * radius) + 1, ny = (int)ceil(radius) + 1; /* it reaches beyond several at once */
    const double places[][2] = {{nx / 2.0, ny / 2.0}, {0.3, ny / 2.0}, {nx / 2.0, ny - 0.2}, {0, 0}, {nx - 0.7, 0.1}};
    for (size_t n = 0; n < sizeof places / sizeof places[0]; n++) {
      struct painting p;
      const double *c = places[n], low[2] = {-c[0], -c[1]}, high[2] = {nx - c[0], ny - c[1]};
      one_disc(&p, nx, ny, SIDES_CLOSED, radius, c[0], c[1]);
      const double inside = area_by_quadrature(radius, low, high, 1e-11 * radius * radius);
      cr_expect_float_eq(covered_area(&p, 0) / inside, 1, 1e-10, "R = %g, place %zu", radius, n);
      cr_expect(worst_cell(&p, 0) < 1e-12 * fmax(1, radius * radius), "R = %g, place %zu", radius, n);
      end(&p);
    }
  }
}

/* With round numbers a disc's edge may meet a grid line but for round-off, in which half of all digits can drown. The
 * disc before it leaves other line tables behind. */
Test(occupation, edges_on_grid_lines_but_for_round_off_are_painted_like_any_other)
{
  struct painting p = {.scene = scene_box(1100, 48, 0.05, SIDES_PERIODIC)};
  for (int k = 0; k < 40; k++) {
    scene_add_disc(&p.scene, 2 + k / 10.0 + 0.4, 2, 100.05, 24.3);
    scene_add_disc(&p.scene, 2 + k / 10.0, 2, 1000, 24.3);
  }
  begin(&p, 0);
  for (int n = 0; n < 400; n++) {
    for (size_t i = 0; i < p.discs.count; i++) p.discs.x[i] = i % 2 ? 1000 + n / 10.0 : 100.05 + n / 20.0;
    paint(&p);
    for (size_t i = 0; i < p.discs.count; i++) {
      const double sum = covered_area(&p, i);
      const double radius = p.discs.radius[i];
      cr_expect_float_eq(sum / (M_PI * radius * radius), 1, 1e-12, "R = %.17g at (%.17g, 24.3): %.17g", radius,
                         p.discs.x[i], sum);
    }
  }
  end(&p);
}

static void check_runs(int reach)
{
  struct painting p = {.scene = scene_box(37, 41, 0.05, SIDES_PERIODIC)};
  scene_add_disc(&p.scene, 8.3, 2, 1.7, 40.2);
  scene_add_disc(&p.scene, 3, 2, 36.9, 20.5);
  scene_add_disc(&p.scene, 4.2, 2, 21.6, 18.3); /* clear of all sides */
  begin(&p, reach);
  paint(&p);
  for (int y = 0; y < 41; y++) {
    size_t count;
    const struct run *row = occupation_row(&p.occupation, y, &count);
    for (size_t r = 0; r < count; r++) {
      if (row[r].n == 0) continue;
      double corner[2];
      corner_of(&p, row[r].disc, row[r].x, y, corner);
      cr_expect_float_eq(row[r].rx, corner[0] + 0.5, 1e-13, "reach %d, disc %u, row %d", reach, row[r].disc, y);
      cr_expect_float_eq(row[r].ry, corner[1] + 0.5, 1e-13, "reach %d, disc %u, row %d", reach, row[r].disc, y);
    }
  }
  end(&p);
}

Test(occupation, runs_know_where_their_cells_lie_from_the_centre)
{
  check_runs(0);
  check_runs(1);
}

/* Discs of radii from 0.5 to `largest` all over the box. */
static void scatter(struct scene *scene, size_t count, double largest, gsl_rng *random)
{
  for (size_t i = 0; i < count; i++) {
    const double x = gsl_rng_uniform(random) * scene->domain.size[0];
    const double y = gsl_rng_uniform(random) * scene->domain.size[1];
    scene_add_disc(scene, i == 0 ? largest : log_uniform(random, 0.5, largest), 2, x, y);
  }
}

static double into_box(const struct painting *p, int axis, double at)
{
  const double size = p->scene.domain.size[axis];
  if (!scene_is_periodic(&p->scene, axis)) return fmin(fmax(at, 0), nextafter(size, 0));
  if (at < 0) at += size;
  return at >= size ? at - size : at;
}

/* Most discs move by part of a cell, some jump, some rest, of these some at another spin, some fall upon a grid line or
 * another's abscissa. */
static void stir(struct painting *p, gsl_rng *random)
{
  struct discs *d = &p->discs;
  for (size_t i = 0; i < d->count; i++) {
    const double kind = gsl_rng_uniform(random), most = kind < 0.1 ? 6 : 0.3;
    if (kind > 0.95) d->omega[i] = 0.3 / d->radius[i] * gsl_rng_uniform(random);
    if (kind > 0.8) continue;
    d->x[i] = into_box(p, 0, d->x[i] + most * (2 * gsl_rng_uniform(random) - 1));
    d->y[i] = into_box(p, 1, d->y[i] + most * (2 * gsl_rng_uniform(random) - 1));
    if (kind > 0.78) d->y[i] = floor(d->y[i]);
    if (kind > 0.76) d->x[i] = d->x[gsl_rng_uniform_int(random, d->count)];
  }
}

/* Whether two tables of the same discs hold the same bits, disc by disc. */
static const char *compare_cells(const struct occupation *a, const struct occupation *b)
{
  const size_t indices = a->discs * sizeof(int32_t);
  if (memcmp(a->column, b->column, indices) || memcmp(a->row, b->row, indices) || memcmp(a->rows, b->rows, indices))
    return "places";
  for (size_t i = 0; i < a->discs; i++) /* where the exchange finds the sums of a disc's rows */
    if (memcmp(a->place + 2 * a->first_row[i], b->place + 2 * b->first_row[i],
               2 * (size_t)a->rows[i] * sizeof *a->place))
      return "rows of discs";
  return NULL;
}

static bool same_run(const struct run *a, const struct run *b)
{
  return a->x == b->x && a->n == b->n && a->disc == b->disc && a->share == b->share &&
         !memcmp(&a->rx, &b->rx, sizeof a->rx) && !memcmp(&a->ry, &b->ry, sizeof a->ry);
}

/* ... and band by band. Returns what differs, or NULL. */
static const char *compare(const struct occupation *a, const struct occupation *b)
{
  const char *difference = compare_cells(a, b);
  for (int k = 0; k < a->band_count && !difference; k++) {
    const struct band *s = &a->bands[k], *t = &b->bands[k];
    if (memcmp(s->row_start, t->row_start, sizeof s->row_start) || memcmp(s->row_end, t->row_end, sizeof s->row_end))
      return "rows";
    for (int row = 0; row < BAND_ROWS; row++)
      for (size_t r = s->row_start[row]; r < s->row_end[row]; r++) {
        const size_t share = s->runs[r].share, bytes = (size_t)s->runs[r].n * sizeof(double);
        if (!same_run(&s->runs[r], &t->runs[r])) return "runs";
        if (memcmp(s->share + share, t->share + share, bytes)) return "shares";
      }
    if (s->shared_cells != t->shared_cells || s->shared_owners != t->shared_owners) return "count of shared cells";
    if (a->batches[k].count != b->batches[k].count) return "count of pairs";
    for (size_t n = 0; n < a->batches[k].count; n++) {
      const struct near_pair *l = &a->batches[k].pairs[n], *r = &b->batches[k].pairs[n];
      if (l->a != r->a || l->b != r->b || memcmp(&l->cells_area, &r->cells_area, sizeof(double))) return "pairs";
    }
  }
  return difference;
}

/* The difference between a table with a past and one without, at the same places. */
static const char *compare_with_fresh(const struct painting *p)
{
  struct painting fresh = {.scene = p->scene};
  begin(&fresh, p->occupation.reach);
  memcpy(fresh.discs.x, p->discs.x, p->discs.count * sizeof(double));
  memcpy(fresh.discs.y, p->discs.y, p->discs.count * sizeof(double));
  memcpy(fresh.discs.omega, p->discs.omega, p->discs.count * sizeof(double));
  paint(&fresh);
  const char *difference = compare(&p->occupation, &fresh.occupation);
  fresh.scene = (struct scene){0}; /* is p's */
  end(&fresh);
  return difference;
}

static void check_history(enum sides sides, int reach, unsigned long seed)
{
  gsl_rng *random = random_from(seed);
  struct painting p = {.scene = scene_box(97, 83, 0.02, sides)};
  scatter(&p.scene, 30, 30, random);
  begin(&p, reach);
  for (int step = 0; step < 300; step++) {
    paint(&p);
    const char *difference = compare_with_fresh(&p);
    cr_assert_null(difference, "seed %lu, %s, reach %d, step %d: %s differ", seed,
                   sides == SIDES_PERIODIC ? "periodic" : "closed", reach, step, difference);
    stir(&p, random);
  }
  end(&p);
  gsl_rng_free(random);
}

Test(occupation, tables_depend_on_where_discs_are_and_not_on_where_they_were)
{
  for (int reach = 0; reach < 2; reach++) {
    check_history(SIDES_PERIODIC, reach, 21 + (unsigned long)reach);
    check_history(SIDES_CLOSED, reach, 31 + (unsigned long)reach);
  }
}

static size_t stale_bands(const struct occupation *o)
{
  size_t count = 0;
  for (int k = 0; k < o->band_count; k++) count += o->stale[k];
  return count;
}

/* One disc moves a step, in a box of many bands. */
static void check_few_move(enum sides sides, int reach, unsigned long seed)
{
  gsl_rng *random = random_from(seed);
  struct painting p = {.scene = scene_box(60, 400, 0.02, sides)};
  scatter(&p.scene, 40, 6, random);
  begin(&p, reach);
  paint(&p);
  for (int step = 0; step < 400; step++) {
    const size_t i = gsl_rng_uniform_int(random, p.discs.count);
    const double most = step % 5 ? 0.5 : 40; /* within its bands, or to others */
    p.discs.x[i] = into_box(&p, 0, p.discs.x[i] + most * (2 * gsl_rng_uniform(random) - 1));
    p.discs.y[i] = into_box(&p, 1, p.discs.y[i] + most * (2 * gsl_rng_uniform(random) - 1));
    paint(&p);
    cr_assert(stale_bands(&p.occupation) <= 8, "step %d: %zu bands painted for one disc", step,
              stale_bands(&p.occupation));
    const char *difference = compare_with_fresh(&p);
    cr_assert_null(difference, "seed %lu, reach %d, step %d: %s differ", seed, reach, step, difference);
  }
  paint(&p);
  cr_expect_eq(stale_bands(&p.occupation), 0, "nothing has moved");
  end(&p);
  gsl_rng_free(random);
}

Test(occupation, only_bands_that_a_disc_moves_in_leaves_or_enters_are_painted)
{
  for (int reach = 0; reach < 2; reach++) {
    check_few_move(SIDES_PERIODIC, reach, 61 + (unsigned long)reach);
    check_few_move(SIDES_CLOSED, reach, 71 + (unsigned long)reach);
  }
}

static void paint_by_threads(struct painting *p, int threads)
{
  struct team team = {0};
  omp_set_dynamic(0);
  omp_set_num_threads(threads);
#pragma omp parallel
  {
#pragma omp single
    cr_assert_eq(omp_get_num_threads(), threads);
    stage_occupation(&p->occupation, &p->discs, &team);
  }
  cr_assert_not(team.failed);
}

static void check_threads(enum sides sides, int reach, unsigned long seed)
{
  enum { TEAMS = 4 };
  static const int threads[TEAMS] = {1, 2, 3, 7};
  gsl_rng *random = random_from(seed);
  struct painting p[TEAMS] = {{.scene = scene_box(97, 163, 0.02, sides)}};
  scatter(&p[0].scene, 60, 20, random);
  for (int k = 0; k < TEAMS; k++) {
    p[k].scene = p[0].scene;
    begin(&p[k], reach);
  }
  for (int step = 0; step < 30; step++) {
    for (int k = 0; k < TEAMS; k++) {
      memcpy(p[k].discs.x, p[0].discs.x, p[0].discs.count * sizeof(double));
      memcpy(p[k].discs.y, p[0].discs.y, p[0].discs.count * sizeof(double));
      memcpy(p[k].discs.omega, p[0].discs.omega, p[0].discs.count * sizeof(double));
      paint_by_threads(&p[k], threads[k]);
      const char *difference = compare(&p[0].occupation, &p[k].occupation);
      cr_assert_null(difference, "seed %lu, reach %d, step %d, %d threads: %s differ", seed, reach, step, threads[k],
                     difference);
    }
    stir(&p[0], random);
  }
  for (int k = TEAMS - 1; k >= 0; k--) {
    if (k) p[k].scene = (struct scene){0}; /* is p[0]'s */
    end(&p[k]);
  }
  gsl_rng_free(random);
}

Test(occupation, tables_are_the_same_bits_for_any_number_of_threads)
{
  for (int reach = 0; reach < 2; reach++) {
    check_threads(SIDES_PERIODIC, reach, 41 + (unsigned long)reach);
    check_threads(SIDES_CLOSED, reach, 51 + (unsigned long)reach);
  }
}

/* A small box crowded with discs, and the fractions and shares of all of them in all cells. */
enum { CROWD = 22, CROWD_NX = 45, CROWD_NY = 38, CROWD_CELLS = CROWD_NX * CROWD_NY };

struct crowd {
  struct painting p;
  struct pair_list pairs;
  double eps[CROWD][CROWD_CELLS], share[CROWD][CROWD_CELLS];
};

/* Some with nearly or exactly the centre of the one before. */
static void crowd_create(struct crowd *c, enum sides sides, int reach, unsigned long seed)
{
  struct status status;
  gsl_rng *random = random_from(seed);
  c->p.scene = scene_box(CROWD_NX, CROWD_NY, log_uniform(random, 0.002, 0.3), sides);
  c->p.scene.contact.area = AREA_CELLS; /* so that each row notes what it shares */
  scatter(&c->p.scene, CROWD, 10, random);
  c->p.scene.coupling.form = (enum coupling_form)(seed % FORM_COUNT);
  struct disc_spec *discs = c->p.scene.particles.discs;
  for (int i = 3; i < CROWD; i += 3)
    for (int axis = 0; axis < 2; axis++)
      discs[i].position[axis] = fmax(0, discs[i - 1].position[axis] - (i % 2 ? 0 : 1e-9));
  begin(&c->p, reach);
  paint(&c->p);
  for (size_t i = 0; i < CROWD; i++) {
    spread(&c->p, i, c->eps[i]);
    spread_shares(&c->p, i, c->share[i]);
  }
  cr_assert(overlap_create(&c->pairs, CROWD, &status));
  cr_assert(overlap_join(&c->pairs, c->p.occupation.batches, (size_t)c->p.occupation.band_count, CROWD, &status));
  gsl_rng_free(random);
}

static void crowd_destroy(struct crowd *c)
{
  overlap_destroy(&c->pairs);
  end(&c->p);
}

/* Checks a cell's shares and returns how many own it. */
static int check_shares(const struct crowd *c, int cell, unsigned long seed)
{
  double sum = 0, shares = 0;
  int owners = 0;
  for (int i = 0; i < CROWD; i++) {
    owners += c->eps[i][cell] > 0;
    sum += c->eps[i][cell];
    shares += c->share[i][cell];
  }
  if (sum <= 0) return 0;
  const double three_nu = 3 * c->p.scene.fluid.viscosity, total = fmin(1, sum);
  const bool between = owners > 1 || occupation_at_side(&c->p.occupation, cell % CROWD_NX, cell / CROWD_NX);
  const bool midpoint = c->p.scene.coupling.form == FORM_MIDPOINT;
  const double damping = between ? 0.5 : fmin(0.5, 0.006 / three_nu), most = midpoint ? 1 / (1 + damping) : 1;
  const double whole = fmin(most, total * three_nu / (1 - total + three_nu * (midpoint ? total : 1))); /* weight.h */
  const double accuracy = 1e-14 + 1e-15 / three_nu; /* by which round-off in eps changes B */
  cr_expect_float_eq(shares, whole, accuracy, "seed %lu, cell %d: %.17g, not %.17g", seed, cell, shares, whole);
  for (int i = 0; i < CROWD; i++)
    cr_expect_float_eq(c->share[i][cell], c->eps[i][cell] / sum * whole, accuracy, "seed %lu, cell %d, disc %d", seed,
                       cell, i);
  return owners;
}

static const enum sides both_sides[] = {SIDES_PERIODIC, SIDES_CLOSED};

Test(occupation, owners_share_a_cell_in_proportion_to_what_they_cover)
{
  static struct crowd c;
  int most = 0;
  for (unsigned long seed = 61; seed < 91; seed++) {
    crowd_create(&c, both_sides[seed % 2], seed % 4 < 2, seed);
    for (size_t i = 0; i < CROWD; i++) {
      const double worst = worst_cell(&c.p, i);
      cr_expect(worst < 1e-10, "seed %lu, disc %zu: %g", seed, i, worst);
    }
    for (int cell = 0; cell < CROWD_CELLS; cell++) {
      const int owners = check_shares(&c, cell, seed);
      if (owners > most) most = owners;
    }
    crowd_destroy(&c);
  }
  cr_assert(most >= 6, "at most %d owners: not crowded enough", most);
}

static const struct near_pair *find_pair(const struct pair_list *pairs, uint32_t a, uint32_t b)
{
  for (size_t k = 0; k < pairs->count; k++)
    if (pairs->pairs[k].a == a && pairs->pairs[k].b == b) return &pairs->pairs[k];
  return NULL;
}

static void check_order(const struct pair_list *pairs, unsigned long seed)
{
  for (size_t k = 0; k < pairs->count; k++) {
    const struct near_pair *pair = &pairs->pairs[k], *before = pair - (k > 0);
    cr_expect(pair->a < pair->b, "seed %lu: pair (%u, %u)", seed, pair->a, pair->b);
    cr_expect(k == 0 || before->a < pair->a || (before->a == pair->a && before->b < pair->b),
              "seed %lu: (%u, %u) after (%u, %u)", seed, pair->a, pair->b, before->a, before->b);
  }
}

/* Over all cells: whether both discs have part of one, and the area (23) of those. */
static bool meet_by_cells(const struct crowd *c, uint32_t a, uint32_t b, double *area)
{
  bool meet = false;
  *area = 0;
  for (int cell = 0; cell < CROWD_CELLS; cell++) {
    const double eps_a = c->eps[a][cell], eps_b = c->eps[b][cell];
    if (!(eps_a > 0 && eps_b > 0)) continue;
    meet = true;
    *area += fmax(0, eps_a + eps_b - 0.95);
  }
  return meet;
}

/* Gap between two discs, by the nearest images of their centres. */
static double gap_between(const struct painting *p, uint32_t a, uint32_t b)
{
  const double dx = nearest(p, 0, p->discs.x[b] - p->discs.x[a]), dy = nearest(p, 1, p->discs.y[b] - p->discs.y[a]);
  return hypot(dx, dy) - p->discs.radius[a] - p->discs.radius[b];
}

static void check_pairs(const struct crowd *c, int reach, unsigned long seed)
{
  const double furthest = (2 * reach + 1) * M_SQRT2 + 1e-9; /* both in one cell, or in cells that touch */
  check_order(&c->pairs, seed);
  for (uint32_t a = 0; a < CROWD; a++)
    for (uint32_t b = a + 1; b < CROWD; b++) {
      double area;
      const bool meet = meet_by_cells(c, a, b, &area);
      const struct near_pair *pair = find_pair(&c->pairs, a, b);
      cr_expect(pair || !meet, "seed %lu: (%u, %u) share a cell but are no pair", seed, a, b);
      if (!pair) continue;
      cr_expect_float_eq(pair->cells_area, area, 1e-12 * fmax(1, area), "seed %lu: (%u, %u): %.17g, not %.17g", seed, a,
                         b, pair->cells_area, area);
      cr_expect(gap_between(&c->p, a, b) < furthest, "seed %lu: (%u, %u) are far apart", seed, a, b);
    }
}

Test(occupation, pairs_are_the_discs_that_share_a_cell_each_once_with_their_area_by_cells)
{
  static struct crowd c;
  for (unsigned long seed = 101; seed < 161; seed++) {
    const int reach = seed % 4 < 2;
    crowd_create(&c, both_sides[seed % 2], reach, seed);
    check_pairs(&c, reach, seed);
    crowd_destroy(&c);
  }
}

/* All pairs closer than the reach are found; returns how many of them. */
static int check_reach(const struct painting *p, struct pair_list *pairs, unsigned long seed)
{
  struct status status;
  int near = 0;
  cr_assert(overlap_join(pairs, p->occupation.batches, (size_t)p->occupation.band_count, p->occupation.discs, &status));
  for (uint32_t a = 0; a < p->discs.count; a++)
    for (uint32_t b = a + 1; b < p->discs.count; b++) {
      const double gap = gap_between(p, a, b);
      if (gap >= p->occupation.reach) continue;
      const struct near_pair *pair = find_pair(pairs, a, b);
      cr_expect(pair, "seed %lu: (%u, %u) at (%.17g, %.17g) and (%.17g, %.17g), %g apart, are no pair", seed, a, b,
                p->discs.x[a], p->discs.y[a], p->discs.x[b], p->discs.y[b], gap);
      near++;
    }
  return near;
}

static int check_reach_in(enum sides sides, int reach, unsigned long seed)
{
  struct status status;
  gsl_rng *random = random_from(seed);
  struct painting p = {.scene = scene_box(120, 90, 0.02, sides)};
  struct pair_list pairs;
  scatter(&p.scene, 50, 12, random);
  begin(&p, reach);
  cr_assert(overlap_create(&pairs, p.discs.count, &status));
  int near = 0;
  for (int step = 0; step < 300; step++) {
    paint(&p);
    near += check_reach(&p, &pairs, seed);
    stir(&p, random);
  }
  overlap_destroy(&pairs);
  end(&p);
  gsl_rng_free(random);
  return near;
}

Test(occupation, every_pair_that_overlaps_or_is_closer_than_the_reach_is_found)
{
  for (unsigned long k = 0; k < 4; k++) {
    const int reach = k >= 2, near = check_reach_in(both_sides[k % 2], reach, 171 + k);
    cr_assert(near > 1000, "only %d pairs within reach %d: nothing shown", near, reach);
  }
}

/* Discs side by side in line with the grid, their gap just below a cell, wherever the grid lines fall. */
Test(occupation, with_reach_neighbours_along_the_grid_are_found_across_periodic_sides)
{
  struct status status;
  struct painting p = {.scene = scene_box(30, 30, 0.02, SIDES_PERIODIC)};
  struct pair_list pairs;
  for (int k = 0; k < 2; k++) scene_add_disc(&p.scene, 2.5, 2, 0, 0);
  begin(&p, 1);
  cr_assert(overlap_create(&pairs, 2, &status));
  for (int axis = 0; axis < 2; axis++)
    for (int n = 0; n < 600; n++) {
      double *along = axis ? p.discs.y : p.discs.x, *across = axis ? p.discs.x : p.discs.y;
      along[0] = n / 20.0;
      along[1] = into_box(&p, axis, along[0] + 5 + 0.999);
      across[0] = across[1] = (7 * n) % 600 / 20.0;
      paint(&p);
      check_reach(&p, &pairs, 0);
    }
  overlap_destroy(&pairs);
  end(&p);
}

/* All pairs whose gap is below the skin, each once with its lower index first, in order. */
static void check_linked_cells(enum sides sides, double edge, unsigned long seed)
{
  const double skin = 0.5;
  gsl_rng *random = random_from(seed);
  struct painting p = {.scene = scene_box(61, 47, 0.02, sides)};
  struct linked_cell linked;
  struct pair_list pairs;
  struct status status;
  struct team team = {0};
  scatter(&p.scene, 120, 3, random);
  begin(&p, 0);
  cr_assert(overlap_create(&pairs, p.discs.count, &status));
  cr_assert(linked_cell_create(&linked, &p.scene, &p.discs, edge, skin, &status));
  cr_assert(linked_cell_find(&linked, &p.discs, &pairs, &team));
  size_t at = 0;
  for (uint32_t a = 0; a < p.discs.count; a++)
    for (uint32_t b = a + 1; b < p.discs.count; b++) {
      const double dx = nearest(&p, 0, p.discs.x[b] - p.discs.x[a]), dy = nearest(&p, 1, p.discs.y[b] - p.discs.y[a]);
      if (hypot(dx, dy) >= p.discs.radius[a] + p.discs.radius[b] + skin) continue;
      cr_assert(at < pairs.count && pairs.pairs[at].a == a && pairs.pairs[at].b == b,
                "sides %d, edge %g, seed %lu: pair %zu is not %u, %u", sides, edge, seed, at, a, b);
      at++;
    }
  cr_expect_eq(at, pairs.count, "sides %d, edge %g, seed %lu: %zu pairs, not %zu", sides, edge, seed, pairs.count, at);
  cr_expect_gt(at, 50, "%zu pairs show little", at);
  linked_cell_destroy(&linked);
  overlap_destroy(&pairs);
  end(&p);
  gsl_rng_free(random);
}

Test(linked_cells, find_each_pair_that_is_near_once_and_in_order)
{
  static const double edges[] = {0, 1.5, 3, 8, 25};
  for (size_t k = 0; k < sizeof edges / sizeof edges[0]; k++)
    for (unsigned long seed = 1; seed <= 4; seed++) {
      check_linked_cells(SIDES_PERIODIC, edges[k], seed);
      check_linked_cells(SIDES_CLOSED, edges[k], seed);
    }
}
