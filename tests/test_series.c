/* series.csv: its energies, mean velocity and contacts against exact values, its file, and max_overlap of run.json. */
#include "contact/census.h"
#include "drive.h"
#include "output/series.h"
#include "scenes.h"
#include "shell.h"

#include <gsl/gsl_rng.h>
#include <math.h>

static struct instant instant_of(struct simulation *simulation)
{
  struct instant instant;
  struct status status;
  cr_assert(simulation_instant(simulation, &instant, &status), "%s", status.message);
  return instant;
}

static void expect_close(const char *name, double obtained, double expected, double tolerance)
{
  cr_expect(fabs(obtained - expected) <= tolerance * fabs(expected), "%s: %.17g, expected %.17g", name, obtained,
            expected);
}

/* Uniform flow of the density and velocity in *context. */
static struct flow_state uniform(const void *context, int x, int y)
{
  (void)x, (void)y;
  return *(const struct flow_state *)context;
}

Test(energy, of_uniform_flow_is_half_its_mass_times_its_speed_squared)
{
  struct scene scene = scene_box(40, 30, 0.05, SIDES_PERIODIC);
  const struct flow_state flow = {.density = 1.02, .velocity = {0.03, -0.04}};
  struct simulation *simulation = start(&scene);
  simulation_start(simulation, uniform, &flow);
  for (int steps = 0; steps < 2; steps++) {
    const struct instant at = instant_of(simulation);
    expect_close("kinetic_fluid", at.kinetic_fluid, 1200 * 1.02 * 0.05 * 0.05 / 2, 1e-13);
    expect_close("mean_ux", at.mean_velocity[0], 0.03, 1e-13);
    expect_close("mean_uy", at.mean_velocity[1], -0.04, 1e-13);
    expect_close("excess_mass", at.excess_mass, 1200 * 0.02, 1e-12);
    expect_close("max_mach", at.max_mach, 0.05 * sqrt(3), 1e-13);
    cr_expect(at.kinetic_discs == 0 && at.contacts == 0 && at.max_overlap == 0);
    advance(simulation, 7);
  }
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* After n steps every cell has the velocity n g at the middle of its collision. */
Test(energy, of_fluid_that_a_force_accelerates_counts_half_of_the_coming_force)
{
  struct scene scene = scene_box(20, 20, 0.05, SIDES_PERIODIC);
  scene.fluid.force[0] = 1e-4;
  struct simulation *simulation = start(&scene);
  cr_expect_lt(instant_of(simulation).kinetic_fluid, 1e-30);
  advance(simulation, 50);
  const struct instant at = instant_of(simulation);
  expect_close("mean_ux", at.mean_velocity[0], 50e-4, 1e-12);
  expect_close("kinetic_fluid", at.kinetic_fluid, 400 * 50e-4 * 50e-4 / 2, 1e-12);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* u_x = U sin(k y). */
static const double shear_speed = 0.01;

static struct flow_state shear(const void *context, int x, int y)
{
  const double k = *(const double *)context, at = k * (y + 0.5);
  (void)x;
  return (struct flow_state){
      .density = 1, .velocity = {shear_speed * sin(at), 0}, .gradient = {{0, shear_speed * k * cos(at)}, {0, 0}}};
}

Test(energy, of_a_shear_wave_decays_at_twice_viscosity_times_wave_number_squared)
{
  const double viscosity = 0.05, k = 2 * M_PI / 64;
  struct scene scene = scene_box(4, 64, viscosity, SIDES_PERIODIC);
  struct simulation *simulation = start(&scene);
  simulation_start(simulation, shear, &k);
  const double first = instant_of(simulation).kinetic_fluid;
  expect_close("kinetic_fluid", first, 256 * shear_speed * shear_speed / 4, 1e-12);
  advance(simulation, 1000);
  expect_close("rate of decay", log(first / instant_of(simulation).kinetic_fluid) / 1000, 2 * viscosity * k * k, 0.01);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

Test(energy, of_one_disc_is_that_of_its_mass_and_inertia_less_the_fluid_s)
{
  const double radius = 7, fluid = M_PI * radius * radius, excess = 2.5 - 1, inertia = radius * radius / 2;
  struct scene scene = scene_box(60, 50, 0.05, SIDES_PERIODIC);
  struct disc_spec *spec = scene_add_disc(&scene, radius, 2.5, 30, 25);
  spec->velocity[0] = 0.03;
  spec->velocity[1] = -0.01;
  spec->spin = 0.004;
  struct simulation *simulation = start(&scene);
  const double expected = fluid * excess * (0.03 * 0.03 + 0.01 * 0.01 + inertia * 0.004 * 0.004) / 2;
  expect_close("kinetic_discs", instant_of(simulation).kinetic_discs, expected, 1e-14);
  advance(simulation, 30);
  const struct discs *d = simulation_discs(simulation);
  const double later =
      fluid * excess * (d->vx[0] * d->vx[0] + d->vy[0] * d->vy[0] + inertia * d->omega[0] * d->omega[0]);
  expect_close("kinetic_discs", instant_of(simulation).kinetic_discs, later / 2, 1e-14);
  cr_expect_lt(later / 2, 0.99 * expected);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

Test(energy, without_fluid_is_that_of_the_whole_mass_and_inertia)
{
  struct scene scene = scene_box(60, 50, 0.05, SIDES_CLOSED);
  scene.fluid.none = true;
  struct disc_spec *spec = scene_add_disc(&scene, 7, 2.5, 30, 25);
  spec->velocity[0] = 0.03;
  spec->spin = 0.004;
  scene_add_disc(&scene, 5, 2.5, 30, 36.5);
  struct simulation *simulation = start(&scene);
  const struct instant at = instant_of(simulation);
  const double mass = 2.5 * M_PI * 49;
  expect_close("kinetic_discs", at.kinetic_discs, mass * (0.03 * 0.03 + 49. / 2 * 0.004 * 0.004) / 2, 1e-14);
  cr_expect(at.kinetic_fluid == 0 && at.mean_velocity[0] == 0 && at.mean_velocity[1] == 0);
  cr_expect(at.excess_mass == 0 && at.max_mach == 0);
  cr_expect(at.contacts == 1 && at.max_overlap == 0.1, "%g contacts, %g", at.contacts, at.max_overlap);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* Against the fields, with discs, gravity and a uniform force that changes with time. */
Test(energy, and_mean_velocity_of_fluid_are_those_of_all_cells_inside_discs_too)
{
  enum { NX = 90, NY = 70 };
  static double rho[NX * NY], ux[NX * NY], uy[NX * NY];
  struct scene scene = scene_crowd(NX, NY, 8, 18, 1);
  struct simulation *simulation = start(&scene);
  advance(simulation, 40);
  simulation_fields(simulation, rho, ux, uy);
  double kinetic = 0, mass = 0, momentum = 0;
  for (int k = 0; k < NX * NY; k++) {
    kinetic += rho[k] * (ux[k] * ux[k] + uy[k] * uy[k]) / 2;
    mass += rho[k];
    momentum += rho[k] * uy[k];
  }
  const struct instant at = instant_of(simulation);
  struct simulation_report report;
  simulation_report(simulation, &report);
  expect_close("kinetic_fluid", at.kinetic_fluid, kinetic, 1e-12);
  cr_expect_float_eq(at.excess_mass, mass - NX * NY, 1e-9);
  cr_expect_float_eq(at.mean_velocity[1], momentum / mass, 1e-15);
  for (int axis = 0; axis < 2; axis++) cr_expect_eq(at.mean_velocity[axis], report.mean_velocity[axis]);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

static struct contact_census census_of(const struct scene *scene)
{
  struct contact_census census;
  struct discs discs;
  struct status status;
  cr_assert(discs_create(&discs, scene, &status) && contact_census(scene, &discs, &census, &status), "%s",
            status.message);
  discs_destroy(&discs);
  return census;
}

Test(census, of_placed_discs_is_exact)
{
  struct scene scene = scene_box(100, 60, 0.05, SIDES_PERIODIC);
  scene.domain.side[SIDE_BOTTOM].type = scene.domain.side[SIDE_TOP].type = SIDE_WALL;
  cr_expect_eq(census_of(&scene).contacts, 0);
  scene_add_disc(&scene, 5, 1, 50, 20);
  scene_add_disc(&scene, 5, 1, 60, 20); /* touch, with an overlap of 0 */
  scene_add_disc(&scene, 5, 1, 40, 55); /* touches the top */
  struct contact_census census = census_of(&scene);
  cr_expect(census.contacts == 0 && census.max_overlap == 0);
  scene_add_disc(&scene, 5, 1, 80, 4.5);
  census = census_of(&scene);
  cr_expect(census.contacts == 1 && census.max_overlap == 0.1, "%g", census.max_overlap);
  scene_add_disc(&scene, 8, 1, 2, 30);
  scene_add_disc(&scene, 6, 1, 90, 30); /* across the periodic side: 2 of 6 cells */
  census = census_of(&scene);
  cr_expect(census.contacts == 2 && census.max_overlap == 2. / 6, "%g", census.max_overlap);
  scene_clear(&scene);
}

Test(census, counts_contacts_of_free_discs_alone)
{
  struct scene scene = scene_box(100, 60, 0.05, SIDES_CLOSED);
  scene_add_disc(&scene, 8, 1, 50, 30)->motion = DISC_FIXED;
  scene_add_disc(&scene, 8, 1, 60, 30)->motion = DISC_DRIVEN;
  scene_add_disc(&scene, 8, 1, 20, 3)->motion = DISC_FIXED;
  cr_expect_eq(census_of(&scene).contacts, 0, "no free disc");
  scene_add_disc(&scene, 4, 1, 50, 41);
  const struct contact_census census = census_of(&scene);
  cr_expect(census.contacts == 1 && census.max_overlap == 0.25, "%zu, %g", census.contacts, census.max_overlap);
  scene_clear(&scene);
}

/* The same by all pairs. */
static struct contact_census slow_census(const struct scene *scene)
{
  struct contact_census census = {0};
  const struct disc_spec *discs = scene->particles.discs;
  const double size[2] = {scene->domain.size[0], scene->domain.size[1]};
  for (size_t a = 0; a < scene->particles.count; a++) {
    double depth[SIDE_COUNT + 1];
    for (size_t b = a + 1; b < scene->particles.count; b++) {
      double d[2];
      for (int axis = 0; axis < 2; axis++) {
        d[axis] = discs[b].position[axis] - discs[a].position[axis];
        if (scene_is_periodic(scene, axis)) d[axis] -= size[axis] * round(d[axis] / size[axis]);
      }
      depth[0] = discs[a].radius + discs[b].radius - hypot(d[0], d[1]);
      census.contacts += depth[0] > 0;
      census.max_overlap = fmax(census.max_overlap, depth[0] / fmin(discs[a].radius, discs[b].radius));
    }
    for (enum side_name side = 0; side < SIDE_COUNT; side++) {
      depth[side] = discs[a].radius - scene_distance_to_side(scene, side, discs[a].position);
      if (scene->domain.side[side].type == SIDE_PERIODIC) continue;
      census.contacts += depth[side] > 0;
      census.max_overlap = fmax(census.max_overlap, depth[side] / discs[a].radius);
    }
  }
  return census;
}

Test(census, of_random_discs_agrees_with_a_test_of_all_pairs)
{
  gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
  size_t contacts = 0;
  for (int box = 0; box < 60; box++) {
    const int nx = 20 + (int)gsl_rng_uniform_int(random, 100), ny = 20 + (int)gsl_rng_uniform_int(random, 100);
    struct scene scene = scene_box(nx, ny, 0.05, SIDES_CLOSED);
    for (int axis = 0; axis < 2; axis++)
      if (box >> axis & 1) scene.domain.side[2 * axis].type = scene.domain.side[2 * axis + 1].type = SIDE_PERIODIC;
    for (int k = 0; k < 40; k++)
      scene_add_disc(&scene, 1 + 6 * gsl_rng_uniform(random), 1, nx * gsl_rng_uniform(random),
                     ny * gsl_rng_uniform(random));
    const struct contact_census fast = census_of(&scene), slow = slow_census(&scene);
    cr_expect_eq(fast.contacts, slow.contacts, "%d x %d, sides %d: %zu, %zu", nx, ny, box & 3, fast.contacts,
                 slow.contacts);
    cr_expect_float_eq(fast.max_overlap, slow.max_overlap, 1e-12);
    contacts += slow.contacts;
    scene_clear(&scene);
  }
  cr_expect_gt(contacts, 1000);
  gsl_rng_free(random);
}

/* Two discs that approach each other at 0.1 cells a step. */
static struct scene impact(double stiffness, double distance)
{
  struct scene scene = scene_box(80, 50, 0.05, SIDES_PERIODIC);
  scene_add_disc(&scene, 8, 3, 40 - distance / 2, 25)->velocity[0] = 0.05;
  scene_add_disc(&scene, 6, 3, 40 + distance / 2, 25)->velocity[0] = -0.05;
  scene.contact.stiffness = stiffness;
  return scene;
}

static double max_overlap_of(struct simulation *simulation)
{
  struct simulation_report report;
  simulation_report(simulation, &report);
  return report.max_overlap;
}

Test(max_overlap, of_a_run_is_the_largest_of_all_steps)
{
  const double stiffnesses[] = {0.05, 50};
  for (int k = 0; k < 2; k++) {
    struct scene scene = impact(stiffnesses[k], 14.5);
    struct simulation *simulation = start(&scene);
    double largest = 0;
    cr_expect_eq(max_overlap_of(simulation), 0);
    for (int step = 0; step < 150; step++) {
      advance(simulation, 1);
      largest = fmax(largest, instant_of(simulation).max_overlap);
      cr_expect_geq(max_overlap_of(simulation), largest);
    }
    const double obtained = max_overlap_of(simulation);
    cr_expect_lt(instant_of(simulation).max_overlap, largest, "the largest was earlier");
    if (k == 0) cr_expect_eq(obtained, largest, "one sub-step a step");
    if (k == 1) cr_expect(obtained < 0.025, "%g", obtained); /* half of that without damping, 0.051 */
    simulation_destroy(simulation);
    scene_clear(&scene);
  }
}

Test(max_overlap, counts_that_of_discs_as_they_are_placed)
{
  struct scene scene = impact(0.25, 13.4);
  struct simulation *simulation = start(&scene);
  expect_close("at step 0", max_overlap_of(simulation), 0.1, 1e-14);
  scene.particles.discs[0].velocity[0] = scene.particles.discs[1].velocity[0] = 0;
  simulation_destroy(simulation);
  simulation = start(&scene);
  advance(simulation, 200);
  cr_expect_lt(instant_of(simulation).max_overlap, 0.05);
  expect_close("after they have parted", max_overlap_of(simulation), 0.1, 1e-14);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* From here on from outside, or with files. */
TestSuite(series, .init = shell_enter, .fini = shell_leave, .timeout = 60 * SLOWNESS);

/* Discs that collide; two of them overlap at the start, by 4 cells. */
static const char *const crowd = "domain: {size: [150, 120], left: periodic, right: periodic}\n"
                                 "fluid: {viscosity: 0.03}\n"
                                 "particles:\n"
                                 "  density: 1.3\n"
                                 "  gravity: [1e-5, -1e-3]\n"
                                 "  discs: [{radius: 5, position: [40, 110]}, {radius: 6, position: [47, 110]}]\n"
                                 "  fill: {pattern: jittered-grid, spacing: 12, radius: 5.7, jitter: 0.3, seed: 5, "
                                 "region: [0, 0, 150, 96]}\n"
                                 "run: {steps: 125}\n"
                                 "output: {every: 10, series: {every: 10}}\n";

Test(series, has_a_row_at_the_steps_of_particles_csv_under_the_header_that_scripts_rely_on)
{
  shell_write("crowd.yaml", crowd);
  cr_assert_eq(shell("$DELBM run crowd.yaml --quiet --out o >line"), 0);
  cr_expect_eq(shell("test \"$(head -n 1 o/series.csv)\" = "
                     "step,kinetic_fluid,kinetic_discs,mean_ux,mean_uy,excess_mass,max_mach,contacts,max_overlap"),
               0);
  cr_expect_eq(
      shell("cut -d, -f1 o/particles.csv | uniq >a; cut -d, -f1 o/series.csv | cmp - a && test $(wc -l <a) = 15"), 0);
  cr_expect_eq(shell("awk -F, 'NR > 1 && ($2 < 0 || $8 != int($8) || NF != 9) {bad = 1} NR > 1 && $8 > 0 {touch = 1} "
                     "END {exit bad || !touch}' o/series.csv"),
               0, "discs touch");
  cr_expect_eq(shell("for name in mean_ux mean_uy; do n=$((n + 1)); "
                     "test $(tail -n 1 o/series.csv | cut -d, -f$((3 + n))) = "
                     "$(sed -n \"s/^  \\\"$name\\\": \\(.*\\),/\\1/p\" o/run.json) || exit 1; done"),
               0);
  cr_expect_eq(shell("m=$(sed -n 's/^  \"max_overlap\": \\(.*\\),/\\1/p' o/run.json) && "
                     "awk -F, -v m=$m 'NR > 1 && $9 > m {bad = 1} END {exit bad || !(m > 0)}' o/series.csv && "
                     "grep -q ' max_overlap=0\\.' line"),
               0);
}

Test(series, is_absent_unless_asked_for_and_removed_with_an_earlier_run)
{
  shell_write("crowd.yaml", crowd);
  cr_assert_eq(shell("$DELBM run crowd.yaml --quiet --out o --set run.steps=1 >line && test -e o/series.csv"), 0);
  cr_assert_eq(shell("$DELBM run crowd.yaml --quiet --out o --set run.steps=1 --set output.series.every=0 >line"), 0);
  cr_expect_eq(shell("test -e o/particles.csv && ! test -e o/series.csv"), 0);
}

Test(series, has_the_same_bytes_on_any_number_of_threads)
{
  shell_write("crowd.yaml", crowd);
  cr_assert_eq(
      shell("for n in 1 2 4; do OMP_NUM_THREADS=$n $DELBM run crowd.yaml --quiet --out o$n >line || exit 1; done; "
            "grep -q '\"threads\": 4' o4/run.json"),
      0);
  cr_expect_eq(shell("cmp o1/series.csv o2/series.csv && cmp o1/series.csv o4/series.csv"), 0);
  cr_expect_eq(shell("for n in 1 2 4; do grep max_overlap o$n/run.json; done | uniq | wc -l | grep -qx 1"), 0);
}

Test(series, of_a_resumed_run_equals_that_of_an_unbroken_one)
{
  shell_write("crowd.yaml", crowd);
  const char *const go = "$DELBM run crowd.yaml --quiet --set output.checkpoint.every=47 --out";
  cr_assert_eq(shell("%s whole >line && cp -r whole cut && rm cut/checkpoint.0 && echo 999,rubbish >>cut/series.csv && "
                     "$DELBM resume cut --quiet >line",
                     go),
               0);
  cr_expect_eq(shell("cmp whole/series.csv cut/series.csv"), 0);
  cr_expect_eq(shell("test \"$(grep max_overlap whole/run.json)\" = \"$(grep max_overlap cut/run.json)\""), 0);
  cr_expect_eq(shell("rm cut/series.csv; $DELBM resume cut --quiet --steps 200 >line 2>err"), 4, "the file is missing");
}

Test(series, has_no_row_of_a_flow_that_has_diverged)
{
  shell_write("fast.yaml",
              "domain: {size: [32, 32], left: periodic, right: periodic, bottom: periodic, top: periodic}\n"
              "fluid: {viscosity: 0.05, force: [0.09, 0]}\n"
              "run: {steps: 50}\n"
              "output: {series: {every: 1}}\n");
  cr_expect_eq(shell("$DELBM run fast.yaml --quiet --out o >line 2>err"), 1);
  cr_expect_eq(shell("awk -F, 'NR > 1 && $7 > 0.6 {bad = 1} END {exit bad || NR <= 3}' o/series.csv"), 0);
}

Test(series, columns_with_a_dimension_have_one_in_si)
{
  const struct units units = {2, 0.5, 3};
  const struct instant instant = {10, 11, {12, 13}, 14, 15, 16, 17};
  struct table *table;
  struct status status;
  cr_assert(table_open(&table, "series.csv", &series_layout, &units, &status), "%s", status.message);
  cr_assert(series_write(table, 7, &instant, &status) && table_close(&table, &status));
  shell_write("expected", ",t[s],kinetic_fluid[kg*m/s^2],kinetic_discs[kg*m/s^2],mean_ux[m/s],mean_uy[m/s],"
                          "excess_mass[kg/m]\n7,10,11,12,13,14,15,16,17,3.5,1920,2112,48,52,168\n");
  cr_expect_eq(shell("sed 's/^step.*,max_overlap//' series.csv | cmp - expected"), 0);
}

Test(series, a_number_that_is_not_finite_is_refused)
{
  const struct instant instant = {.kinetic_discs = NAN};
  struct table *table;
  struct status status;
  cr_assert(table_open(&table, "series.csv", &series_layout, &(struct units){0}, &status), "%s", status.message);
  cr_expect_not(series_write(table, 7, &instant, &status));
  cr_expect_eq(status.code, DELBM_FAILED);
  cr_expect_str_eq(status.message, "step 7: kinetic_discs is nan");
  cr_expect(table_close(&table, &status));
  cr_expect_eq(shell("test $(wc -l <series.csv) = 1"), 0);
}
