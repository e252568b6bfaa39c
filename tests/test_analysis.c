/* Analysis of constructed histories with known figures. */
#include "analysis/analysis.h"
#include "analysis/plateau.h"
#include "scenes.h"

#include <criterion/criterion.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static struct status status;

static const double no_mean[2] = {NAN, NAN};

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

/* Reads a table from a temporary file. */
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

/* Way and speed at unit intervals. */
static struct plateau plateau_of(const double *speed, size_t count, double least)
{
  double *way = calloc(count, sizeof *way);
  struct plateau plateau;
  for (size_t k = 1; k < count; k++) way[k] = way[k - 1] + speed[k];
  cr_assert(plateau_find(way, speed, count, least, &plateau, &status), "%s", status.message);
  free(way);
  return plateau;
}

Test(plateau, of_an_approach_ends_at_its_terminal_speed)
{
  enum { COUNT = 2000 };
  double speed[COUNT];
  for (int k = 0; k < COUNT; k++) speed[k] = 0.5 * (1 - exp(-k / 100.0));
  const struct plateau p = plateau_of(speed, COUNT, 100);
  cr_assert_eq(p.kind, PLATEAU_FOUND);
  cr_expect_eq(p.first + p.count, COUNT);
  cr_expect_float_eq(fit_spread(speed + p.first, p.count).mean, 0.5, 0.005 * 0.5);
  /* the same, braked at the end: the braked part is excluded, to a third of the tolerance */
  for (int k = 1700; k < COUNT; k++) speed[k] *= exp(-(k - 1700) / 50.0);
  const struct plateau braked = plateau_of(speed, COUNT, 100);
  cr_assert_eq(braked.kind, PLATEAU_FOUND);
  cr_expect(braked.first + braked.count <= 1720, "%zu", braked.first + braked.count);
  cr_expect_float_eq(fit_spread(speed + braked.first, braked.count).mean, 0.5, 0.005 * 0.5);
}

Test(plateau, is_the_last_of_two_and_the_mean_of_an_oscillation)
{
  enum { COUNT = 1500 };
  double speed[COUNT];
  for (int k = 0; k < COUNT; k++) speed[k] = k < 700 ? 1 : 0.9 + 0.05 * sin(2 * M_PI * k / 40.0);
  const struct plateau p = plateau_of(speed, COUNT, 50);
  cr_assert_eq(p.kind, PLATEAU_FOUND);
  cr_expect(p.first >= 680 && p.first < 760 && p.count > 600, "%zu %zu", p.first, p.count);
  cr_expect_float_eq(fit_spread(speed + p.first, p.count).mean, 0.9, 0.9 * plateau_tolerance);
}

Test(plateau, is_absent_where_the_speed_keeps_changing_or_the_way_is_short)
{
  enum { COUNT = 400 };
  double speed[COUNT];
  for (int k = 0; k < COUNT; k++) speed[k] = 1 + 0.001 * k;
  struct plateau p = plateau_of(speed, COUNT, 50);
  cr_expect_eq(p.kind, PLATEAU_CHANGING);
  cr_expect(p.drift > 0.015 && p.drift < 0.04, "two thirds of 3.6 %%: %g", p.drift);
  /* a rise and the same fall have a mean slope of zero and no constant speed */
  for (int k = 0; k < COUNT; k++) speed[k] = 1 + 0.01 * (k < 200 ? k : COUNT - k);
  cr_expect_eq(plateau_of(speed, COUNT, 300).kind, PLATEAU_CHANGING);
  for (int k = 0; k < COUNT; k++) speed[k] = 0.1;
  cr_expect_eq(plateau_of(speed, COUNT, 50).kind, PLATEAU_SHORT);
  cr_expect_eq(plateau_of(speed, COUNT, 39).kind, PLATEAU_FOUND);
  cr_expect_eq(plateau_of(speed, 2, 0).kind, PLATEAU_SHORT, "two values are no stretch");
}

