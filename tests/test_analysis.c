/* What is said about a run: histories made by hand, whose answers are known. */
#include "analysis/analysis.h"
#include "scenes.h"

#include <criterion/criterion.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static struct status status;

static const char *const header = "step,id,x,y,vx,vy,omega,angle,fx,fy,torque,contact_fx,contact_fy,contact_torque\n";

static struct history history_of(size_t discs, size_t snapshots, int64_t every)
{
  struct history h = {.discs = discs, .snapshots = snapshots};
  h.step = calloc(snapshots, sizeof *h.step);
  h.values = calloc(snapshots * discs * HISTORY_COLUMNS, sizeof *h.values);
  for (size_t n = 0; n < snapshots; n++) h.step[n] = (int64_t)n * every;
  return h;
}

static double *at(struct history *h, size_t snapshot, size_t disc, enum history_column column)
{
  return &h->values[(snapshot * h->discs + disc) * HISTORY_COLUMNS + column];
}

/* A table in a file of its own, removed once read. */
static bool read_text(struct history *h, const char *text, size_t discs)
{
  char path[] = "/tmp/delbm-test-XXXXXX";
  const int descriptor = mkstemp(path);
  cr_assert(descriptor >= 0 && write(descriptor, text, strlen(text)) == (ssize_t)strlen(text));
  close(descriptor);
  const bool read = history_read(h, path, discs, &status);
  unlink(path);
  return read;
}

Test(history, reads_whole_snapshots_and_leaves_out_one_cut_short)
{
  char text[1024];
  struct history h;
  snprintf(text, sizeof text, "%s0,0,1,2,3,4,5,6,7,8,9,10,11,12\n0,1,0,0,0,0,0,0,0,0,0,0,0,-1e-3\n%s%s", header,
           "10,0,13,0,0,0,0,0,0,0,0,0,0,0\n10,1,14,0,0,0,0,0,0,0,0,0,0,0\n20,0,15,0,0,0,0,0,0,0,0,0,0,0\n", "20,1,16");
  cr_assert(read_text(&h, text, 2), "%s", status.message);
  cr_expect_eq(h.snapshots, 2);
  cr_expect_eq(h.step[1], 10);
  cr_expect_eq(history_at(&h, 0, 0, HISTORY_CONTACT_TORQUE), 12);
  cr_expect_eq(history_at(&h, 0, 1, HISTORY_CONTACT_TORQUE), -1e-3);
  cr_expect_eq(history_at(&h, 1, 1, HISTORY_X), 14);
  history_clear(&h);
}

Test(history, refuses_what_is_not_a_table_of_the_case_s_discs)
{
  static const char *const broken[] = {"0,1,1,2,3,4,5,6,7,8,9,10,11,12\n", "0,0,1,2,3\n",
                                       "0,0,1,2,3,4,5,6,7,8,9,10,11,x\n", "0,0,1,2,3,4,5,6,7,8,9,10,11,12,13\n", ""};
  struct history h;
  char text[512];
  for (size_t k = 0; k < sizeof broken / sizeof broken[0]; k++) {
    snprintf(text, sizeof text, "%s%s", header, broken[k]);
    cr_expect_not(read_text(&h, text, 1), "%s", broken[k]);
    cr_expect_eq(status.code, DELBM_INVALID);
  }
  cr_expect_not(read_text(&h, "step,id\n", 1));
  cr_expect_not(history_read(&h, "/nonexistent/particles.csv", 1, &status));
  cr_expect_eq(status.code, DELBM_IO);
}

Test(fit, a_line_and_what_it_explains)
{
  const double x[] = {0, 1, 2, 3}, exact[] = {1, 3, 5, 7}, off[] = {1, 4, 4, 7};
  const struct line line = fit_line(x, exact, 4), rough = fit_line(x, off, 4);
  cr_expect_float_eq(line.slope, 2, 1e-12);
  cr_expect_float_eq(line.intercept, 1, 1e-12);
  cr_expect_float_eq(line.r2, 1, 1e-12);
  /* by hand: slope 1.8, residual 1.8, total 18 */
  cr_expect_float_eq(rough.slope, 1.8, 1e-12);
  cr_expect_float_eq(rough.r2, 0.9, 1e-12);
  cr_expect(isnan(fit_line(x, exact, 1).slope));
}

Test(fit, the_strongest_oscillation_between_the_lines_of_the_spectrum)
{
  enum { COUNT = 500 };
  double y[COUNT];
  struct oscillation found;
  for (int k = 0; k < 20; k++) {
    const double frequency = (5 + 0.37 * k) / COUNT;
    for (int n = 0; n < COUNT; n++)
      y[n] = 7 + 0.3 * sin(2 * M_PI * frequency * n + k) + 0.01 * sin(2 * M_PI * 0.31 * n);
    cr_assert(fit_oscillation(y, COUNT, &found, &status));
    cr_expect_float_eq(found.frequency * COUNT, frequency * COUNT, 0.05, "%g for %g", found.frequency, frequency);
    cr_expect_float_eq(found.amplitude, 0.3, 0.012, "%g", found.amplitude);
  }
  for (int n = 0; n < COUNT; n++) y[n] = 3;
  cr_assert(fit_oscillation(y, COUNT, &found, &status));
  cr_expect_eq(found.amplitude, 0);
}

