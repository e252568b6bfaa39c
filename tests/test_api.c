/* The public library: from C code as a user would write it, and from outside as it is installed. */
#include "forge.h"
#include "shell.h"

#include "delbm/delbm.h"

#include <math.h>
#include <omp.h>

TestSuite(api, .timeout = 100 * SLOWNESS);
TestSuite(installed, .init = shell_enter, .fini = shell_leave, .timeout = 170 * SLOWNESS);

static const char *const crowd =
    "domain: {size: [120, 100], left: periodic, right: periodic}\n"
    "fluid: {viscosity: 0.03, force: [1e-5, 0]}\n"
    "particles:\n"
    "  density: 1.3\n"
    "  gravity: [0, -4e-4]\n"
    "  discs:\n"
    "    - {radius: 6, position: [30, 80], driven: true, velocity: [0.01, 0], spin: 0.002}\n"
    "    - {radius: 7, position: [90, 20], fixed: true}\n"
    "  fill: {pattern: jittered-grid, spacing: 20, radius: 5, jitter: 1, seed: 5, "
    "region: [20, 30, 110, 70]}\n";

enum { MOST_DISCS = 32 };

static struct delbm_simulation *opened(const char *text)
{
  struct delbm_simulation *simulation;
  struct delbm_status status;
  cr_assert_eq(delbm_open_text(&simulation, text, NULL, 0, &status), DELBM_OK, "%s", status.message);
  return simulation;
}

static void step(struct delbm_simulation *simulation, int64_t steps)
{
  struct delbm_status status;
  cr_assert_eq(delbm_step(simulation, steps, &status), DELBM_OK, "%s", status.message);
}

/* All discs; returns their number. */
static size_t discs_of(const struct delbm_simulation *simulation, struct delbm_disc_state states[MOST_DISCS])
{
  const size_t count = delbm_disc_count(simulation);
  cr_assert_leq(count, MOST_DISCS);
  cr_assert_eq(delbm_read_discs(simulation, 0, count, states, NULL), DELBM_OK);
  return count;
}

/* Expects the same discs, bit for bit. */
static void expect_same(const char *what, const struct delbm_simulation *a, const struct delbm_simulation *b)
{
  struct delbm_disc_state of_a[MOST_DISCS], of_b[MOST_DISCS];
  const size_t count = discs_of(a, of_a);
  cr_assert_eq(discs_of(b, of_b), count);
  cr_expect_eq(delbm_time(a), delbm_time(b));
  cr_expect_eq(memcmp(of_a, of_b, count * sizeof of_a[0]), 0, "%s", what);
}

static double *field(struct delbm_simulation *simulation, enum delbm_field which)
{
  double *values = calloc((size_t)delbm_size(simulation, 0) * (size_t)delbm_size(simulation, 1), sizeof *values);
  cr_assert_eq(delbm_read_field(simulation, which, values, NULL), DELBM_OK);
  return values;
}

Test(api, steps_in_parts_have_the_bits_of_delbm_run)
{
  shell_enter();
  shell_write("case.yaml", crowd);
  cr_assert_eq(shell("$DELBM run case.yaml --quiet --out out --set run.steps=150 --set output.every=150 >log"), 0);
  struct delbm_simulation *simulation = opened(crowd);
  for (int part = 1; part <= 5; part++) step(simulation, 10 * part);
  struct delbm_disc_state s[MOST_DISCS];
  const size_t count = discs_of(simulation, s);
  FILE *file = fopen("expected", "w");
  for (size_t i = 0; i < count; i++)
    fprintf(file, "150,%zu,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", i,
            s[i].position[0], s[i].position[1], s[i].velocity[0], s[i].velocity[1], s[i].spin, s[i].angle,
            s[i].force[0], s[i].force[1], s[i].torque, s[i].contact_force[0], s[i].contact_force[1],
            s[i].contact_torque);
  fclose(file);
  cr_expect_eq(shell("sed 's/,-0$/,0/; s/,-0,/,0,/g' expected >e; sed 's/,-0$/,0/; s/,-0,/,0,/g' out/particles.csv | "
                     "grep ^150 | cmp - e"),
               0);
  delbm_close(simulation);
  shell_leave();
}