/* A disc of R = 10 that falls from y = 900 in a closed box with acceleration time `time`. */
static void analyse_fall(struct body *body, double terminal, double time)
{
  struct scene scene = scene_box(400, 1000, 0.01, SIDES_CLOSED);
  struct history h = history_of(1, 200, 50);
  scene_add_disc(&scene, 10, 1.01, 200, 900);
  scene.particles.gravity[1] = -0.02;
  double y = 900;
  for (size_t n = 0; n < h.snapshots; n++) {
    const double t = (double)h.step[n], speed = y > 10 ? terminal * (1 - exp(-t / time)) : 0;
    *at(&h, n, 0, HISTORY_Y) = y;
    *at(&h, n, 0, HISTORY_VY) = -speed;
    y = fmax(10, y - 50 * speed);
  }
  cr_assert(body_analyse(body, &scene, no_mean, &h, &status), "%s", status.message);
  history_clear(&h);
  scene_clear(&scene);
}

Test(body, that_keeps_accelerating_or_falls_too_short_has_no_terminal_speed)
{
  struct body body;
  analyse_fall(&body, 0.1, 500);
  cr_expect_str_empty(body.note);
  cr_expect_float_eq(body.speed.mean, 0.1, 0.0003, "%g", body.speed.mean);
  cr_expect_float_eq(body.fastest, 0.1, 1e-6);
  analyse_fall(&body, 1, 100000);
  cr_expect(isnan(body.speed.mean) && isnan(body.reynolds) && isnan(body.drag) && isnan(body.spin));
  cr_expect(strstr(body.note, "still accelerating"), "%s", body.note);
  cr_expect_float_eq(body.fastest, 1 - exp(-9950.0 / 100000), 0.03, "%g", body.fastest);
  analyse_fall(&body, 0.005, 500);
  cr_expect(isnan(body.speed.mean) && strstr(body.note, "2.4 diameters"), "%s", body.note);
}

/* The disc of the case `vert`: it falls relative to the fluid, which rises faster. */
Test(body, in_moving_fluid_has_the_speed_relative_to_it)
{
  struct scene scene = scene_box(60, 180, 0.1, SIDES_PERIODIC);
  struct history h = history_of(1, 200, 100);
  struct body body;
  scene_add_disc(&scene, 6, 1.5, 30, 90);
  scene.particles.gravity[1] = -1e-4;
  for (size_t n = 0; n < h.snapshots; n++) *at(&h, n, 0, HISTORY_VY) = 0.03;
  cr_assert(body_analyse(&body, &scene, (double[2]){0.7, 0.05}, &h, &status), "%s", status.message);
  cr_expect_float_eq(body.speed.mean, 0.02, 1e-12, "slower than the fluid: it falls through it");
  cr_expect_float_eq(body.reynolds, 2 * 0.02 * 6 / 0.1, 1e-9);
  cr_expect_float_eq(body.drag, M_PI * 6 * 1e-4 * 0.5 / (0.02 * 0.02), 1e-9);
  cr_expect_eq(body.relative, AMBIENT_MEAN);
  cr_assert(body_analyse(&body, &scene, (double[2]){0, 0.02}, &h, &status), "%s", status.message);
  cr_expect_float_eq(body.reynolds, 2 * 0.01 * 6 / 0.1, 1e-9, "faster than the fluid, and still positive");
  cr_expect(isnan(body.drag) && strstr(body.note, "against its weight"), "%s", body.note);
  cr_assert(body_analyse(&body, &scene, no_mean, &h, &status), "%s", status.message);
  cr_expect(isnan(body.reynolds) && strstr(body.note, "unknown"), "%s", body.note);
  /* relative to the inlet's velocity with an inlet, to rest with walls across gravity */
  scene.domain.side[SIDE_BOTTOM] = (struct side){SIDE_INLET, {0, 0.06}};
  scene.domain.side[SIDE_TOP].type = SIDE_OUTLET;
  for (size_t n = 0; n < h.snapshots; n++) *at(&h, n, 0, HISTORY_Y) = 90;
  cr_assert(body_analyse(&body, &scene, (double[2]){0, 0.02}, &h, &status), "%s", status.message);
  cr_expect_float_eq(body.speed.mean, 0.03, 1e-12);
  history_clear(&h);
  scene_clear(&scene);
}

