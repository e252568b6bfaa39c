/* Scenes without fluid: the motion of dry discs against exact solutions, and what is not there. */
#include "drive.h"
#include "json.h"
#include "scenes.h"
#include "shell.h"

#include "delbm/delbm.h"
#include "sim/estimate.h"

#include <math.h>
#include <omp.h>

TestSuite(dry);
TestSuite(program, .init = shell_enter, .fini = shell_leave);

static struct scene dry_box(int nx, int ny, enum sides sides)
{
  struct scene scene = scene_box(nx, ny, 0.1, sides);
  scene_dry(&scene);
  return scene;
}

/* The parabola has no error, and a velocity is that of half a step before the position. Buoyancy would depend on the
 * density. */
Test(dry, discs_of_any_density_fall_along_the_exact_parabola)
{
  static const double density[] = {0.01, 1, 2.5};
  const double g[2] = {1e-5, -2e-5}, v0[2] = {0.02, 0.03};
  struct scene scene = dry_box(300, 300, SIDES_PERIODIC);
  for (int axis = 0; axis < 2; axis++) scene.particles.gravity[axis] = g[axis];
  for (int k = 0; k < 3; k++) {
    struct disc_spec *disc = scene_add_disc(&scene, 5, density[k], 20, 100 + 40 * k);
    for (int axis = 0; axis < 2; axis++) disc->velocity[axis] = v0[axis];
    disc->spin = 0.001;
  }
  struct simulation *simulation = start(&scene);
  const struct discs *d = simulation_discs(simulation);
  for (int t = 1; t <= 2000; t++) {
    advance(simulation, 1);
    if (t % 500 != 1) continue;
    for (int k = 0; k < 3; k++) {
      cr_expect_float_eq(d->x[k], 20 + v0[0] * t + g[0] * t * t / 2, 1e-10, "step %d, disc %d: x %g", t, k, d->x[k]);
      cr_expect_float_eq(d->y[k], 100 + 40 * k + v0[1] * t + g[1] * t * t / 2, 1e-10, "step %d, disc %d", t, k);
      cr_expect_float_eq(d->vx[k], v0[0] + g[0] * (t - 0.5), 1e-14, "step %d, disc %d", t, k);
      cr_expect_float_eq(d->vy[k], v0[1] + g[1] * (t - 0.5), 1e-14, "step %d, disc %d", t, k);
      cr_expect_float_eq(d->angle[k], 0.001 * t, 1e-12);
      cr_expect(d->fx[k] == 0 && d->fy[k] == 0 && d->torque[k] == 0);
    }
  }
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* The largest height after each bounce is its energy; between two steps the parabola is at most g/8 higher. */
Test(dry, a_disc_without_damping_bounces_back_to_its_height)
{
  const double g = 1e-3, radius = 5, height = 5;
  struct scene scene = dry_box(40, 60, SIDES_CLOSED);
  scene.particles.gravity[1] = -g;
  scene.contact.stiffness = 2500;
  scene.contact.damping = 0;
  scene.contact.steps_per_contact = 100;
  scene_add_disc(&scene, radius, 2.5, 20, radius + height);
  struct simulation *simulation = start(&scene);
  const struct discs *d = simulation_discs(simulation);
  int bounces = 0;
  double before = 0, highest = 0;
  for (int t = 0; bounces < 100 && t < 30000; t++) {
    advance(simulation, 1);
    highest = fmax(highest, d->y[0] - radius);
    if (before > 0 && d->vy[0] <= 0) {
      cr_expect(fabs(highest / height - 1) < 1e-3, "bounce %d: height %.9g", bounces, highest);
      bounces++;
      highest = 0;
    }
    before = d->vy[0];
  }
  struct simulation_report report;
  simulation_report(simulation, &report);
  cr_expect_eq(bounces, 100);
  cr_expect_gt(report.max_substeps, 10, "%d sub-steps", report.max_substeps);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

Test(dry, discs_that_collide_head_on_end_with_the_velocities_of_an_elastic_impact)
{
  static const double density[] = {2, 2, 8};
  for (int k = 1; k < 3; k++) {
    struct scene scene = dry_box(100, 60, SIDES_PERIODIC);
    scene.contact.stiffness = 25;
    scene.contact.damping = 0;
    scene.contact.steps_per_contact = 100;
    scene_add_disc(&scene, 5, density[0], 30, 30)->velocity[0] = 0.1;
    scene_add_disc(&scene, 5, density[k], 50, 30)->velocity[0] = -0.02;
    const double a = density[0], b = density[k], centre = (0.1 * a - 0.02 * b) / (a + b);
    struct simulation *simulation = start(&scene);
    struct simulation_report report;
    advance(simulation, 300);
    simulation_report(simulation, &report);
    const struct discs *d = simulation_discs(simulation);
    cr_expect_float_eq(d->vx[0], 2 * centre - 0.1, 1e-4 * 0.12, "densities %g, %g: %.9g", a, b, d->vx[0]);
    cr_expect_float_eq(d->vx[1], 2 * centre + 0.02, 1e-4 * 0.12, "densities %g, %g: %.9g", a, b, d->vx[1]);
    cr_expect(d->vy[0] == 0 && d->vy[1] == 0 && d->omega[0] == 0);
    cr_expect_lt(report.momentum_drift, 1e-15);
    simulation_destroy(simulation);
    scene_clear(&scene);
  }
}

Test(dry, momentum_changes_by_the_weight_alone)
{
  struct scene scene = scene_crowd(160, 160, 5, 14, 2);
  scene_dry(&scene);
  for (int k = 0; k < SIDE_COUNT; k++) scene.domain.side[k].type = SIDE_PERIODIC;
  scene.particles.gravity[1] = -1e-4;
  for (size_t i = 0; i < scene.particles.count; i++) scene.particles.discs[i].velocity[i % 2] = i % 3 ? 0.05 : -0.1;
  struct simulation *simulation = start(&scene);
  struct simulation_report report;
  advance(simulation, 500);
  simulation_report(simulation, &report);
  cr_expect(report.momentum_drift < 1e-14, "%g", report.momentum_drift);
  cr_expect_gt(report.max_substeps, 0);
  cr_expect(report.mass_drift == 0 && report.mean_velocity[1] == 0 && report.max_mach == 0);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

Test(dry, a_disc_at_rest_on_the_ground_bears_its_weight_at_the_velocity_0)
{
  struct scene scene = dry_box(40, 60, SIDES_CLOSED);
  scene.particles.gravity[1] = -1e-4;
  scene.contact.stiffness = 100;
  struct disc_spec *disc = scene_add_disc(&scene, 5, 2.5, 20, 5.5);
  const double weight = 2.5 * disc_spec_area(disc) * 1e-4;
  struct simulation *simulation = start(&scene);
  const struct discs *d = simulation_discs(simulation);
  advance(simulation, 20000);
  cr_expect_float_eq(d->contact_fy[0], weight, 1e-6 * weight, "%.9g of %.9g", d->contact_fy[0], weight);
  cr_expect_lt(fabs(d->vy[0]), 1e-10, "%g", d->vy[0]);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* A slip side is a smooth wall, a driven disc pushes, a fixed one stays. */
Test(dry, free_discs_bounce_off_slip_sides_and_fixed_and_driven_discs)
{
  struct scene scene = dry_box(100, 40, SIDES_CLOSED);
  scene.domain.side[SIDE_LEFT].type = SIDE_SLIP;
  scene.contact.stiffness = 25;
  scene.contact.damping = 0;
  scene.contact.steps_per_contact = 100;
  scene_add_disc(&scene, 5, 2, 20, 10)->velocity[0] = -0.1;
  scene_add_disc(&scene, 5, 2, 50, 10)->motion = DISC_FIXED;
  scene_add_disc(&scene, 5, 2, 80, 10);
  struct disc_spec *driven = scene_add_disc(&scene, 5, 2, 95, 10);
  driven->motion = DISC_DRIVEN;
  driven->velocity[0] = -0.01;
  struct simulation *simulation = start(&scene);
  const struct discs *d = simulation_discs(simulation);
  advance(simulation, 300);
  cr_expect_float_eq(d->vx[0], 0.1, 1e-5, "%.9g", d->vx[0]);
  advance(simulation, 300);
  cr_expect_float_eq(d->vx[0], -0.1, 1e-5, "%.9g", d->vx[0]);
  cr_expect_float_eq(d->vx[2], -0.02, 1e-5, "%.9g", d->vx[2]);
  cr_expect(d->x[1] == 50 && d->vx[3] == -0.01);
  cr_expect_float_eq(d->x[3], 95 - 6, 1e-9);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* After steps of a dense crowd on so many threads. */
static void crowd_on(int threads, double x[], double spin_and_force[])
{
  struct scene scene = scene_crowd(240, 240, 5, 12, 0.9);
  scene_dry(&scene);
  scene.particles.gravity[1] = -2e-4;
  scene.contact.stiffness = 10;
  omp_set_num_threads(threads);
  struct simulation *simulation = start(&scene);
  struct simulation_report report;
  advance(simulation, 400);
  simulation_report(simulation, &report);
  cr_expect_eq(report.threads, threads);
  const struct discs *d = simulation_discs(simulation);
  for (size_t i = 0; i < d->count; i++) {
    x[i] = d->x[i];
    spin_and_force[i] = d->vy[i] + d->contact_fx[i];
  }
  simulation_destroy(simulation);
  scene_clear(&scene);
}

Test(dry, bits_are_independent_of_the_number_of_threads)
{
  enum { DISCS = 400 };
  double x[2][DISCS], other[2][DISCS];
  crowd_on(1, x[0], other[0]);
  for (int threads = 2; threads <= 3; threads++) {
    crowd_on(threads, x[1], other[1]);
    cr_expect_eq(memcmp(x[0], x[1], sizeof x[0]) | memcmp(other[0], other[1], sizeof other[0]), 0, "%d threads",
                 threads);
  }
}

Test(dry, nothing_of_a_lattice_is_allocated)
{
  struct scene scene = dry_box(5000, 5000, SIDES_CLOSED);
  struct simulation_memory memory;
  struct status status;
  for (int k = 0; k < 100; k++) scene_add_disc(&scene, 5, 2, 20 + 40 * k, 100);
  cr_assert(simulation_measure(&scene, &memory, &status), "%s", status.message);
  cr_expect_eq(memory.populations, 0);
  cr_expect_lt(memory.tables, 0.1 * (double)scene_cells(&scene), "%g bytes", memory.tables);
  struct simulation *simulation = start(&scene);
  cr_expect_null(simulation_occupation(simulation));
  cr_expect_str_eq(simulation_kernel(simulation), "none");
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* The estimate is that of info; the discs of a run at the advised gravity reach this speed. */
Test(dry, a_run_with_too_fast_discs_names_the_gravity_at_which_they_are_not)
{
  struct scene scene = dry_box(40, 300, SIDES_CLOSED);
  struct status status;
  scene.particles.gravity[1] = -1e-3;
  scene.run.steps = 3000;
  scene_add_disc(&scene, 5, 2, 20, 205);
  struct simulation *simulation = start(&scene);
  const struct estimate fastest = estimate_fastest(&scene, scene.run.steps);
  cr_expect_float_eq(fastest.speed, sqrt(2 * 1e-3 * 200), 1e-12);
  cr_expect_not(simulation_advance(simulation, 1000, &status));
  cr_expect(strstr(status.message, "contacts may be missed") && strstr(status.message, "particles.gravity <= 0.00022"),
            "%s", status.message);
  cr_expect_null(strstr(status.message, "Mach"));
  simulation_destroy(simulation);
  scene.particles.gravity[1] = -fastest.advised;
  simulation = start(&scene);
  double speed = 0;
  for (int t = 0; t < 1400; t++) {
    advance(simulation, 1);
    speed = fmax(speed, -simulation_discs(simulation)->vy[0]);
  }
  cr_expect_float_eq(speed, scene_max_speed, 0.01 * scene_max_speed, "%g", speed);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

static const char falling[] = "domain: {size: [60, 80]}\n"
                              "fluid: none\n"
                              "particles:\n"
                              "  density: 2\n"
                              "  gravity: [0, -1e-4]\n"
                              "  discs: [{radius: 5, position: [20, 40]}, {radius: 5, position: [24, 60]}]\n"
                              "run: {steps: 900}\n"
                              "output: {every: 100}\n";

Test(dry, discs_of_the_library_move_and_calls_of_the_fluid_are_refused)
{
  struct delbm_simulation *simulation;
  struct delbm_status status;
  struct delbm_disc_state state;
  double values[60 * 80];
  for (int k = 0; k < 60 * 80; k++) values[k] = 1;
  cr_assert_eq(delbm_open_text(&simulation, falling, NULL, 0, &status), DELBM_OK, "%s", status.message);
  cr_expect_eq(delbm_step(simulation, 100, &status), DELBM_OK, "%s", status.message);
  cr_expect_eq(delbm_read_discs(simulation, 1, 1, &state, &status), DELBM_OK);
  cr_expect_float_eq(state.position[1], 59.5, 1e-12);
  for (int field = DELBM_DENSITY; field <= DELBM_OCCUPATION; field++)
    cr_expect_eq(delbm_read_field(simulation, (enum delbm_field)field, values, &status), DELBM_USAGE);
  cr_expect_eq(delbm_write_fluid(simulation, values, values, values, &status), DELBM_USAGE);
  cr_expect(strstr(status.message, "fluid: none"), "%s", status.message);
  state.position[1] = 50;
  cr_expect_eq(delbm_write_discs(simulation, 1, 1, &state, &status), DELBM_OK, "%s", status.message);
  cr_expect_eq(delbm_step(simulation, 1, &status), DELBM_OK, "%s", status.message);
  delbm_close(simulation);
}

Test(dry, a_scene_of_the_library_is_dry_by_a_setting)
{
  static const char *const settings[] = {"fluid=none"};
  struct delbm_simulation *simulation;
  struct delbm_status status;
  struct delbm_disc_state state;
  const struct delbm_disc disc = {.radius = 5, .density = 2, .position = {20, 40}};
  const struct delbm_scene scene = {.size = {60, 80}, .gravity = {0, -1e-4}, .discs = &disc, .disc_count = 1};
  cr_assert_eq(delbm_open_scene(&simulation, &scene, settings, 1, &status), DELBM_OK, "%s", status.message);
  cr_expect_eq(delbm_step(simulation, 100, &status), DELBM_OK, "%s", status.message);
  cr_expect_eq(delbm_read_discs(simulation, 0, 1, &state, &status), DELBM_OK);
  cr_expect_float_eq(state.position[1], 39.5, 1e-12);
  delbm_close(simulation);
}

Test(program, case_written_by_a_dry_run_repeats_it_and_says_fluid_none)
{
  shell_write("case.yaml", falling);
  cr_expect_eq(shell("$DELBM run case.yaml --quiet --out a >line && grep -q '^fluid: none$' a/case.yaml"), 0);
  cr_expect_eq(shell("! grep -Eq 'coupling|fields|plan|viscosity' a/case.yaml"), 0);
  cr_expect_eq(shell("$DELBM run a/case.yaml --quiet --out b >/dev/null && cmp a/particles.csv b/particles.csv"), 0);
  cr_expect_eq(shell("sed 's/fluid: none/fluid: {viscosity: 0.1, precision: single}/' case.yaml >wet.yaml && "
                     "$DELBM run wet.yaml --set fluid=none --quiet --out c >/dev/null && "
                     "cmp a/particles.csv c/particles.csv && cmp a/case.yaml c/case.yaml"),
               0);
  cr_expect_eq(shell("grep -q ' mlups=0 .*kernel=none plan=off .*mass_drift=0 .*max_mach=0 ' line"), 0);
  char *text = json_read("a/run.json");
  cr_assert(text && json_is_valid(text));
  cr_expect_eq(strncmp(json_member(text, "mlups"), "0,", 2), 0);
  cr_expect_eq(strncmp(json_member(text, "mean_uy"), "0,", 2), 0);
  free(text);
}

Test(program, a_dry_run_that_is_resumed_writes_the_bytes_of_an_unbroken_one)
{
  shell_write("case.yaml", falling);
  cr_expect_eq(shell("$DELBM run case.yaml --quiet --out whole >/dev/null"), 0);
  cr_expect_eq(shell("$DELBM run case.yaml --quiet --out part --set run.steps=500 --set output.checkpoint.every=250 "
                     ">/dev/null && $DELBM resume part --steps 900 --quiet >/dev/null && "
                     "cmp whole/particles.csv part/particles.csv"),
               0);
  cr_expect_eq(shell("sed -i 's/fluid: none/fluid: {viscosity: 0.1}/' part/case.yaml; $DELBM resume part 2>err"), 4);
}

Test(program, info_of_a_dry_case_names_what_is_left_out)
{
  shell_write("case.yaml", falling);
  cr_expect_eq(shell("$DELBM info case.yaml >out 2>err && ! test -s err"), 0);
  cr_expect_eq(shell("grep -q '^fluid  *none' out && test $(grep -c 'left out: no fluid' out) = 4"), 0);
  cr_expect_eq(shell("! grep -Eiq 'mach|reynolds|kernel|blocking|coupling|bytes a cell|tau|nan|inf' out"), 0, "info");
  cr_expect_eq(shell("$DELBM info case.yaml --set 'units={dx: 1 mm, dt: 1 ms, density: 1000 kg/m^3}' | "
                     "grep -q 'density 1 is 1000 kg/m'"),
               0);
  cr_expect_eq(
      shell("$DELBM info case.yaml --set particles.gravity=[0,-0.01] | grep -q 'better: particles.gravity <= '"), 0);
  cr_expect_eq(shell("$DELBM run --help-keys | grep -A2 '^fluid.none' | grep -q 'fluid: none'"), 0);
}

Test(program, frames_of_a_dry_run_show_the_discs_and_analyse_has_no_figures_of_a_fluid)
{
  shell_write("case.yaml", falling);
  cr_expect_eq(
      shell("$DELBM run case.yaml --quiet --out a --set 'output.frames={every: 900, discs: speed}' >/dev/null && "
            "test -s a/frames/00000900.png && ! cmp -s a/frames/00000000.png a/frames/00000900.png"),
      0);
  cr_expect_eq(shell("$DELBM run case.yaml --quiet --out a --set 'output.frames={every: 900, quantity: vorticity}' "
                     ">/dev/null && test -s a/frames/00000900.png"),
               0);
  cr_expect_eq(shell("$DELBM analyse a >figures && ! grep -Eq '^(body|pair)' figures"), 0);
  cr_expect_eq(shell("$DELBM run case.yaml --quiet --out a --set 'particles.discs=[{radius: 5, position: [20, 40]}]' "
                     ">/dev/null && $DELBM analyse a >figures && ! grep -q 'body' figures"),
               0);
}