Test(api, a_scene_in_structs_equals_its_text)
{
  const struct delbm_disc discs[] = {{.radius = 6, .density = 1.2, .position = {30, 60}, .angle = 0.5},
                                     {.radius = 8, .position = {70, 40}, .spin = 0.003, .motion = DELBM_FIXED}};
  const struct delbm_scene scene = {.size = {100, 90},
                                    .left = {DELBM_INLET, {0.02, 0}},
                                    .right = {DELBM_OUTLET, {0, 0}},
                                    .viscosity = 0.04,
                                    .gravity = {0, -1e-4},
                                    .discs = discs,
                                    .disc_count = 2};
  const char *const settings[] = {"coupling.form=unified", "fluid.precision=single"};
  struct delbm_simulation *a, *b;
  struct delbm_status status;
  cr_assert_eq(delbm_open_scene(&a, &scene, settings, 2, &status), DELBM_OK, "%s", status.message);
  b = opened("domain: {size: [100, 90], left: {type: inlet, velocity: [0.02, 0]}, right: outlet}\n"
             "fluid: {viscosity: 0.04, precision: single}\n"
             "coupling: {form: unified}\n"
             "particles:\n"
             "  gravity: [0, -1e-4]\n"
             "  discs:\n"
             "    - {radius: 6, density: 1.2, position: [30, 60], angle: 0.5}\n"
             "    - {radius: 8, position: [70, 40], spin: 0.003, fixed: true}\n");
  step(a, 80);
  step(b, 80);
  expect_same("structs and text", a, b);
  delbm_close(a);
  delbm_close(b);
}

Test(api, discs_written_back_as_they_were_change_nothing)
{
  struct delbm_simulation *a = opened(crowd), *b = opened(crowd);
  struct delbm_disc_state states[MOST_DISCS];
  for (int part = 0; part < 3; part++) {
    step(a, 31);
    step(b, 31);
    const size_t count = discs_of(b, states);
    cr_assert_eq(delbm_write_discs(b, 0, count, states, NULL), DELBM_OK);
    expect_same("written back", a, b);
  }
  delbm_close(a);
  delbm_close(b);
}

/* Opens a box of 60 x 60 cells with these discs, and returns the code and message. */
static enum delbm_code opening(const char *discs, struct delbm_status *status)
{
  char text[512];
  struct delbm_simulation *s;
  snprintf(text, sizeof text,
           "{domain: {size: [60, 60]}, fluid: {viscosity: 0.05}, contact: {stiffness: 0.25}, particles: {density: 50, "
           "discs: [%s]}}",
           discs);
  const enum delbm_code code = delbm_open_text(&s, text, NULL, 0, status);
  delbm_close(s);
  return code;
}

Test(api, discs_that_start_too_deep_in_a_side_or_in_another_or_run_too_deep_into_a_side_are_refused_with_the_depth)
{
  static const struct {
    const char *discs, *said; /* NULL: nothing */
  } cases[] = {{"{radius: 10, position: [30, 6.1]}", NULL},
               {"{radius: 10, position: [30, 5.9]}", "not 4.1 beyond the bottom one"},
               {"{radius: 10, position: [55, 30]}", "not 5 beyond the right one"},
               {"{radius: 10, position: [55, 30], fixed: true}", NULL},
               {"{radius: 8, position: [30, 30]}, {radius: 9, position: [30, 39.1]}", NULL},
               {"{radius: 8, position: [30, 30]}, {radius: 9, position: [30, 38.9]}", "not 8.1 within disc 1"},
               {"{radius: 8, position: [30, 30], fixed: true}, {radius: 9, position: [30, 32], fixed: true}", NULL},
               {"{radius: 10, position: [30, 12], velocity: [0, -0.08]}", "cells beyond the bottom side, not 10."},
               {"{radius: 10, position: [30, 12], velocity: [0, 0.005]}", NULL},
               {"{radius: 10, position: [30, 12], velocity: [0, -0.005]}", NULL}};
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
    struct delbm_status status;
    const enum delbm_code code = opening(cases[k].discs, &status);
    cr_expect_eq(code, cases[k].said ? DELBM_INVALID : DELBM_OK, "%s: %d, %s", cases[k].discs, code, status.message);
    if (cases[k].said) cr_expect(strstr(status.message, cases[k].said), "%s: %s", cases[k].discs, status.message);
  }
}

Test(api, discs_go_where_they_are_put)
{
  struct delbm_simulation *s = opened(crowd);
  struct delbm_disc_state states[MOST_DISCS];
  step(s, 3);
  discs_of(s, states);
  states[1].position[0] = 60.25;
  states[1].position[1] = 13;
  cr_assert_eq(delbm_write_discs(s, 1, 1, &states[1], NULL), DELBM_OK);
  double *eps = field(s, DELBM_OCCUPATION), area = 0;
  for (int y = 5; y < 21; y++)
    for (int x = 50; x < 70; x++) area += eps[y * 120 + x];
  cr_expect_float_eq(area, M_PI * 49, 1e-9, "the fixed disc covers its new place");
  cr_expect_eq(eps[20 * 120 + 90], 0, "and not its old one");
  step(s, 3);
  free(eps);
  delbm_close(s);
}