/* Discs in fluid that a force drives through a periodic box: in slow flow F = K rho nu U on each disc. */
Test(body, of_held_discs_without_an_inlet_drag_follows_from_the_mean_velocity)
{
  struct scene scene = scene_box(100, 100, 0.1, SIDES_PERIODIC);
  struct history h = history_of(2, 40, 10);
  struct body body;
  const double mean[2] = {0.003, 0.004};
  for (int k = 0; k < 2; k++) scene_add_disc(&scene, 5, 1, 25 + 50 * k, 50)->motion = DISC_FIXED;
  cr_expect_not(body_applies(&scene), "nothing drives the fluid");
  scene.fluid.force[0] = 3e-6;
  scene.fluid.force[1] = 4e-6;
  cr_assert(body_applies(&scene));
  for (size_t n = 30; n < h.snapshots; n++)
    for (size_t i = 0; i < 2; i++) {
      /* 0.01 and 0.03 along the stream, 0.001 a quarter turn counter-clockwise from it */
      const double along = i ? 0.03 : 0.01, across = 0.001;
      *at(&h, n, i, HISTORY_FX) = 0.6 * along - 0.8 * across;
      *at(&h, n, i, HISTORY_FY) = 0.8 * along + 0.6 * across;
    }
  cr_assert(body_analyse(&body, &scene, mean, &h, &status), "%s", status.message);
  cr_expect_float_eq(body.speed.mean, 0.005, 1e-15);
  cr_expect_float_eq(body.reynolds, 2 * 0.005 * 5 / 0.1, 1e-12);
  cr_expect_float_eq(body.drag, 0.02 / (0.005 * 0.005 * 5), 1e-9);
  cr_expect_float_eq(body.resistance, 0.02 / (0.1 * 0.005), 1e-9);
  cr_expect_float_eq(body.lift.mean, 0.001 / (0.005 * 0.005 * 5), 1e-9);
  cr_expect_str_empty(body.note);
  for (size_t n = 35; n < h.snapshots; n++)
    for (size_t i = 0; i < 2; i++) *at(&h, n, i, HISTORY_FX) *= 1.1;
  cr_assert(body_analyse(&body, &scene, mean, &h, &status), "%s", status.message);
  cr_expect(strstr(body.note, "not steady"), "%s", body.note);
  cr_assert(body_analyse(&body, &scene, no_mean, &h, &status), "%s", status.message);
  cr_expect(isnan(body.drag) && strstr(body.note, "unknown"), "%s", body.note);
  /* driven at the fluid's velocity: no relative motion, no analysis */
  for (int k = 0; k < 2; k++) {
    scene.particles.discs[k].motion = DISC_DRIVEN;
    for (int axis = 0; axis < 2; axis++) scene.particles.discs[k].velocity[axis] = mean[axis];
  }
  cr_assert(body_analyse(&body, &scene, mean, &h, &status), "%s", status.message);
  cr_expect(isnan(body.drag) && strstr(body.note, "no mean velocity relative"), "%s", body.note);
  scene.particles.discs[1].velocity[0] = 0;
  cr_expect_not(body_applies(&scene), "two velocities");
  history_clear(&h);
  scene_clear(&scene);
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
  cr_assert(body_analyse(&body, &scene, no_mean, &h, &status), "%s", status.message);
  cr_expect_float_eq(body.reynolds, 200, 1e-9);
  cr_expect_float_eq(body.drag, M_PI * 10 * 0.02 * 0.01 / 0.01, 1e-9);
  cr_expect_float_eq(body.drag_printed, 8 * 10 * 0.02 * 0.01 / (3 * 0.01), 1e-9);
  cr_expect_float_eq(body.spin, 0.1, 1e-9);
  cr_expect_float_eq(body.strouhal, 20 / (0.1 * 1000), 1e-3, "%g", body.strouhal);
  cr_expect_float_eq(body.swing, 0.1, 0.005, "%g", body.swing);
  cr_expect_float_eq(body.growth, 1, 0.05, "%g", body.growth);
  for (size_t n = 300; n < h.snapshots; n++) *at(&h, n, 0, HISTORY_VX) *= 3;
  cr_assert(body_analyse(&body, &scene, no_mean, &h, &status), "%s", status.message);
  cr_expect_gt(body.growth, 2.5);
  /* y > 60, three diameters, until snapshot 367 */
  cr_expect_eq(body.last, 367 * 50);
  cr_expect_str_empty(body.note);
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
  cr_assert(body_analyse(&body, &scene, no_mean, &h, &status), "%s", status.message);
  cr_expect_float_eq(body.drag, 2, 0.005);
  cr_expect_float_eq(body.drag_spread, 0.1, 0.001);
  cr_expect_float_eq(body.lift.mean, -3, 1e-9);
  cr_expect_float_eq(body.torque.mean, 1, 1e-9);
  cr_expect_float_eq(body.spin, 1, 1e-9);
  cr_expect(isnan(body.drag_printed) && isnan(body.strouhal));
  scene.domain.side[SIDE_LEFT] = (struct side){SIDE_WALL, {0, 0}};
  cr_expect_not(body_applies(&scene), "no stream");
  history_clear(&h);
  scene_clear(&scene);
}