Test(body, of_a_free_disc_drag_follows_from_weight_and_speed)
{
  struct scene scene = scene_box(400, 2000, 0.01, SIDES_CLOSED);
  struct history h = history_of(1, 400, 50);
  struct body body;
  scene_add_disc(&scene, 10, 1.01, 200, 1900);
  scene.particles.gravity[1] = -0.02;
  for (size_t n = 0; n < h.snapshots; n++) {
    *at(&h, n, 0, HISTORY_Y) = 1900 - 5 * (double)n;
    *at(&h, n, 0, HISTORY_VY) = -0.1;
    *at(&h, n, 0, HISTORY_VX) = 0.01 * sin(2 * M_PI * (double)n / 20);
    *at(&h, n, 0, HISTORY_OMEGA) = 1e-3;
  }
  cr_assert(body_applies(&scene));
  cr_assert(body_analyse(&body, &scene, &h, &status), "%s", status.message);
  cr_expect_float_eq(body.reynolds, 200, 1e-9);
  cr_expect_float_eq(body.drag, M_PI * 10 * 0.02 * 0.01 / 0.01, 1e-9);
  cr_expect_float_eq(body.drag_printed, 8 * 10 * 0.02 * 0.01 / (3 * 0.01), 1e-9);
  cr_expect_float_eq(body.spin, 0.1, 1e-9);
  cr_expect_float_eq(body.strouhal, 20 / (0.1 * 1000), 1e-3, "%g", body.strouhal);
  cr_expect_float_eq(body.swing, 0.1, 0.005, "%g", body.swing);
  /* y > 200 until snapshot 340 */
  cr_expect_eq(body.last, 339 * 50);
  history_clear(&h);
  scene_clear(&scene);
}

Test(body, of_a_held_disc_drag_and_lift_follow_from_forces)
{
  struct scene scene = scene_box(400, 400, 0.04, SIDES_CLOSED);
  struct history h = history_of(1, 100, 10);
  struct body body;
  scene.domain.side[SIDE_LEFT] = (struct side){SIDE_INLET, {0.04, 0}};
  scene_add_disc(&scene, 10, 1, 200, 200)->motion = DISC_FIXED;
  for (size_t n = 75; n < h.snapshots; n++) {
    *at(&h, n, 0, HISTORY_FX) = 0.032 + (n % 2 ? 0.0016 : -0.0016);
    *at(&h, n, 0, HISTORY_FY) = -0.048;
    *at(&h, n, 0, HISTORY_TORQUE) = 0.16;
    *at(&h, n, 0, HISTORY_OMEGA) = 0.004;
  }
  cr_assert(body_applies(&scene));
  cr_assert(body_analyse(&body, &scene, &h, &status), "%s", status.message);
  cr_expect_float_eq(body.drag, 2, 0.005);
  cr_expect_float_eq(body.drag_spread, 0.1, 0.001);
  cr_expect_float_eq(body.lift.mean, -3, 1e-9);
  cr_expect_float_eq(body.torque.mean, 1, 1e-9);
  cr_expect_float_eq(body.spin, 1, 1e-9);
  cr_expect(isnan(body.drag_printed) && isnan(body.strouhal));
  scene.domain.side[SIDE_LEFT].type = SIDE_WALL;
  cr_expect_not(body_applies(&scene), "no stream");
  history_clear(&h);
  scene_clear(&scene);
}

Test(pair, times_are_found_between_snapshots)
{
  struct scene scene = scene_box(200, 800, 0.05, SIDES_CLOSED);
  struct history h = history_of(2, 101, 10);
  scene.particles.gravity[1] = -0.02;
  scene_add_disc(&scene, 10, 1.01, 100, 700);
  scene_add_disc(&scene, 10, 1.01, 110, 750); /* trailing is the second */
  for (size_t n = 0; n < h.snapshots; n++) {
    const double t = (double)h.step[n];
    *at(&h, n, 0, HISTORY_X) = 100 - 0.02 * t;
    *at(&h, n, 0, HISTORY_Y) = 700 - 0.2 * t;
    *at(&h, n, 0, HISTORY_VX) = n == 80 ? -0.3 : -0.02;
    *at(&h, n, 0, HISTORY_VY) = -0.2;
    *at(&h, n, 1, HISTORY_X) = 100 - 0.02 * t; /* a straight descent on the leading one: no offset */
    *at(&h, n, 1, HISTORY_Y) = 750 - 0.3 * t;
    *at(&h, n, 1, HISTORY_VY) = n == 25 ? -0.31 : n >= 60 ? -0.2 : -0.3;
  }
  cr_assert(pair_applies(&scene));
  const struct pair pair = pair_analyse(&scene, &h);
  cr_expect_float_eq(pair.draft_time, 250, 1e-9);
  cr_expect_float_eq(pair.draft_speed, -0.31, 1e-12);
  cr_expect_float_eq(pair.kiss_time, 300, 1e-6, "%g", pair.kiss_time);
  cr_expect_float_eq(pair.offset, 0, 1e-9);
  cr_expect_float_eq(pair.tumble_time, 500, 1e-6, "%g", pair.tumble_time);
  cr_expect_float_eq(pair.tumble_height, 600, 1e-6);
  cr_expect(pair.even_time > 590 && pair.even_time <= 600, "%g", pair.even_time);
  cr_expect_float_eq(pair.throw_time, 800, 1e-9);
  cr_expect_float_eq(pair.wall_distance, 80, 1e-9);
  history_clear(&h);
  scene_clear(&scene);
}