Test(api, a_disc_that_is_wrong_leaves_all_as_it_was)
{
  struct delbm_simulation *s = opened(crowd);
  struct delbm_disc_state was[MOST_DISCS], wrong[MOST_DISCS], now[MOST_DISCS];
  struct delbm_status status;
  const size_t count = discs_of(s, was);
  const double values[] = {NAN, INFINITY, -1, 1e9};
  for (size_t k = 0; k < sizeof values / sizeof values[0]; k++) {
    memcpy(wrong, was, sizeof was);
    wrong[0].velocity[0] = 0;
    wrong[count - 1].position[0] = values[k];
    cr_expect_eq(delbm_write_discs(s, 0, count, wrong, &status), DELBM_USAGE);
    cr_expect(strstr(status.message, "outside of the box of 120 x 100"), "%s", status.message);
  }
  wrong[1].velocity[0] = 0.01;
  cr_expect_eq(delbm_write_discs(s, 1, 1, &wrong[1], &status), DELBM_USAGE);
  cr_expect(strstr(status.message, "disc 1: velocity (0.01, 0) of a fixed disc"), "%s", status.message);
  cr_expect_eq(delbm_write_discs(s, count, 1, was, NULL), DELBM_USAGE);
  cr_expect_eq(delbm_read_discs(s, 1, SIZE_MAX, now, NULL), DELBM_USAGE);
  discs_of(s, now);
  cr_expect_eq(memcmp(was, now, count * sizeof was[0]), 0);
  delbm_close(s);
}

Test(api, fluid_reads_back_as_it_was_written)
{
  struct delbm_simulation *s = opened(crowd);
  const size_t nx = 120, cells = nx * 100;
  double *rho = calloc(3 * cells, sizeof *rho), *ux = rho + cells, *uy = ux + cells;
  for (size_t k = 0; k < cells; k++) {
    rho[k] = 1 + 0.01 * sin(0.3 * (double)(k % nx));
    ux[k] = 0.02 * cos(0.2 * (double)(k / nx));
    uy[k] = -0.01 * sin(0.1 * (double)k);
  }
  for (int steps = 0; steps < 2; steps++) {
    cr_assert_eq(delbm_write_fluid(s, rho, ux, uy, NULL), DELBM_OK);
    double *read[] = {field(s, DELBM_DENSITY), field(s, DELBM_VELOCITY_X), field(s, DELBM_VELOCITY_Y)};
    double *covered = field(s, DELBM_OCCUPATION), worst = 0;
    for (size_t k = 0; k < cells; k++) {
      worst = fmax(worst, fabs(read[0][k] - rho[k]));
      if (covered[k] == 0) worst = fmax(worst, fmax(fabs(read[1][k] - ux[k]), fabs(read[2][k] - uy[k])));
    }
    cr_expect_lt(worst, 1e-14, "after %d steps: %g", steps, worst);
    free(covered);
    for (int k = 0; k < 3; k++) free(read[k]);
    step(s, 1);
  }
  rho[17] = 0;
  cr_expect_eq(delbm_write_fluid(s, rho, ux, uy, NULL), DELBM_USAGE);
  free(rho);
  delbm_close(s);
}

/* A uniform stream written over all cells. */
static void write_stream(struct delbm_simulation *s, double ux, double uy)
{
  const size_t cells = (size_t)delbm_size(s, 0) * (size_t)delbm_size(s, 1);
  double *values = calloc(3 * cells, sizeof *values);
  for (size_t k = 0; k < cells; k++) values[k] = 1, values[cells + k] = ux, values[2 * cells + k] = uy;
  cr_assert_eq(delbm_write_fluid(s, values, values + cells, values + 2 * cells, NULL), DELBM_OK);
  free(values);
}

Test(api, fluid_written_over_a_disc_takes_its_motion_in_proportion_to_the_weight_of_the_cell)
{
  static const double v[2] = {-0.01, 0.02}, spin = 0.003, stream[2] = {0.05, -0.01};
  struct delbm_simulation *s =
      opened("domain: {size: [40, 40], left: periodic, right: periodic, bottom: periodic, top: periodic}\n"
             "fluid: {viscosity: 0.1}\n"
             "coupling: {form: owen}\n"
             "particles: {discs: [{radius: 6, position: [20.3, 19.8], driven: true, velocity: [-0.01, 0.02], spin: "
             "0.003}]}\n");
  write_stream(s, stream[0], stream[1]);
  double *eps = field(s, DELBM_OCCUPATION), *u[2] = {field(s, DELBM_VELOCITY_X), field(s, DELBM_VELOCITY_Y)};
  for (int k = 0; k < 1600; k++) {
    const double b = eps[k] * 0.3 / (1 - eps[k] + 0.3); /* (19) */
    const double solid[2] = {v[0] - spin * (k / 40 + 0.5 - 19.8), v[1] + spin * (k % 40 + 0.5 - 20.3)};
    for (int axis = 0; axis < 2; axis++)
      cr_expect_float_eq(u[axis][k], (1 - b) * stream[axis] + b * solid[axis], 1e-14, "cell %d, axis %d", k, axis);
  }
  free(eps);
  free(u[0]);
  free(u[1]);
  delbm_close(s);
}