/* Trailing is the second disc. With `mirrored` everything is reflected in x; the walls are 200 apart. */
static struct history pair_history(struct scene *scene, bool mirrored)
{
  *scene = scene_box(200, 800, 0.05, SIDES_CLOSED);
  struct history h = history_of(2, 101, 10);
  scene->particles.gravity[1] = -0.02;
  scene_add_disc(scene, 10, 1.01, 100, 700);
  scene_add_disc(scene, 10, 1.01, 110, 750);
  for (size_t n = 0; n < h.snapshots; n++) {
    const double t = (double)h.step[n];
    *at(&h, n, 0, HISTORY_X) = 100 - 0.02 * t;
    *at(&h, n, 0, HISTORY_Y) = 700 - 0.2 * t;
    *at(&h, n, 0, HISTORY_VX) = n == 80 ? -0.3 : -0.02;
    *at(&h, n, 0, HISTORY_VY) = n == 90 ? -0.1 : -0.2;
    *at(&h, n, 1, HISTORY_X) = 100 - 0.02 * t; /* a straight descent on the leading one: no offset */
    *at(&h, n, 1, HISTORY_Y) = 750 - 0.3 * t;
    *at(&h, n, 1, HISTORY_VY) = n == 25 ? -0.31 : n >= 60 ? -0.2 : -0.3;
  }
  for (size_t n = 0; n < h.snapshots && mirrored; n++)
    for (size_t i = 0; i < 2; i++) {
      *at(&h, n, i, HISTORY_X) = 200 - *at(&h, n, i, HISTORY_X);
      *at(&h, n, i, HISTORY_VX) *= -1;
    }
  return h;
}

Test(pair, times_are_found_between_snapshots)
{
  struct scene scene;
  struct history h = pair_history(&scene, false);
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
  cr_expect_float_eq(pair.throw_speed, -0.3, 1e-12);
  cr_expect_float_eq(pair.slow_time, 900, 1e-9);
  cr_expect_float_eq(pair.slow_speed, -0.1, 1e-12);
  cr_expect_float_eq(pair.wall_time, 1000, 1e-9);
  cr_expect_float_eq(pair.wall_distance, 80, 1e-9);
  history_clear(&h);
  scene_clear(&scene);
}

