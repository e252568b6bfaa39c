/* Occupation: how much of each cell each disc covers, who shares a cell, and who is near whom. */
#include "contact/cells_area.h"
#include "contact/pairs.h"
#include "disc_area.h"
#include "scenes.h"
#include "solid/occupation.h"

#include <criterion/criterion.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* A scene's discs and their occupation of a box of any size. */
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

static void begin(struct painting *p)
{
  struct status status;
  cr_assert(discs_create(&p->discs, &p->scene, &status), "%s", status.message);
  cr_assert(occupation_create(&p->occupation, &p->scene, &p->discs, &status), "%s", status.message);
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

/* Writes one disc's weights w_p B to all cells of the box. */
static void spread_weights(const struct painting *p, size_t disc, double *cells)
{
  const int nx = p->scene.domain.size[0], ny = p->scene.domain.size[1];
  memset(cells, 0, sizeof *cells * (size_t)nx * (size_t)ny);
  for (int y = 0; y < ny; y++) {
    size_t count;
    const struct run *row = occupation_row(&p->occupation, y, &count);
    for (size_t r = 0; r < count; r++)
      for (int k = 0; row[r].owner == disc && k < row[r].n; k++)
        cells[y * nx + row[r].x + k] += occupation_band(&p->occupation, y)->owner_weight[row[r].first + (size_t)k];
  }
}

/* One disc's eps in all cells of the box, from its weights without other discs, in a form whose B determines eps
 * (19). */
static void spread(const struct painting *p, size_t disc, double *cells)
{
  struct painting alone = {.scene = p->scene};
  alone.scene.particles.count = 1;
  alone.scene.particles.discs = &(struct disc_spec){.radius = p->discs.radius[disc], .density = 2};
  alone.scene.coupling.form = FORM_OWEN;
  begin(&alone);
  alone.discs.x[0] = p->discs.x[disc];
  alone.discs.y[0] = p->discs.y[disc];
  paint(&alone);
  spread_weights(&alone, 0, cells);
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

/* Lower left corner of a cell relative to the disc's centre. */
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

/* Intersections of the circle with the strip's lines, between at[0] and at[1]: distinct break points in order. */
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

/* Area of the disc at the origin inside a rectangle, by adaptive quadrature between the intersections of the circle
 * with the rectangle's lines. */
static double area_by_quadrature(double radius, const double low[2], const double high[2], double accuracy)
{
  static gsl_integration_workspace *workspace;
  if (!workspace) workspace = gsl_integration_workspace_alloc(1000);
  struct strip strip = {radius, low[1], high[1]};
  double at[6] = {fmax(low[0], -radius), fmin(high[0], radius)};
  if (at[0] >= at[1]) return 0;
  gsl_function f = {chord_in_strip, &strip};
  double area, error;
  gsl_set_error_handler_off(); /* the error estimate is checked instead */
  gsl_integration_qagp(&f, at, break_points(&strip, at), accuracy / 100, 0, 1000, workspace, &area, &error);
  cr_assert(error < accuracy / 2, "quadrature: error %g", error);
  return area;
}

/* Quadrature of a few of the rim cells. */
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
  begin(p);
  paint(p);
}

Test(occupation, fractions_are_the_areas_of_disc_and_cell_in_common)
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
    const int nx = (int)ceil(1.5 * radius) + 1, ny = (int)ceil(radius) + 1; /* the disc crosses several sides */
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

/* With round numbers a disc's edge may be on a grid line within round-off, which the square root enlarges to half of
 * all digits. */
Test(occupation, edges_on_grid_lines_but_for_round_off_are_painted_like_any_other)
{
  struct painting p = {.scene = scene_box(1100, 48, 0.05, SIDES_PERIODIC)};
  for (int k = 0; k < 40; k++) {
    scene_add_disc(&p.scene, 2 + k / 10.0 + 0.4, 2, 100.05, 24.3);
    scene_add_disc(&p.scene, 2 + k / 10.0, 2, 1000, 24.3);
  }
  begin(&p);
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

Test(occupation, runs_know_where_their_cells_lie_from_the_centre)
{
  struct painting p = {.scene = scene_box(37, 41, 0.05, SIDES_PERIODIC)};
  scene_add_disc(&p.scene, 8.3, 2, 1.7, 40.2);
  scene_add_disc(&p.scene, 3, 2, 36.9, 20.5);
  scene_add_disc(&p.scene, 4.2, 2, 21.6, 18.3); /* clear of all sides */
  begin(&p);
  paint(&p);
  for (int y = 0; y < 41; y++) {
    size_t count;
    const struct run *row = occupation_row(&p.occupation, y, &count);
    for (size_t r = 0; r < count; r++) {
      double corner[2];
      corner_of(&p, row[r].owner, row[r].x, y, corner);
      cr_expect_float_eq(row[r].rx, corner[0] + 0.5, 1e-13, "disc %u, row %d", row[r].owner, y);
      cr_expect_float_eq(row[r].ry, corner[1] + 0.5, 1e-13, "disc %u, row %d", row[r].owner, y);
    }
  }
  end(&p);
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

/* Most discs move by a part of a cell; some jump; some rest, with or without another spin; some are put on a grid
 * line or on the abscissa of another disc. */
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

/* Compares the bits of two tables of the same discs, disc by disc. */
static const char *compare_cells(const struct occupation *a, const struct occupation *b)
{
  const size_t indices = a->discs * sizeof(int32_t);
  if (memcmp(a->column, b->column, indices) || memcmp(a->row, b->row, indices) || memcmp(a->rows, b->rows, indices))
    return "places";
  for (size_t i = 0; i < a->discs; i++) /* index of the sums of a disc's rows */
    if (memcmp(a->run_index + 2 * a->first_row[i], b->run_index + 2 * b->first_row[i],
               2 * (size_t)a->rows[i] * sizeof *a->run_index))
      return "rows of discs";
  return NULL;
}

static bool same_run(const struct run *a, const struct run *b)
{
  return a->x == b->x && a->n == b->n && a->owner == b->owner && a->first == b->first &&
         !memcmp(&a->rx, &b->rx, sizeof a->rx) && !memcmp(&a->ry, &b->ry, sizeof a->ry);
}

/* Compares the bits of two tables disc by disc and band by band. Returns the name of the difference, or NULL. */
static const char *compare(const struct occupation *a, const struct occupation *b)
{
  const char *difference = compare_cells(a, b);
  for (int k = 0; k < a->band_count && !difference; k++) {
    const struct band *s = &a->bands[k], *t = &b->bands[k];
    if (memcmp(s->row_start, t->row_start, sizeof s->row_start) || memcmp(s->row_end, t->row_end, sizeof s->row_end))
      return "rows";
    for (int row = 0; row < BAND_ROWS; row++)
      for (size_t r = s->row_start[row]; r < s->row_end[row]; r++) {
        const size_t first = s->runs[r].first, bytes = (size_t)s->runs[r].n * sizeof(double);
        if (!same_run(&s->runs[r], &t->runs[r])) return "runs";
        if (memcmp(s->owner_weight + first, t->owner_weight + first, bytes)) return "owner weights";
      }
    if (s->shared_cells != t->shared_cells || s->shared_owners != t->shared_owners) return "count of shared cells";
  }
  return difference;
}

/* Compares a table after many steps with a new table at the same positions. */
static const char *compare_with_fresh(const struct painting *p)
{
  struct painting fresh = {.scene = p->scene};
  begin(&fresh);
  memcpy(fresh.discs.x, p->discs.x, p->discs.count * sizeof(double));
  memcpy(fresh.discs.y, p->discs.y, p->discs.count * sizeof(double));
  memcpy(fresh.discs.omega, p->discs.omega, p->discs.count * sizeof(double));
  paint(&fresh);
  const char *difference = compare(&p->occupation, &fresh.occupation);
  fresh.scene = (struct scene){0}; /* is p's */
  end(&fresh);
  return difference;
}

static void check_history(enum sides sides, unsigned long seed)
{
  gsl_rng *random = random_from(seed);
  struct painting p = {.scene = scene_box(97, 83, 0.02, sides)};
  scatter(&p.scene, 30, 30, random);
  begin(&p);
  for (int step = 0; step < 300; step++) {
    paint(&p);
    const char *difference = compare_with_fresh(&p);
    cr_assert_null(difference, "seed %lu, %s, step %d: %s differ", seed,
                   sides == SIDES_PERIODIC ? "periodic" : "closed", step, difference);
    stir(&p, random);
  }
  end(&p);
  gsl_rng_free(random);
}

Test(occupation, tables_depend_on_where_discs_are_and_not_on_where_they_were)
{
  check_history(SIDES_PERIODIC, 21);
  check_history(SIDES_CLOSED, 31);
}

static size_t stale_bands(const struct occupation *o)
{
  size_t count = 0;
  for (int k = 0; k < o->band_count; k++) count += o->changed[k];
  return count;
}

/* One disc moves a step, in a box of many bands. */
static void check_few_move(enum sides sides, unsigned long seed)
{
  gsl_rng *random = random_from(seed);
  struct painting p = {.scene = scene_box(60, 400, 0.02, sides)};
  scatter(&p.scene, 40, 6, random);
  begin(&p);
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
    cr_assert_null(difference, "seed %lu, step %d: %s differ", seed, step, difference);
  }
  paint(&p);
  cr_expect_eq(stale_bands(&p.occupation), 0, "nothing has moved");
  end(&p);
  gsl_rng_free(random);
}

Test(occupation, only_bands_that_a_disc_moves_in_leaves_or_enters_are_painted)
{
  check_few_move(SIDES_PERIODIC, 61);
  check_few_move(SIDES_CLOSED, 71);
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

static void check_threads(enum sides sides, unsigned long seed)
{
  enum { TEAMS = 4 };
  static const int threads[TEAMS] = {1, 2, 3, 7};
  gsl_rng *random = random_from(seed);
  struct painting p[TEAMS] = {{.scene = scene_box(97, 163, 0.02, sides)}};
  scatter(&p[0].scene, 60, 20, random);
  for (int k = 0; k < TEAMS; k++) {
    p[k].scene = p[0].scene;
    begin(&p[k]);
  }
  for (int step = 0; step < 30; step++) {
    for (int k = 0; k < TEAMS; k++) {
      memcpy(p[k].discs.x, p[0].discs.x, p[0].discs.count * sizeof(double));
      memcpy(p[k].discs.y, p[0].discs.y, p[0].discs.count * sizeof(double));
      memcpy(p[k].discs.omega, p[0].discs.omega, p[0].discs.count * sizeof(double));
      paint_by_threads(&p[k], threads[k]);
      const char *difference = compare(&p[0].occupation, &p[k].occupation);
      cr_assert_null(difference, "seed %lu, step %d, %d threads: %s differ", seed, step, threads[k], difference);
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
  check_threads(SIDES_PERIODIC, 41);
  check_threads(SIDES_CLOSED, 51);
}

/* A small crowded box, and the fractions and weights of all discs in all cells. */
enum { CROWD = 22, CROWD_NX = 45, CROWD_NY = 38, CROWD_CELLS = CROWD_NX * CROWD_NY };

struct crowd {
  struct painting p;
  double eps[CROWD][CROWD_CELLS], weight[CROWD][CROWD_CELLS];
};

/* Some with nearly or exactly the centre of the one before. */
static void crowd_create(struct crowd *c, enum sides sides, unsigned long seed)
{
  gsl_rng *random = random_from(seed);
  c->p.scene = scene_box(CROWD_NX, CROWD_NY, log_uniform(random, 0.002, 0.3), sides);
  scatter(&c->p.scene, CROWD, 10, random);
  c->p.scene.coupling.form = (enum coupling_form)(seed % FORM_COUNT);
  struct disc_spec *discs = c->p.scene.particles.discs;
  for (int i = 3; i < CROWD; i += 3)
    for (int axis = 0; axis < 2; axis++)
      discs[i].position[axis] = fmax(0, discs[i - 1].position[axis] - (i % 2 ? 0 : 1e-9));
  begin(&c->p);
  paint(&c->p);
  for (size_t i = 0; i < CROWD; i++) {
    spread(&c->p, i, c->eps[i]);
    spread_weights(&c->p, i, c->weight[i]);
  }
  gsl_rng_free(random);
}

/* Checks the owner weights of a cell and returns the number of its owners. */
static int check_weights(const struct crowd *c, int cell, unsigned long seed)
{
  double sum = 0, weight = 0;
  int owners = 0;
  for (int i = 0; i < CROWD; i++) {
    owners += c->eps[i][cell] > 0;
    sum += c->eps[i][cell];
    weight += c->weight[i][cell];
  }
  if (sum <= 0) return 0;
  const double three_nu = 3 * c->p.scene.fluid.viscosity, total = fmin(1, sum);
  const bool between = owners > 1 || occupation_at_side(&c->p.occupation, cell % CROWD_NX, cell / CROWD_NX);
  const bool midpoint = c->p.scene.coupling.form == FORM_MIDPOINT;
  const double damping = between ? 0.5 : fmin(0.5, 0.006 / three_nu), max_weight = midpoint ? 1 / (1 + damping) : 1;
  const double whole =
      fmin(max_weight, total * three_nu / (1 - total + three_nu * (midpoint ? total : 1))); /* weight.h */
  const double accuracy = 1e-14 + 1e-15 / three_nu; /* change of B by round-off in eps */
  cr_expect_float_eq(weight, whole, accuracy, "seed %lu, cell %d: %.17g, not %.17g", seed, cell, weight, whole);
  for (int i = 0; i < CROWD; i++)
    cr_expect_float_eq(c->weight[i][cell], c->eps[i][cell] / sum * whole, accuracy, "seed %lu, cell %d, disc %d", seed,
                       cell, i);
  return owners;
}

static const enum sides both_sides[] = {SIDES_PERIODIC, SIDES_CLOSED};

Test(occupation, owners_of_a_cell_have_weights_in_proportion_to_their_fractions)
{
  static struct crowd c;
  int most = 0;
  for (unsigned long seed = 61; seed < 91; seed++) {
    crowd_create(&c, both_sides[seed % 2], seed);
    for (size_t i = 0; i < CROWD; i++) {
      const double worst = worst_cell(&c.p, i);
      cr_expect(worst < 1e-10, "seed %lu, disc %zu: %g", seed, i, worst);
    }
    for (int cell = 0; cell < CROWD_CELLS; cell++) {
      const int owners = check_weights(&c, cell, seed);
      if (owners > most) most = owners;
    }
    end(&c.p);
  }
  cr_assert(most >= 6, "at most %d owners: not crowded enough", most);
}

/* Area (23) over all cells of the box, from the fractions of both discs. */
static double area_by_all_cells(const struct crowd *c, uint32_t a, uint32_t b)
{
  double area = 0;
  for (int cell = 0; cell < CROWD_CELLS; cell++) {
    const double eps_a = c->eps[a][cell], eps_b = c->eps[b][cell];
    if (eps_a > 0 && eps_b > 0) area += fmax(0, eps_a + eps_b - 0.95);
  }
  return area;
}

/* Gap between two discs, nearest image. */
static double gap_between(const struct painting *p, uint32_t a, uint32_t b)
{
  const double dx = nearest(p, 0, p->discs.x[b] - p->discs.x[a]), dy = nearest(p, 1, p->discs.y[b] - p->discs.y[a]);
  return hypot(dx, dy) - p->discs.radius[a] - p->discs.radius[b];
}

/* True if neither disc can share cells with two images of the other: a contact is with the nearest image alone. */
static bool is_small(const struct crowd *c, uint32_t a, uint32_t b)
{
  return c->p.discs.radius[a] + c->p.discs.radius[b] < CROWD_NY / 2 - 2;
}

Test(cells_area, is_that_of_the_cells_that_both_discs_cover_and_none_from_its_gap_on)
{
  static struct crowd c;
  int apart = 0;
  for (unsigned long seed = 101; seed < 161; seed++) {
    crowd_create(&c, both_sides[seed % 2], seed);
    double *scratch = calloc(cells_area_scratch(&c.p.discs), sizeof *scratch);
    for (uint32_t a = 0; a < CROWD; a++)
      for (uint32_t b = a + 1; b < CROWD; b++) {
        const double area = area_by_all_cells(&c, a, b), gap = gap_between(&c.p, a, b);
        if (!is_small(&c, a, b)) continue;
        cr_expect_float_eq(cells_area(&c.p.scene, &c.p.discs, a, b, scratch), area, 1e-10 * fmax(1, area),
                           "seed %lu: (%u, %u), gap %g", seed, a, b, gap);
        cr_expect(gap < cells_area_gap || area == 0, "seed %lu: (%u, %u), gap %g: area %g", seed, a, b, gap, area);
        apart += gap > 0 && area > 0;
      }
    free(scratch);
    end(&c.p);
  }
  cr_expect_gt(apart, 5, "%d pairs with an area but no overlap show little", apart);
}

static void update(struct pair_list *pairs, const struct painting *p, int threads)
{
  struct team team = {0};
  omp_set_dynamic(0);
#pragma omp parallel num_threads(threads)
  pairs_update(pairs, &p->occupation, &p->discs, &team, &(bool){false});
  cr_assert_not(team.failed, "%s", team.first.message);
}

/* In order, each once, and all of them whose gap is below `near`; returns how many those are. */
static size_t check_pairs(const struct pair_list *pairs, const struct painting *p, double near, unsigned long seed)
{
  size_t at = 0, count = 0;
  for (size_t k = 1; k < pairs->count; k++) {
    const struct pair *before = &pairs->pairs[k - 1], *pair = &pairs->pairs[k];
    cr_assert(before->a < pair->a || (before->a == pair->a && before->b < pair->b), "seed %lu: (%u, %u), (%u, %u)",
              seed, before->a, before->b, pair->a, pair->b);
  }
  for (uint32_t a = 0; a < p->discs.count; a++)
    for (uint32_t b = a + 1; b < p->discs.count; b++) {
      const double gap = gap_between(p, a, b);
      if (gap >= near) continue;
      while (at < pairs->count && (pairs->pairs[at].a < a || (pairs->pairs[at].a == a && pairs->pairs[at].b < b))) at++;
      cr_assert(at < pairs->count && pairs->pairs[at].a == a && pairs->pairs[at].b == b,
                "seed %lu: (%u, %u) at (%.17g, %.17g) and (%.17g, %.17g), %g apart, are no pair", seed, a, b,
                p->discs.x[a], p->discs.y[a], p->discs.x[b], p->discs.y[b], gap);
      count++;
    }
  return count;
}

/* Expects, for each search, a new list to be all pairs below length plus margin, and an updated list to contain all pairs
 * below the length; returns the number of pairs. */
static size_t check_search(enum sides sides, double near, double edge, unsigned long seed)
{
  struct status status;
  gsl_rng *random = random_from(seed);
  struct painting p = {.scene = scene_box(120, 90, 0.02, sides)};
  struct pair_list pairs, fresh;
  size_t count = 0;
  scatter(&p.scene, 50, 12, random);
  p.scene.contact.search = edge >= 0 ? SEARCH_LINKED_CELL : SEARCH_GRID;
  p.scene.contact.edge = edge;
  begin(&p);
  cr_assert(pairs_create(&pairs, &p.scene, &p.discs, true, near, &status), "%s", status.message);
  for (int step = 0; step < 60; step++) {
    paint(&p);
    update(&pairs, &p, 1 + step % 3);
    count += check_pairs(&pairs, &p, near, seed);
    cr_assert(pairs_create(&fresh, &p.scene, &p.discs, true, near, &status), "%s", status.message);
    update(&fresh, &p, 2);
    cr_expect_eq(check_pairs(&fresh, &p, near + pairs_margin, seed), fresh.count);
    pairs_destroy(&fresh);
    stir(&p, random);
  }
  pairs_destroy(&pairs);
  end(&p);
  gsl_rng_free(random);
  return count;
}

Test(pairs, that_are_near_are_all_listed_in_order_by_the_grid_and_by_linked_cells)
{
  static const double edges[] = {-1, 0, 3, 25}; /* -1: the grid */
  static const double lengths[] = {0, 0.2237, 1};
  for (int e = 0; e < 4; e++)
    for (int l = 0; l < 3; l++)
      for (int s = 0; s < 2; s++) {
        const size_t count = check_search(both_sides[s], lengths[l], edges[e], 171 + (unsigned long)l);
        cr_expect_gt(count, 200, "%zu pairs show little", count);
      }
}

/* Discs side by side in line with the grid, their gap just below the greatest, wherever the grid lines fall. */
Test(pairs, along_the_grid_are_found_across_periodic_sides)
{
  struct status status;
  struct painting p = {.scene = scene_box(30, 30, 0.02, SIDES_PERIODIC)};
  struct pair_list pairs;
  for (int k = 0; k < 2; k++) scene_add_disc(&p.scene, 2.5, 2, 0, 0);
  begin(&p);
  for (int axis = 0; axis < 2; axis++)
    for (int n = 0; n < 600; n++) {
      double *along = axis ? p.discs.y : p.discs.x, *across = axis ? p.discs.x : p.discs.y;
      along[0] = n / 20.0;
      along[1] = into_box(&p, axis, along[0] + 5 + 1 + pairs_margin - 1e-6);
      across[0] = across[1] = (7 * n) % 600 / 20.0;
      paint(&p);
      cr_assert(pairs_create(&pairs, &p.scene, &p.discs, true, 1, &status), "%s", status.message);
      update(&pairs, &p, 1);
      cr_expect_eq(pairs.count, 1, "axis %d, place %d", axis, n);
      pairs_destroy(&pairs);
    }
  end(&p);
}

Test(pairs, list_is_built_anew_when_a_disc_has_moved_half_the_margin_and_not_before)
{
  struct status status;
  struct painting p = {.scene = scene_box(40, 40, 0.02, SIDES_PERIODIC)};
  struct pair_list pairs;
  scene_add_disc(&p.scene, 5, 2, 39.8, 20);
  scene_add_disc(&p.scene, 5, 2, 20, 20);
  begin(&p);
  cr_assert(pairs_create(&pairs, &p.scene, &p.discs, true, 1, &status), "%s", status.message);
  paint(&p);
  update(&pairs, &p, 2);
  p.discs.x[0] = 39.8 + 0.49 * pairs_margin - 40; /* across the side */
  paint(&p);
  update(&pairs, &p, 2);
  cr_expect_eq(pairs.x[0], 39.8);
  p.discs.x[0] = 39.8 + 0.51 * pairs_margin - 40;
  paint(&p);
  update(&pairs, &p, 2);
  cr_expect_eq(pairs.x[0], p.discs.x[0]);
  pairs_destroy(&pairs);
  end(&p);
}