/* Changes by a caller: 0 a stream over the disc, 1 its position in a stream, 2 its velocity, 3 its spin. */
static void change(struct delbm_simulation *s, int what)
{
  struct delbm_disc_state disc;
  if (what < 2) write_stream(s, 0.05, 0.02);
  cr_assert_eq(delbm_read_discs(s, 0, 1, &disc, NULL), DELBM_OK);
  if (what == 1) disc.position[0] += 17.4, disc.position[1] += 3.3;
  if (what == 2) disc.velocity[0] = 0.03;
  if (what == 3) disc.spin = 0.005;
  cr_assert_eq(delbm_write_discs(s, 0, 1, &disc, NULL), DELBM_OK);
}

/* The largest change of a component of the force, or of the torque over R, from one step to the next, in ten steps. */
static double largest_change(struct delbm_simulation *s, double radius)
{
  struct delbm_disc_state before, after;
  double largest = 0;
  for (int k = 0; k < 10; k++) {
    cr_assert_eq(delbm_read_discs(s, 0, 1, &before, NULL), DELBM_OK);
    step(s, 1);
    cr_assert_eq(delbm_read_discs(s, 0, 1, &after, NULL), DELBM_OK);
    for (int axis = 0; axis < 2; axis++) largest = fmax(largest, fabs(after.force[axis] - before.force[axis]));
    largest = fmax(largest, fabs(after.torque - before.torque) / radius);
  }
  return largest;
}

/* The amplitude of a disc whose inner fluid alternates about its velocity by 0.05 is 2 m_f 0.05 = 8. */
Test(api, no_force_alternates_for_ever_after_fluid_is_written_or_a_disc_is_moved)
{
  for (int driven = 0; driven < 2; driven++)
    for (int viscosity = 0; viscosity < 3; viscosity++)
      for (int what = driven ? 1 : 0; what < 4; what++) {
        static const double viscosities[] = {0.005, 0.05, 0.5};
        char text[512];
        if (!driven && what == 2) continue;
        snprintf(text, sizeof text,
                 "domain: {size: [60, 40], left: periodic, right: periodic, bottom: periodic, top: periodic}\n"
                 "fluid: {viscosity: %g}\n"
                 "particles: {discs: [{radius: 5, position: [20.3, 19.8], %s: true}]}\n",
                 viscosities[viscosity], driven ? "driven" : "fixed");
        struct delbm_simulation *s = opened(text);
        step(s, 50);
        change(s, what);
        step(s, 2000);
        const double left = largest_change(s, 5);
        cr_expect_lt(left, 1e-3, "%s, viscosity %g, change %d: %g", driven ? "driven" : "fixed", viscosities[viscosity],
                     what, left);
        delbm_close(s);
      }
}

/* A callback that counts its calls and keeps the velocity, or lets it grow. */
struct driver {
  int calls;
  double faster;
};

static void keep_on(void *context, int64_t at, const struct delbm_disc_state *now, double velocity[2], double *spin)
{
  struct driver *driver = context;
  cr_expect_eq(at, driver->calls);
  cr_expect(now->velocity[0] == velocity[0] && now->spin == *spin);
  driver->calls++;
  velocity[0] += driver->faster;
}

Test(api, a_callback_that_keeps_the_velocity_changes_nothing)
{
  struct delbm_simulation *a = opened(crowd), *b = opened(crowd);
  struct driver driver = {0, 0};
  struct delbm_status status;
  cr_assert_eq(delbm_drive(b, 0, keep_on, &driver, &status), DELBM_OK, "%s", status.message);
  step(a, 60);
  step(b, 60);
  expect_same("driven", a, b);
  cr_expect_eq(driver.calls, 60);
  cr_assert_eq(delbm_drive(b, 0, NULL, NULL, NULL), DELBM_OK);
  step(b, 1);
  cr_expect_eq(driver.calls, 60, "it is asked no more");
  cr_expect_eq(delbm_drive(b, 1, keep_on, &driver, &status), DELBM_USAGE);
  cr_expect(strstr(status.message, "disc 1 is not a driven one"), "%s", status.message);
  delbm_close(a);
  delbm_close(b);
}

/* Speeds up along an axis. */
static void speed_up(void *context, int64_t at, const struct delbm_disc_state *now, double velocity[2], double *spin)
{
  (void)at, (void)now, (void)spin;
  velocity[*(const int *)context] += 1e-4;
}