Test(pair, mirrored_left_to_right_has_the_same_events)
{
  struct scene scene, mirror;
  struct history h = pair_history(&scene, false), image = pair_history(&mirror, true);
  struct pair pair = pair_analyse(&scene, &h), other = pair_analyse(&mirror, &image);
  cr_expect_eq(other.throw_speed, -pair.throw_speed);
  other.throw_speed = pair.throw_speed;
  const double *a = (const double *)&pair, *b = (const double *)&other;
  for (size_t k = 0; k < sizeof pair / sizeof *a; k++)
    cr_expect_float_eq(a[k], b[k], 1e-9, "figure %zu: %g, mirrored %g", k, a[k], b[k]);
  history_clear(&h);
  history_clear(&image);
  scene_clear(&scene);
  scene_clear(&mirror);
}

/* A square grid of 20 x 20 discs in 400 x 800, all falling at 0.5 a step, that stop on the bottom row by row at
 * spacing 5 (they may overlap): a bed of pi/4 below a suspension an eighth as dense, with a jump between. */
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
    for (size_t k = 0; k < s.layers; k++) covered += s.concentration[n * s.layers + k] * s.layer * 400;
    cr_expect_float_eq(covered, 400 * M_PI * 25, 1e-6, "profiles hold every disc");
  }
  cr_expect_float_eq(s.band[0][0], 20 + 40 * 1.5, 1e-9);
  /* the bed grows by 5 while the suspension above falls by 35; it grows by two layers in all, hence the tolerance */
  cr_expect_float_eq(s.rise.slope, 0.5 / 7, 0.005, "%g", s.rise.slope);
  cr_expect_lt(s.sharpness, 2 * s.layer, "%g", s.sharpness);
  settling_destroy(&s);
  history_clear(&h);
  scene_clear(&scene);
}

Test(settling, mixing_is_one_for_layers_at_random)
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

/* 500 discs of R = 5 in 400 x 1000, in layers of 20 cells, each disc within one layer. At snapshot n the bed has n
 * layers of 50 discs, below layers of 10, all in the initial order: the interface falls by 80 a snapshot, the
 * sediment rises by 20. The last bed is denser than 50 a layer at its bottom and looser at its top. Snapshots 1 to
 * 6, in which the interface has fallen by 10 to 70 %, are 100 steps apart and the others 1000. */
static struct history layered_history(struct scene *scene)
{
  static const int last[] = {70, 70, 50, 50, 50, 50, 50, 50, 30, 30};
  *scene = scene_box(400, 1000, 0.05, SIDES_CLOSED);
  scene->particles.gravity[1] = -0.02;
  for (int i = 0; i < 500; i++) scene_add_disc(scene, 5, 1.01, 20 + 40 * (i % 10), 10 + 20 * (i / 10));
  struct history h = history_of(500, 11, 1000);
  for (size_t n = 0; n < 11; n++) {
    if (n > 0) h.step[n] = h.step[n - 1] + (n >= 2 && n <= 6 ? 100 : 1000);
    size_t layer = 0, filled = 0;
    for (size_t i = 0; i < 500; i++) {
      const size_t room = n == 10 ? (size_t)last[layer] : layer < n ? 50 : 10;
      *at(&h, n, i, HISTORY_X) = 5 + 390 * (double)filled / (double)room;
      *at(&h, n, i, HISTORY_Y) = 10 + 20 * (double)layer;
      if (++filled == room) layer++, filled = 0;
    }
  }
  return h;
}

/* A figure of the report; NAN if absent. */
static double reported(const struct analysis *analysis, const char *name)
{
  char *text = NULL, key[64];
  size_t size;
  double value, found = NAN;
  FILE *stream = open_memstream(&text, &size);
  analysis_print(analysis, stream);
  fclose(stream);
  for (const char *line = text; line; line = strchr(line, '\n')) {
    line += *line == '\n';
    if (sscanf(line, "%63s %lf", key, &value) == 2 && strcmp(key, name) == 0) found = value;
  }
  free(text);
  return found;
}