/* A square grid of 20 x 20 discs in 400 x 800, all falling at 0.5 a step, that stop on the bottom row by row at spacing 5
 * (they may overlap): a bed of pi/4 below a suspension an eighth as dense, with a jump between. */
static struct history grid_history(struct scene *scene)
{
  *scene = scene_box(400, 800, 0.05, SIDES_CLOSED);
  scene->particles.gravity[1] = -0.02;
  for (int j = 0; j < 20; j++)
    for (int i = 0; i < 20; i++) scene_add_disc(scene, 5, 1.01, 10 + 20 * i, 20 + 40 * j);
  struct history h = history_of(400, 160, 10);
  for (size_t n = 0; n < h.snapshots; n++)
    for (size_t i = 0; i < h.discs; i++) {
      const struct disc_spec *disc = &scene->particles.discs[i];
      const double fallen = disc->position[1] - 0.5 * (double)h.step[n], rest = 5 + 5 * (double)(i / 20);
      *at(&h, n, i, HISTORY_X) = disc->position[0];
      *at(&h, n, i, HISTORY_Y) = fmax(fallen, rest);
    }
  return h;
}

Test(settling, a_grid_that_falls_row_by_row_into_a_bed)
{
  struct scene scene;
  struct history h = grid_history(&scene);
  struct settling s;
  cr_assert(settling_applies(&scene));
  cr_assert(settling_create(&s, &scene, &h, &status), "%s", status.message);
  cr_expect_float_eq(s.initial, M_PI * 25 / 800, 1e-12);
  cr_expect_float_eq(s.interface[0], 780, 1e-9, "the highest row: %g", s.interface[0]);
  cr_expect_float_eq(s.fall.slope, -0.5, 1e-9);
  cr_expect_float_eq(s.fall.r2, 1, 1e-9);
  cr_expect_float_eq(s.bed, M_PI / 4, 0.02, "%g", s.bed);
  cr_expect_float_eq(s.interface[s.snapshots - 1], 100, 1e-9);
  cr_expect_float_eq(s.mixing[0], 0, 0.25, "layers lie in squares of their own but for the edges: %g", s.mixing[0]);
  for (size_t n = 0; n < s.snapshots; n += 20) {
    double covered = 0;
    for (size_t k = 0; k < s.slabs; k++) covered += s.concentration[n * s.slabs + k] * s.slab * 400;
    cr_expect_float_eq(covered, 400 * M_PI * 25, 1e-6, "profiles hold every disc");
  }
  cr_expect_float_eq(s.layer[0][0], 20 + 40 * 1.5, 1e-9);
  /* the bed grows by 5 as the suspension above falls by 35; it grows by two slabs in all, which is how exact this is */
  cr_expect_float_eq(s.rise.slope, 0.5 / 7, 0.005, "%g", s.rise.slope);
  cr_expect_lt(s.sharpness, 2 * s.slab, "%g", s.sharpness);
  settling_destroy(&s);
  history_clear(&h);
  scene_clear(&scene);
}

Test(settling, mixing_is_one_where_chance_has_put_the_layers)
{
  struct scene scene;
  struct history h = grid_history(&scene);
  struct settling s;
  srand(1);
  /* the last snapshot: every disc anywhere */
  for (size_t i = 0; i < h.discs; i++) {
    *at(&h, h.snapshots - 1, i, HISTORY_X) = 400.0 * rand() / RAND_MAX;
    *at(&h, h.snapshots - 1, i, HISTORY_Y) = 300.0 * rand() / RAND_MAX;
  }
  cr_assert(settling_create(&s, &scene, &h, &status), "%s", status.message);
  cr_expect_float_eq(s.mixing[s.snapshots - 1], 1, 0.06, "%g", s.mixing[s.snapshots - 1]);
  settling_destroy(&s);
  history_clear(&h);
  scene_clear(&scene);
}