Test(api, the_force_on_a_disc_that_a_callback_speeds_up_is_the_same_along_x_and_y)
{
  double force[2];
  for (int axis = 0; axis < 2; axis++) {
    struct delbm_disc_state state;
    struct delbm_simulation *s =
        opened("domain: {size: [40, 40], left: periodic, right: periodic, bottom: periodic, top: periodic}\n"
               "fluid: {viscosity: 0.1}\n"
               "particles: {discs: [{radius: 6, position: [20, 20], driven: true}]}\n"
               "run: {steps: 10}\n");
    cr_assert_eq(delbm_drive(s, 0, speed_up, &axis, NULL), DELBM_OK);
    step(s, 5);
    cr_assert_eq(delbm_read_discs(s, 0, 1, &state, NULL), DELBM_OK);
    force[axis] = state.force[axis];
    cr_expect(fabs(state.force[!axis]) < 1e-12);
    delbm_close(s);
  }
  cr_expect(force[0] < 0 && fabs(force[1] / force[0] - 1) < 1e-10, "%g, %g", force[0], force[1]);
}

Test(api, of_two_callbacks_the_remaining_callback_is_still_called)
{
  struct delbm_simulation *s = opened("domain: {size: [60, 40]}\nfluid: {viscosity: 0.1}\n"
                                      "particles:\n  discs:\n"
                                      "    - {radius: 5, position: [15, 20], driven: true}\n"
                                      "    - {radius: 5, position: [45, 20], driven: true}\n"
                                      "run: {steps: 10}\n");
  struct driver first = {0, 0}, second = {0, 0};
  cr_assert_eq(delbm_drive(s, 0, keep_on, &first, NULL) + delbm_drive(s, 1, keep_on, &second, NULL), 0);
  step(s, 2);
  cr_assert_eq(delbm_drive(s, 0, NULL, NULL, NULL), DELBM_OK);
  step(s, 3);
  cr_expect(first.calls == 2 && second.calls == 5, "%d, %d", first.calls, second.calls);
  delbm_close(s);
}

Test(api, steps_below_zero_and_places_on_the_far_edge_are_refused)
{
  struct delbm_simulation *s = opened(crowd);
  struct delbm_disc_state state;
  cr_expect_eq(delbm_step(s, -1, NULL), DELBM_USAGE);
  cr_assert_eq(delbm_read_discs(s, 1, 1, &state, NULL), DELBM_OK);
  state.position[0] = 120;
  cr_expect_eq(delbm_write_discs(s, 1, 1, &state, NULL), DELBM_USAGE);
  delbm_close(s);
}

Test(api, a_callback_that_goes_too_far_is_refused)
{
  struct delbm_simulation *s = opened(crowd);
  struct driver driver = {0, NAN};
  struct delbm_status status;
  cr_assert_eq(delbm_drive(s, 0, keep_on, &driver, NULL), DELBM_OK);
  cr_expect_eq(delbm_step(s, 1, &status), DELBM_USAGE);
  cr_expect(strstr(status.message, "disc 0: velocity (nan, 0)"), "%s", status.message);
  cr_expect_eq(delbm_time(s), 0);
  delbm_close(s);
}

static void go_on(void *context, int64_t at, const struct delbm_disc_state *now, double velocity[2], double *spin)
{
  (void)at, (void)now, (void)spin;
  velocity[0] = *(const double *)context;
}

Test(api, of_two_callbacks_of_which_one_goes_too_far_neither_changes_anything)
{
  static const char *const two = "domain: {size: [80, 60]}\n"
                                 "fluid: {viscosity: 0.05}\n"
                                 "particles:\n"
                                 "  discs:\n"
                                 "    - {radius: 6, position: [20, 30], driven: true}\n"
                                 "    - {radius: 6, position: [60, 30], driven: true}\n";
  double slow = 0.02, fast = 0.5;
  struct delbm_simulation *s = opened(two);
  struct delbm_disc_state was[MOST_DISCS], now[MOST_DISCS];
  step(s, 3);
  discs_of(s, was);
  cr_assert_eq(delbm_drive(s, 0, go_on, &slow, NULL) + delbm_drive(s, 1, go_on, &fast, NULL), 0);
  cr_expect_eq(delbm_step(s, 5, NULL), DELBM_USAGE);
  cr_expect_eq(delbm_time(s), 3);
  discs_of(s, now);
  cr_expect_eq(memcmp(was, now, 2 * sizeof was[0]), 0);
  fast = 0.01;
  step(s, 1);
  discs_of(s, now);
  cr_expect(now[0].velocity[0] == slow && now[1].velocity[0] == fast);
  delbm_close(s);
}