Test(settling, of_exact_layers_has_exact_fronts_speeds_and_concentrations)
{
  struct analysis a = {.has_settling = true};
  struct scene scene;
  const double disc = M_PI * 25 / (20 * 400); /* concentration of one disc in a layer */
  a.history = layered_history(&scene);
  a.scene = &scene;
  struct settling *s = &a.settling;
  cr_assert(settling_create(s, &scene, &a.history, &status), "%s", status.message);
  cr_assert_eq(s->layers, 50);
  for (size_t n = 0; n < 10; n++)
    for (size_t l = 0; l < 50; l++) {
      const double discs = l < n ? 50 : l < 50 - 4 * n ? 10 : 0;
      cr_expect_float_eq(s->concentration[n * 50 + l], discs * disc, 1e-12, "snapshot %zu, layer %zu", n, l);
    }
  cr_expect_float_eq(s->bed, 50 * disc, 1e-12, "the middle half: %g", s->bed / disc);
  cr_expect_float_eq(s->initial, 10 * disc, 1e-12);
  for (size_t n = 0; n < 10; n++) {
    /* the mean of the 22 highest: two layers of ten and two discs of the next */
    cr_expect_float_eq(s->interface[n], 20 * (50 - 4 * (double)n - 25.0 / 22), 1e-9, "snapshot %zu", n);
    cr_expect_float_eq(s->front[n], 20 * (double)n, 1e-9, "snapshot %zu: %g", n, s->front[n]);
  }
  cr_expect_float_eq(s->interface[10], 190, 1e-9);
  cr_expect_float_eq(reported(&a, "settling.interface_speed"), 0.8, 1e-7);
  cr_expect_float_eq(reported(&a, "settling.front_speed"), 0.2, 1e-7);
  cr_expect_float_eq(reported(&a, "settling.front_speed_kynch"), 0.2, 1e-7, "discs are conserved");
  cr_expect_float_eq(s->fall.r2, 1, 1e-12);
  cr_expect_float_eq(s->rise.r2, 1, 1e-12);
  cr_expect_float_eq(s->sharpness, 10, 1e-9, "half of the change between the middles of two layers");
  cr_expect(s->settled);
  /* ended at snapshot 6 there is an interface, but no sediment at rest */
  settling_destroy(s);
  a.history.snapshots = 7;
  cr_assert(settling_create(s, &scene, &a.history, &status), "%s", status.message);
  cr_expect_not(s->settled);
  cr_expect_float_eq(reported(&a, "settling.interface_speed"), 0.8, 1e-7);
  cr_expect(isnan(reported(&a, "settling.bed")) && isnan(reported(&a, "settling.front_speed")) &&
            isnan(reported(&a, "settling.front_speed_kynch")) && isnan(reported(&a, "settling.lambda_bed_slope")));
  analysis_destroy(&a);
  scene_clear(&scene);
}

Test(settling, lambda_is_the_diagonal_at_first_then_what_moved_where)
{
  struct scene scene;
  struct history h = layered_history(&scene);
  struct settling s;
  /* at snapshot 7 every layer of the bed has discs of all heights alike */
  for (size_t i = 0; i < 500; i++) *at(&h, 7, i, HISTORY_Y) = 10 + 20 * (double)(i % 10);
  cr_assert(settling_create(&s, &scene, &h, &status), "%s", status.message);
  for (size_t l = 0; l < 50; l++)
    cr_expect_float_eq(s.lambda[l], (double)(l + 1) / 50, 1e-12, "layer %zu: %g", l, s.lambda[l]);
  for (size_t n = 1; n < 7; n++)
    for (size_t l = 0; l < 50; l++) {
      /* layers l_0 of the bed's layers 5 at a time; above, one by one */
      const double expected = l < n ? (5.0 * (double)l + 3) / 50 : l < 50 - 4 * n ? (double)(l + 4 * n + 1) / 50 : NAN;
      const double found = s.lambda[n * 50 + l];
      cr_expect(fabs(found - expected) < 1e-12 || (isnan(found) && isnan(expected)), "snapshot %zu, layer %zu: %g", n,
                l, found);
    }
  for (size_t l = 0; l < 50; l++) {
    const double found = s.lambda[7 * 50 + l];
    cr_expect(l < 10 ? fabs(found - 25.5 / 50) < 1e-12 : isnan(found), "layer %zu: %g", l, found);
  }
  cr_expect_float_eq(s.lambda_above.slope, 1, 1e-9, "nothing overtakes: %g", s.lambda_above.slope);
  cr_expect_float_eq(s.lambda_above.r2, 1, 1e-9);
  settling_destroy(&s);
  /* at the end: mixed alike, a slope of 0; in the order of the start, five to a layer, one of 5 */
  for (int mixed = 0; mixed < 2; mixed++) {
    for (size_t i = 0; i < 500; i++) *at(&h, 10, i, HISTORY_Y) = 10 + 20 * (double)(mixed ? i % 10 : i / 50);
    cr_assert(settling_create(&s, &scene, &h, &status), "%s", status.message);
    cr_expect_float_eq(s.lambda_bed.slope, mixed ? 0 : 5, 1e-9, "%g", s.lambda_bed.slope);
    settling_destroy(&s);
  }
  history_clear(&h);
  scene_clear(&scene);
}

Test(settling, lacey_s_index_is_zero_for_separate_and_exact_for_even_bands)
{
  struct scene scene;
  struct history h = layered_history(&scene);
  struct settling s;
  /* a hundred squares of five discs, one of each band: variance 0, and by chance 0.16/5 */
  for (size_t i = 0; i < 500; i++) {
    *at(&h, 10, i, HISTORY_X) = 25 + 50 * (double)(i % 100 % 8);
    *at(&h, 10, i, HISTORY_Y) = 25 + 50 * (double)(i % 100 / 8);
  }
  cr_assert(settling_create(&s, &scene, &h, &status), "%s", status.message);
  cr_expect_float_eq(s.mixing[0], 0, 1e-12, "bands are 200 high, squares 50: %g", s.mixing[0]);
  cr_expect_float_eq(s.mixing[10], 1 / (1 - 1 / 5.0), 1e-12, "%g", s.mixing[10]);
  for (int k = 0; k < SETTLING_BANDS; k++) cr_expect_float_eq(s.band[0][k], 100 + 200 * k, 1e-9);
  settling_destroy(&s);
  history_clear(&h);
  scene_clear(&scene);
}

Test(settling, layers_that_the_box_cuts_off_and_discs_across_two_count_by_area)
{
  struct scene scene = scene_box(400, 990, 0.05, SIDES_CLOSED);
  struct settling s;
  scene.particles.gravity[1] = -0.02;
  for (int i = 0; i < 40; i++) scene_add_disc(&scene, 5, 1.01, 5 + 10 * i, i < 20 ? 985 : 40);
  struct history h = history_of(40, 2, 10);
  for (size_t n = 0; n < 2; n++)
    for (size_t i = 0; i < 40; i++) *at(&h, n, i, HISTORY_Y) = i < 20 ? 985 : 40;
  cr_assert(settling_create(&s, &scene, &h, &status), "%s", status.message);
  cr_assert_eq(s.layers, 50);
  cr_expect_float_eq(s.concentration[49], 20 * M_PI * 25 / (10 * 400), 1e-12, "half a layer");
  cr_expect_float_eq(s.concentration[1], 10 * M_PI * 25 / (20 * 400), 1e-12);
  cr_expect_float_eq(s.concentration[2], 10 * M_PI * 25 / (20 * 400), 1e-12);
  cr_expect_float_eq(s.front[0], 990, 1e-9, "sediment to the top: %g", s.front[0]);
  settling_destroy(&s);
  history_clear(&h);
  scene_clear(&scene);
}