/* A diverged run can be read; other calls fail with the reason of the divergence. */
Test(api, a_run_that_has_diverged_can_be_read_but_not_changed)
{
  shell_enter();
  static double one[120 * 100], rest[120 * 100], thin[120 * 100], jet[120 * 100];
  for (int k = 0; k < 120 * 100; k++) one[k] = 1;
  struct delbm_simulation *s = opened(crowd);
  struct delbm_disc_state states[MOST_DISCS];
  struct delbm_status first, later;
  cr_assert_eq(delbm_save(s, "state", NULL), DELBM_OK);
  discs_of(s, states);
  for (int k = 0; k < 120 * 100; k++) jet[k] = k / 120 % 2 ? 0.3 : -0.3, thin[k] = k / 120 % 2 ? 0.1 : 3;
  cr_assert_eq(delbm_write_fluid(s, thin, jet, rest, NULL), DELBM_OK);
  cr_assert_eq(delbm_step(s, 2000, &first), DELBM_FAILED);
  const int64_t time = delbm_time(s);
  cr_expect_eq(delbm_step(s, 1, &later), DELBM_FAILED);
  cr_expect_str_eq(later.message, first.message);
  cr_expect_eq(delbm_write_discs(s, 0, 1, states, &later), DELBM_FAILED);
  cr_expect_str_eq(later.message, first.message);
  cr_expect_eq(delbm_write_fluid(s, one, rest, rest, &later), DELBM_FAILED);
  cr_expect_eq(delbm_save(s, "other", &later), DELBM_FAILED);
  cr_expect_eq(delbm_load(s, "state", &later), DELBM_FAILED);
  cr_expect_str_eq(later.message, first.message);
  cr_expect_eq(delbm_time(s), time);
  free(field(s, DELBM_OCCUPATION));
  delbm_close(s);
  shell_leave();
}

Test(api, a_state_lost_in_loading_can_only_be_closed)
{
  shell_enter();
  struct delbm_simulation *s = opened(crowd);
  struct delbm_status status;
  struct delbm_disc_state state;
  double *values = field(s, DELBM_DENSITY);
  step(s, 5);
  cr_assert_eq(delbm_save(s, "state", NULL), DELBM_OK);
  forge_step("state", 1);
  cr_expect_eq(delbm_load(s, "state", &status), DELBM_IO);
  cr_expect_str_eq(status.message, "state: its state is of another step");
  cr_expect_eq(delbm_step(s, 1, &status), DELBM_USAGE);
  cr_expect(strstr(status.message, "can only be closed"), "%s", status.message);
  cr_expect_eq(delbm_read_discs(s, 0, 1, &state, NULL), DELBM_USAGE);
  cr_expect_eq(delbm_write_discs(s, 0, 1, &state, NULL), DELBM_USAGE);
  cr_expect_eq(delbm_read_field(s, DELBM_DENSITY, values, NULL), DELBM_USAGE);
  cr_expect_eq(delbm_write_fluid(s, values, values, values, NULL), DELBM_USAGE);
  cr_expect_eq(delbm_drive(s, 0, NULL, NULL, NULL), DELBM_USAGE);
  cr_expect_eq(delbm_save(s, "other", NULL), DELBM_USAGE);
  cr_expect_eq(delbm_load(s, "state", NULL), DELBM_USAGE);
  free(values);
  delbm_close(s);
  shell_leave();
}

Test(api, a_checkpoint_restores_the_bits_and_is_refused_by_another_case)
{
  shell_enter();
  struct delbm_simulation *a = opened(crowd), *b = opened(crowd), *other;
  struct delbm_status status;
  step(a, 77);
  cr_assert_eq(delbm_save(a, "state", &status), DELBM_OK, "%s", status.message);
  cr_assert_eq(delbm_load(b, "state", &status), DELBM_OK, "%s", status.message);
  expect_same("loaded", a, b);
  step(a, 40);
  step(b, 40);
  expect_same("gone on", a, b);
  other = opened("domain: {size: [120, 100]}\nfluid: {viscosity: 0.03}\n");
  cr_expect_eq(delbm_load(other, "state", &status), DELBM_IO);
  cr_expect(strstr(status.message, "of another case"), "%s", status.message);
  cr_expect_eq(delbm_load(other, "nowhere", &status), DELBM_IO);
  step(other, 2);
  cr_expect_eq(delbm_save(other, "no/such/folder", &status), DELBM_IO);
  delbm_close(a);
  delbm_close(b);
  delbm_close(other);
  shell_leave();
}

Test(api, a_checkpoint_of_a_run_can_be_loaded)
{
  shell_enter();
  shell_write("case.yaml", crowd);
  cr_assert_eq(shell("$DELBM run case.yaml --quiet --out o --set run.steps=40 --set output.checkpoint.every=25 >log"),
               0);
  struct delbm_simulation *a = opened(crowd), *b;
  struct delbm_status status;
  cr_assert_eq(delbm_open_file(&b, "o", NULL, 0, &status), DELBM_OK, "%s", status.message);
  cr_assert_eq(delbm_load(b, "o/checkpoint.0", &status), DELBM_OK, "%s", status.message);
  step(a, delbm_time(b));
  expect_same("of a run", a, b);
  cr_expect_eq(delbm_time(b), 25);
  delbm_close(a);
  delbm_close(b);
  shell_leave();
}

/* Result of the calls that step, change and store a simulation. */
struct outcome {
  int wrong; /* calls that failed */
  struct delbm_disc_state discs[MOST_DISCS];
  double velocity[120 * 100];
};

/* Opens, steps, moves a disc, sets the fluid, saves at an odd step, loads into another simulation and continues with
 * it. */
static void use_all_calls(const char *text, const char *path, struct outcome *outcome)
{
  static const double rest[120 * 100];
  struct delbm_simulation *first, *second;
  double *density = calloc(120 * 100, sizeof *density);
  outcome->wrong = delbm_open_text(&first, text, NULL, 0, NULL) != DELBM_OK;
  outcome->wrong += delbm_open_text(&second, text, NULL, 0, NULL) != DELBM_OK;
  const size_t count = delbm_disc_count(first);
  for (size_t k = 0; k < 120 * 100; k++) density[k] = 1 + 1e-3 * sin(0.1 * (double)k);
  outcome->wrong += delbm_step(first, 20, NULL) != DELBM_OK;
  outcome->wrong += delbm_write_fluid(first, density, rest, rest, NULL) != DELBM_OK;
  outcome->wrong += delbm_read_discs(first, 0, count, outcome->discs, NULL) != DELBM_OK;
  outcome->discs[0].position[0] += 2.5;
  outcome->wrong += delbm_write_discs(first, 0, 1, outcome->discs, NULL) != DELBM_OK;
  outcome->wrong += delbm_step(first, 31, NULL) != DELBM_OK;
  outcome->wrong += delbm_save(first, path, NULL) != DELBM_OK;
  outcome->wrong += delbm_load(second, path, NULL) != DELBM_OK;
  outcome->wrong += delbm_step(second, 30, NULL) != DELBM_OK;
  outcome->wrong += delbm_read_discs(second, 0, count, outcome->discs, NULL) != DELBM_OK;
  outcome->wrong += delbm_read_field(second, DELBM_VELOCITY_X, outcome->velocity, NULL) != DELBM_OK;
  delbm_close(first);
  delbm_close(second);
  free(density);
}

/* Inside of a parallel region of the caller, by one thread while the others wait, and by each for itself. */
static void expect_same_in_a_region(const char *text)
{
  enum { THREADS = 3 };
  struct outcome *reference = calloc(1, sizeof *reference), *one = calloc(1, sizeof *one);
  struct outcome *each = calloc(THREADS, sizeof *each);
  use_all_calls(text, "outside", reference);
  cr_assert_eq(reference->wrong, 0);
#pragma omp parallel num_threads(THREADS)
  {
    if (omp_get_thread_num() == THREADS - 1) use_all_calls(text, "one", one);
#pragma omp barrier
    char path[16];
    snprintf(path, sizeof path, "each-%d", omp_get_thread_num());
    use_all_calls(text, path, &each[omp_get_thread_num()]);
  }
  cr_expect_eq(memcmp(one, reference, sizeof *one), 0, "one thread of the region");
  for (int k = 0; k < THREADS; k++) cr_expect_eq(memcmp(&each[k], reference, sizeof *each), 0, "thread %d of all", k);
  free(reference);
  free(one);
  free(each);
}

static const char *const through_outlet =
    "domain: {size: [120, 100], left: {type: inlet, velocity: [0.02, 0]}, right: outlet}\n"
    "fluid: {viscosity: 0.03}\n"
    "particles:\n"
    "  density: 1.3\n"
    "  discs: [{radius: 6, position: [30, 80]}, {radius: 7, position: [110, 30]}, {radius: 7, position: [110, 17.5]}]\n"
    "contact: {search: linked-cell}\n";

Test(api, in_a_parallel_region_of_the_host_gives_the_same_bits_as_outside)
{
  shell_enter();
  omp_set_num_threads(2);
  for (int levels = 1; levels <= 2; levels++) { /* at level 1 the library's regions have one thread each */
    omp_set_max_active_levels(levels);
    expect_same_in_a_region(crowd);
    expect_same_in_a_region(through_outlet);
  }
  shell_leave();
}

Test(api, what_is_wrong_is_told_by_key_and_place)
{
  struct delbm_simulation *s;
  struct delbm_status status;
  cr_expect_eq(delbm_open_text(&s, "domain: {size: [0, 4]}\nfluid: {viscosity: -1}\n", NULL, 0, &status),
               DELBM_INVALID);
  cr_expect_null(s);
  cr_expect(strstr(status.message, "2 errors in case\n") && strstr(status.message, "case:2:20: fluid.viscosity"), "%s",
            status.message);
  struct delbm_scene scene = {.size = {20, 20}, .viscosity = NAN};
  cr_expect_eq(delbm_open_scene(&s, &scene, NULL, 0, &status), DELBM_INVALID);
  cr_expect(strstr(status.message, "scene: fluid.viscosity: got nan"), "%s", status.message);
  scene.viscosity = 0.1;
  scene.top.type = (enum delbm_side_type)77;
  cr_expect_eq(delbm_open_scene(&s, &scene, NULL, 0, &status), DELBM_INVALID);
  cr_expect(strstr(status.message, "domain.top.type: got 77; expected wall, periodic"), "%s", status.message);
  const char *const settings[] = {"fluid.viscosity"};
  cr_expect_eq(delbm_open_scene(&s, &scene, settings, 1, &status), DELBM_USAGE);
  const char *const nameless[] = {"=0.1"};
  cr_expect_eq(delbm_open_scene(&s, &scene, nameless, 1, &status), DELBM_USAGE);
  cr_expect_eq(delbm_open_file(&s, "nowhere.yaml", NULL, 0, &status), DELBM_IO);
  cr_expect_null(s);
  delbm_close(NULL);
}

Test(installed, headers_stand_alone_in_c_and_in_cpp)
{
  cr_expect_eq(shell("for h in %s/*.h; do echo \"#include <delbm/${h##*/}>\"; done >all.h; "
                     "test $(wc -l <all.h) = 3",
                     INCLUDE_DIR "/delbm"),
               0);
  cr_expect_eq(
      shell("while read line; do echo \"$line\" >one.c; cc -std=c17 -Wall -Wextra -Wpedantic -Wstrict-prototypes "
            "-Werror -I%s -c one.c -o one.o || exit 1; done <all.h",
            INCLUDE_DIR),
      0);
  if (shell("command -v c++ >/dev/null") != 0) cr_skip_test("no C++ compiler");
  cr_expect_eq(shell("while read line; do echo \"$line\" >one.cc; c++ -std=c++11 -Wall -Wextra -Wpedantic -Werror -I%s "
                     "-c one.cc -o one.o || exit 1; done <all.h",
                     INCLUDE_DIR),
               0);
}

Test(installed, the_shared_library_shows_its_api_and_never_prints_ends_the_program_or_changes_its_process)
{
  cr_expect_eq(
      shell("nm -D --defined-only %s | awk '$3 !~ /^delbm_/ {print; bad = 1} END {exit bad || NR < 10}'", LIBRARY), 0);
  cr_expect_eq(shell("nm -D -u %s | grep -wE 'exit|_exit|abort|puts|printf|putchar|perror|stdout|stderr|"
                     "signal|sigaction|setlocale|setenv|putenv|umask|chdir|fesetround|atexit'",
                     LIBRARY),
               1);
}

/* Compiles an example by the command in its first lines, with the library as installed by `meson install`, found by
 * pkg-config. */
static void run_example(const char *name)
{
  if (SLOWNESS > 1) cr_skip_test("the library has sanitizers in it, the example none");
  if (shell("command -v meson pkg-config >/dev/null") != 0) cr_skip_test("no meson or no pkg-config");
  cr_assert_eq(shell("meson install -C %s --no-rebuild --quiet --destdir $PWD/root >log 2>&1 || { cat log; exit 1; }",
                     BUILD_DIR),
               0);
  cr_assert_eq(
      shell("pc=$(find root -name delbm.pc); export PKG_CONFIG_SYSROOT_DIR=$PWD/root "
            "PKG_CONFIG_PATH=$PWD/${pc%%/*}; "
            "cc -std=c17 -Wall -Wextra -Wpedantic -Werror %s/%s.c $(pkg-config --cflags --libs delbm) -lm -o x",
            EXAMPLES_DIR, name),
      0);
  cr_assert_eq(shell("so=$(find root -name libdelbm.so); LD_LIBRARY_PATH=${so%%/*} ./x >out"), 0);
}

Test(installed, the_example_settle_goes_on_from_its_checkpoint)
{
  run_example("settle");
  cr_expect_eq(shell("grep -q 'taken up from the checkpoint: the same' out && grep -q '157.08 cells' out"), 0);
}

Test(installed, the_example_oscillate_finds_added_mass_and_drag_of_stokes_within_5_per_cent)
{
  run_example("oscillate");
  cr_expect_eq(shell("awk '/Stokes/ {n++; e = $(NF - 3) / $NF - 1; if (e < -0.05 || e > 0.05) bad = 1} "
                     "END {exit bad || n != 2}' out"),
               0);
}
