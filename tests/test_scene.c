#include "case/case_errors.h"
#include "case/case_file.h"
#include "case/case_keys.h"
#include "case/case_reference.h"
#include "case/case_value.h"
#include "case/case_write.h"
#include "model/scene.h"

#include <criterion/criterion.h>
#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char minimal[] = "domain: {size: [100, 200]}\nfluid: {viscosity: 0.05}\nrun: {steps: 10}\n";

/* A case read from text in a temporary file. */
struct reading {
  struct scene scene;
  struct case_errors errors;
  struct status status;
  bool valid;
};

static struct reading read_sized(const char *text, size_t size, char *const set[], size_t set_count)
{
  struct reading reading = {0};
  char path[] = "/tmp/delbm-scene-XXXXXX";
  int descriptor = mkstemp(path);
  cr_assert_geq(descriptor, 0);
  FILE *file = fdopen(descriptor, "w");
  cr_assert_eq(fwrite(text, 1, size, file), size);
  cr_assert_eq(fclose(file), 0);
  reading.valid = case_read(&reading.scene, path, set, set_count, &reading.errors, &reading.status);
  unlink(path);
  return reading;
}

static struct reading read_text(const char *text)
{
  return read_sized(text, strlen(text), NULL, 0);
}

static struct reading read_with(const char *text, char *set)
{
  return read_sized(text, strlen(text), &set, 1);
}

/* The minimal case with one valid override. */
static struct scene scene_with(char *set)
{
  struct reading reading = read_with(minimal, set);
  if (!reading.valid) case_errors_print(&reading.errors, stderr);
  cr_assert(reading.valid, "%s: %s", set, reading.status.message);
  return reading.scene;
}

static void release(struct reading *reading)
{
  scene_clear(&reading->scene);
  case_errors_clear(&reading->errors);
}

static char *written(const struct scene *scene)
{
  char *text = NULL;
  size_t size;
  FILE *file = open_memstream(&text, &size);
  cr_assert(case_write(scene, file));
  cr_assert_eq(fclose(file), 0);
  return text;
}

static bool same_pair(const double *a, const double *b)
{
  return memcmp(a, b, 2 * sizeof *a) == 0;
}

static bool same_disc(const struct disc_spec *a, const struct disc_spec *b)
{
  return a->radius == b->radius && a->density == b->density && same_pair(a->position, b->position) &&
         same_pair(a->velocity, b->velocity) && a->angle == b->angle && a->spin == b->spin && a->motion == b->motion;
}

static void expect_same_discs(const struct scene *a, const struct scene *b)
{
  cr_assert_eq(a->particles.count, b->particles.count);
  cr_expect_eq(a->particles.listed, b->particles.listed);
  for (size_t i = 0; i < a->particles.count; i++)
    cr_expect(same_disc(&a->particles.discs[i], &b->particles.discs[i]), "disc %zu", i);
}

static void expect_same_fill(const struct fill_spec *a, const struct fill_spec *b)
{
  cr_assert_eq(a->present, b->present);
  if (!a->present) return;
  cr_expect_eq(a->spacing, b->spacing);
  cr_expect_eq(a->radius, b->radius);
  cr_expect_eq(a->density, b->density);
  cr_expect_eq(a->jitter, b->jitter);
  cr_expect(same_pair(a->region, b->region) && same_pair(a->region + 2, b->region + 2));
  cr_expect_eq(a->seed, b->seed);
}

static void expect_same_fluid(const struct scene *a, const struct scene *b)
{
  cr_expect_eq(a->fluid.viscosity, b->fluid.viscosity);
  cr_expect(same_pair(a->fluid.force, b->fluid.force));
  cr_expect_eq(a->fluid.collision, b->fluid.collision);
  cr_expect_eq(a->fluid.rates.s_nu, b->fluid.rates.s_nu);
  cr_expect_eq(a->fluid.rates.s_e, b->fluid.rates.s_e);
  cr_expect_eq(a->fluid.rates.s_q, b->fluid.rates.s_q, "rates.s_q: %.17g and %.17g", a->fluid.rates.s_q,
               b->fluid.rates.s_q);
  cr_expect_eq(a->fluid.precision, b->fluid.precision);
  cr_expect_eq(a->fluid.zero_flux, b->fluid.zero_flux);
  cr_expect_eq(!a->fluid.kernel, !b->fluid.kernel);
  if (a->fluid.kernel && b->fluid.kernel) cr_expect_str_eq(a->fluid.kernel, b->fluid.kernel);
}

static void expect_same_scene(const struct scene *a, const struct scene *b)
{
  cr_expect_str_eq(a->title, b->title);
  cr_expect_eq(memcmp(a->domain.size, b->domain.size, sizeof a->domain.size), 0);
  for (int s = 0; s < SIDE_COUNT; s++) {
    cr_expect_eq(a->domain.side[s].type, b->domain.side[s].type);
    cr_expect(same_pair(a->domain.side[s].velocity, b->domain.side[s].velocity));
  }
  expect_same_fluid(a, b);
  cr_expect_eq(memcmp(&a->coupling, &b->coupling, sizeof a->coupling), 0);
  cr_expect(same_pair(a->particles.gravity, b->particles.gravity));
  expect_same_fill(&a->particles.fill, &b->particles.fill);
  expect_same_discs(a, b);
  cr_expect_eq(a->contact.area, b->contact.area);
  cr_expect_eq(a->contact.law, b->contact.law);
  cr_expect_eq(a->contact.search, b->contact.search);
  cr_expect_eq(a->contact.stiffness, b->contact.stiffness);
  cr_expect_eq(a->contact.alpha, b->contact.alpha);
  cr_expect_eq(a->contact.damping, b->contact.damping);
  cr_expect_eq(a->contact.damping_form, b->contact.damping_form);
  cr_expect_eq(a->contact.substeps, b->contact.substeps);
  cr_expect_eq(a->contact.steps_per_contact, b->contact.steps_per_contact);
  cr_expect_eq(a->run.steps, b->run.steps);
  cr_expect_eq(a->run.check, b->run.check);
  cr_expect_eq(a->output.every, b->output.every);
  cr_expect_eq(a->output.series.every, b->output.series.every);
  cr_expect_eq(a->output.frames.every, b->output.frames.every);
  cr_expect_eq(a->output.frames.quantity, b->output.frames.quantity);
  cr_expect_eq(a->output.frames.maximum, b->output.frames.maximum);
}

/* Expects that a scene written and read is the same scene and the same text. */
static void expect_round_trip(const struct scene *scene)
{
  char *text = written(scene);
  struct reading again = read_text(text);
  if (!again.valid) case_errors_print(&again.errors, stderr);
  cr_assert(again.valid, "%s", text);
  expect_same_scene(scene, &again.scene);
  char *second = written(&again.scene);
  cr_expect_str_eq(text, second);
  free(text);
  free(second);
  release(&again);
}

static void expect_round_trip_of(const char *text)
{
  struct reading reading = read_text(text);
  if (!reading.valid) case_errors_print(&reading.errors, stderr);
  cr_assert(reading.valid, "%s", text);
  expect_round_trip(&reading.scene);
  release(&reading);
}

static const char full[] = "title: \"All keys: \\\"one\\\" # two\\n\\u00fc\\u2028\\x07\"\n"
                           "domain:\n"
                           "  size: [120, 3e2]\n"
                           "  left: periodic\n"
                           "  right: {type: periodic}\n"
                           "  bottom: {type: inlet, velocity: [0.01, 0.1]}\n"
                           "  top: outlet\n"
                           "fluid:\n"
                           "  viscosity: 0.1\n"
                           "  force: [1e-5, -0.0]\n"
                           "  collision: mrt\n"
                           "  rates: {e: 1.1, q: 0.7}\n"
                           "  precision: double\n"
                           "  zero_flux: false\n"
                           "  kernel: reference\n"
                           "coupling: {form: unified, solve: explicit-averaged, hydraulic_radius: 0.75}\n"
                           "particles:\n"
                           "  density: 1.01\n"
                           "  gravity: [0, -0.0245]\n"
                           "  discs:\n"
                           "    - {radius: 10, position: [100.1, 200], velocity: [0, -0.05], angle: 1, spin: 0.01}\n"
                           "    - {radius: 5, density: 2, position: [30, 0.1], fixed: true, spin: -0.02}\n"
                           "    - {radius: 7.5, position: [60, 250], driven: true, velocity: [0.01, 0]}\n"
                           "  fill: {pattern: jittered-grid, spacing: 20, radius: 5, density: 3, jitter: 1.5,\n"
                           "         region: [0, 0, 100, 50.5], seed: 4294967295}\n"
                           "contact:\n"
                           "  area: lens\n"
                           "  search: linked-cell\n"
                           "  stiffness: 0.5\n"
                           "  alpha: 0.25\n"
                           "  damping: 0\n"
                           "  damping_form: printed\n"
                           "  substeps: 4\n"
                           "  steps_per_contact: 30\n"
                           "run: {steps: 1e6, check: 7}\n"
                           "output: {every: 0, series: {every: 7},\n"
                           "         frames: {every: 50, quantity: vorticity, maximum: 0.125}}\n";

Test(scene, full_case_sets_domain_and_fluid)
{
  struct reading reading = read_text(full);
  const struct scene *scene = &reading.scene;
  case_errors_print(&reading.errors, stderr);
  cr_assert(reading.valid);
  cr_expect_str_eq(scene->title, "All keys: \"one\" # two\n\u00fc\u2028\a");
  cr_expect_eq(scene->domain.size[0], 120);
  cr_expect_eq(scene->domain.size[1], 300);
  cr_expect(scene_is_periodic(scene, 0) && !scene_is_periodic(scene, 1));
  cr_expect_eq(scene->domain.side[SIDE_BOTTOM].type, SIDE_INLET);
  cr_expect_eq(scene->domain.side[SIDE_BOTTOM].velocity[1], 0.1);
  cr_expect_eq(scene->domain.side[SIDE_TOP].type, SIDE_OUTLET);
  cr_expect_eq(scene->fluid.force[0], 1e-5);
  cr_expect(fabs(scene->fluid.rates.s_nu - 1.25) < 1e-15);
  cr_expect_eq(scene->fluid.rates.s_e, 1.1);
  cr_expect_eq(scene->fluid.rates.s_q, 0.7);
  cr_expect_not(scene->fluid.zero_flux);
  cr_expect_str_eq(scene->fluid.kernel, "reference");
  cr_expect_eq(scene->coupling.form, FORM_UNIFIED);
  cr_expect_eq(scene->coupling.solve, SOLVE_EXPLICIT_AVERAGED);
  cr_expect_eq(scene->coupling.hydraulic_radius, 0.75);
  release(&reading);
}

Test(scene, full_case_sets_particles)
{
  struct reading reading = read_text(full);
  const struct scene *scene = &reading.scene;
  cr_assert(reading.valid);
  cr_expect_eq(scene->particles.gravity[1], -0.0245);
  cr_assert_eq(scene->particles.listed, 3);
  cr_assert_eq(scene->particles.count, 3 + 5 * 2);
  const struct disc_spec *discs = scene->particles.discs;
  cr_expect(discs[0].motion == DISC_FREE && discs[1].motion == DISC_FIXED && discs[2].motion == DISC_DRIVEN);
  cr_expect(discs[0].density == 1.01 && discs[1].density == 2 && discs[2].density == 1.01);
  cr_expect(discs[0].angle == 1 && discs[0].spin == 0.01 && discs[0].velocity[1] == -0.05);
  cr_expect(discs[3].density == 3 && discs[3].radius == 5 && discs[3].motion == DISC_FREE);
  cr_expect_eq(scene->particles.fill.seed, 4294967295u);
  release(&reading);
}

Test(scene, full_case_sets_contact_run_and_output)
{
  struct reading reading = read_text(full);
  const struct scene *scene = &reading.scene;
  cr_assert(reading.valid);
  cr_expect(scene->contact.area == AREA_LENS && scene->contact.search == SEARCH_LINKED_CELL);
  cr_expect(scene->contact.stiffness == 0.5 && scene->contact.alpha == 0.25 && scene->contact.damping == 0);
  cr_expect(scene->contact.damping_form == DAMPING_PRINTED && scene->contact.substeps == 4);
  cr_expect_eq(scene->contact.steps_per_contact, 30);
  cr_expect(scene->run.steps == 1000000 && scene->run.check == 7);
  cr_expect(scene->output.every == 0 && scene->output.series.every == 7 && scene->output.frames.every == 50);
  cr_expect(scene->output.frames.quantity == FRAME_VORTICITY && scene->output.frames.maximum == 0.125);
  release(&reading);
}

Test(scene, minimal_case_has_documented_defaults)
{
  struct reading reading = read_text(minimal);
  const struct scene *scene = &reading.scene;
  cr_assert(reading.valid);
  cr_expect_str_eq(scene->title, "");
  for (int s = 0; s < SIDE_COUNT; s++) cr_expect_eq(scene->domain.side[s].type, SIDE_WALL);
  cr_expect(scene->fluid.collision == COLLISION_ADAPTIVE && scene->fluid.precision == PRECISION_DOUBLE);
  cr_expect(scene->fluid.rates.s_e == 1.4 &&
            scene->fluid.rates.s_q == rate_from_magic(1.0 / 12, scene->fluid.viscosity));
  cr_expect(!scene->fluid.zero_flux && !scene->fluid.kernel);
  cr_expect(scene->coupling.form == FORM_MIDPOINT && scene->coupling.solve == SOLVE_IMPLICIT);
  cr_expect_eq(scene->coupling.hydraulic_radius, 1);
  cr_expect(scene->particles.count == 0 && !scene->particles.fill.present);
  cr_expect(scene->contact.area == AREA_LENS && scene->contact.search == SEARCH_GRID);
  cr_expect(scene->contact.stiffness == 0.25 && scene->contact.alpha == 0.3 && scene->contact.damping == 0.34);
  cr_expect(scene->contact.damping_form == DAMPING_CRITICAL && scene->contact.substeps == 0);
  cr_expect_eq(scene->contact.steps_per_contact, 20);
  cr_expect_eq(scene->run.check, 50);
  cr_expect(scene->output.every == 100 && scene->output.frames.every == 0 && scene->output.frames.maximum == 0);
  cr_expect_eq(scene->output.series.every, 0);
  cr_expect_eq(scene->output.frames.quantity, FRAME_SPEED);
  release(&reading);
}

Test(scene, written_case_reads_back_the_same)
{
  static const char *const sides[] = {
      "domain: {size: [9, 9], top: {velocity: [-0.1, 0]}}\nfluid: {viscosity: 1e-3}\nrun: {steps: 0}\n",
      "domain: {size: [9, 9], top: periodic, bottom: periodic}\nfluid: {viscosity: 10, collision: bgk}\nrun: {steps: "
      "1}\n",
      "title: >-\n  folded\n  title\n"
      "domain: {size: [9, 9]}\nfluid: {viscosity: 0.1, magic: 0.2}\nrun: {steps: 1}\n",
  };
  expect_round_trip_of(full);
  expect_round_trip_of(minimal);
  for (size_t i = 0; i < sizeof sides / sizeof sides[0]; i++) expect_round_trip_of(sides[i]);
}

Test(scene, written_case_with_a_magic_parameter_reads_back_the_same_rates)
{
  static const double viscosities[] = {1e-6, 0.005, 0.05, 1.0 / 6, 0.1234567890123456, 10};
  static const double magics[] = {1e-8, 0.0101, 1.0 / 12, 0.1875, 1.0 / 3, 0.98765432109876543, 10};
  for (size_t i = 0; i < sizeof viscosities / sizeof *viscosities; i++) {
    for (size_t j = 0; j < sizeof magics / sizeof *magics; j++) {
      char text[256];
      snprintf(text, sizeof text,
               "domain: {size: [9, 9]}\nfluid: {viscosity: %.17g, collision: %s, magic: %.17g}\nrun: {steps: 1}\n",
               viscosities[i], magics[j] < 0.5 ? "trt" : "adaptive", magics[j]);
      expect_round_trip_of(text);
    }
  }
}

Test(scene, written_case_is_marked_with_the_version_and_keeps_short_numbers)
{
  struct scene scene = scene_with("fluid={viscosity: 0.1, collision: trt, magic: 0.1875}");
  char *text = written(&scene);
  cr_expect_eq(
      strncmp(text, "# written by delbm " DELBM_VERSION "\n", strlen("# written by delbm " DELBM_VERSION "\n")), 0);
  cr_expect(strstr(text, "  viscosity: 0.1\n"));
  cr_expect(strstr(text, "  magic: 0.1875\n"), "%s", text);
  cr_expect_not(strstr(text, "rates"));
  free(text);
  scene_clear(&scene);
}

Test(scene, rates_follow_the_collision)
{
  struct scene bgk = scene_with("fluid={viscosity: 0.1, collision: bgk}");
  cr_expect(bgk.fluid.rates.s_e == bgk.fluid.rates.s_nu && bgk.fluid.rates.s_q == bgk.fluid.rates.s_nu);
  struct scene trt = scene_with("fluid={viscosity: 0.1, collision: trt}");
  cr_expect(trt.fluid.rates.s_e == trt.fluid.rates.s_nu && trt.fluid.rates.s_q == rate_from_magic(0.1875, 0.1));
  struct scene nested = scene_with("fluid={viscosity: 0.1, collision: trt, rates: {magic: 0.25}}");
  cr_expect_eq(nested.fluid.rates.s_q, rate_from_magic(0.25, 0.1));
  struct scene mrt = scene_with("fluid={viscosity: 0.1, collision: mrt, magic: 0.25, rates: {e: 1.3}}");
  cr_expect(mrt.fluid.rates.s_e == 1.3 && mrt.fluid.rates.s_q == rate_from_magic(0.25, 0.1));
  struct scene adaptive = scene_with("fluid={viscosity: 0.01, rates: {e: 1.3}}");
  cr_expect(adaptive.fluid.rates.s_q == rate_from_magic(1.0 / 12, 0.01) && adaptive.fluid.rates.s_q_fast == 1.2);
  cr_expect(adaptive.fluid.collision == COLLISION_ADAPTIVE && adaptive.fluid.rates.s_e == 1.3);
  struct scene thick = scene_with("fluid={viscosity: 0.2}"); /* slow fluid relaxes q faster than fast fluid would */
  cr_expect(thick.fluid.rates.s_q == rate_from_magic(1.0 / 12, 0.2) && thick.fluid.rates.s_q_fast == 0);
  struct scene given = scene_with("fluid={viscosity: 0.01, rates: {q: 1.1}}");
  cr_expect(given.fluid.collision == COLLISION_MRT && given.fluid.rates.s_q == 1.1 && given.fluid.rates.s_q_fast == 0);
  scene_clear(&adaptive);
  scene_clear(&thick);
  scene_clear(&given);
  scene_clear(&bgk);
  scene_clear(&trt);
  scene_clear(&nested);
  scene_clear(&mrt);
}

Test(scene, slip_sides_close_an_axis_as_walls_do)
{
  struct scene scene =
      scene_with("particles={gravity: [0, -0.01], discs: [{radius: 5, position: [50, 50], density: 2}]}");
  for (int axis = 0; axis < 2; axis++) {
    scene.domain.side[2 * axis].type = SIDE_SLIP;
    cr_expect(scene_is_closed(&scene, axis) && scene_sticking_sides(&scene, axis) == 1);
    scene.domain.side[2 * axis + 1].type = SIDE_SLIP;
    cr_expect(scene_is_closed(&scene, axis) && scene_sticking_sides(&scene, axis) == 0);
  }
  scene_clear(&scene);
}

Test(scene, zero_flux_is_on_where_walls_close_an_axis_and_gravity_acts_on_free_discs)
{
  static const struct {
    char *particles;
    bool zero_flux;
  } cases[] = {
      {"particles={gravity: [0, -0.01], discs: [{radius: 5, position: [50, 50], density: 2}]}", true},
      {"particles={gravity: [0, -0.01], fill: {radius: 5, spacing: 20, density: 2}}", true},
      {"particles={gravity: [0, -0.01], discs: [{radius: 5, position: [50, 50], fixed: true}]}", false},
      {"particles={gravity: [0, 0], discs: [{radius: 5, position: [50, 50], density: 2}]}", false},
      {"particles={gravity: [0, -0.01]}", false},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    struct scene scene = scene_with(cases[i].particles);
    cr_expect_eq(scene.fluid.zero_flux, cases[i].zero_flux, "%s", cases[i].particles);
    scene_clear(&scene);
  }
}

Test(scene, fixed_and_driven_discs_need_no_density)
{
  struct scene scene = scene_with("particles.discs=[{radius: 5, position: [50, 50], fixed: true},"
                                  "{radius: 5, position: [20, 50], driven: true}]");
  cr_expect(scene.particles.discs[0].density == 1 && scene.particles.discs[1].density == 1);
  scene_clear(&scene);
}

Test(scene, override_replaces_any_value)
{
  struct scene scene = scene_with("domain.size=[512, 1e3]");
  cr_expect(scene.domain.size[0] == 512 && scene.domain.size[1] == 1000);
  scene_clear(&scene);
  scene = scene_with("domain.top={type: wall, velocity: [0.1, 0]}");
  cr_expect_eq(scene.domain.side[SIDE_TOP].velocity[0], 0.1);
  scene_clear(&scene);
  scene = scene_with("output.frames.every=200");
  cr_expect_eq(scene.output.frames.every, 200);
  scene_clear(&scene);
  scene = scene_with("title=a title = with signs");
  cr_expect_str_eq(scene.title, "a title = with signs");
  scene_clear(&scene);
}

Test(scene, later_override_wins_and_reaches_into_sides_and_discs)
{
  char *set[] = {"domain.top=outlet",
                 "domain.top=wall",
                 "domain.top.velocity=[0.2, 0]",
                 "particles.discs=[{radius: 5, position: [50, 50], density: 2}]",
                 "particles.discs.0.radius=6",
                 "particles.discs.0.density=3"};
  struct reading reading = read_sized(minimal, strlen(minimal), set, sizeof set / sizeof set[0]);
  case_errors_print(&reading.errors, stderr);
  cr_assert(reading.valid);
  cr_expect_eq(reading.scene.domain.side[SIDE_TOP].velocity[0], 0.2);
  cr_expect_eq(reading.scene.particles.discs[0].radius, 6);
  cr_expect_eq(reading.scene.particles.discs[0].density, 3);
  release(&reading);
}

Test(scene, override_does_not_change_other_uses_of_an_alias)
{
  static const char text[] = "domain: {size: [100, 200]}\nfluid: {viscosity: &nu 0.05}\nrun: {steps: 10}\n"
                             "particles:\n  discs:\n    - &disc {radius: 5, position: &at [50, 50], density: 2}\n";
  struct reading reading = read_with(text, "contact={stiffness: 3}");
  cr_assert(reading.valid);
  cr_expect_eq(reading.scene.contact.stiffness, 3);
  release(&reading);
  static const char shared[] =
      "domain: {size: [100, 200], left: &side {type: wall, velocity: [0, 0.1]}, right: *side}\n"
      "fluid: {viscosity: 0.05}\nrun: {steps: 10}\n";
  reading = read_with(shared, "domain.left.velocity=[0, 0.2]");
  cr_assert(reading.valid);
  cr_expect_eq(reading.scene.domain.side[SIDE_LEFT].velocity[1], 0.2);
  cr_expect_eq(reading.scene.domain.side[SIDE_RIGHT].velocity[1], 0.1);
  release(&reading);
}

Test(scene, lubrication_as_a_number_is_its_cut_off)
{
  struct reading reading = read_with(minimal, "contact.lubrication=1.5");
  cr_assert(reading.valid);
  cr_expect_eq(reading.scene.contact.lubrication.cutoff, 1.5);
  cr_expect_eq(reading.scene.contact.lubrication.least_gap, 0.01);
  release(&reading);
  reading = read_with(minimal, "contact.lubrication={least_gap: 0.1}");
  cr_assert(reading.valid);
  cr_expect_eq(reading.scene.contact.lubrication.cutoff, 0);
  cr_expect_eq(reading.scene.contact.lubrication.least_gap, 0.1);
  release(&reading);
}

Test(scene, override_that_is_wrong_is_named)
{
  static const struct {
    char *set;
    const char *error;
  } cases[] = {
      {"fluid.viscosty=1", "--set fluid.viscosty=1: unknown key fluid.viscosty; did you mean fluid.viscosity?"},
      {"flud.viscosity=1", "--set flud.viscosity=1: unknown key flud; did you mean fluid?"},
      {"viscosity=1", "--set viscosity=1: unknown key viscosity; did you mean fluid.viscosity?"},
      {"run.stpes=1", "--set run.stpes=1: unknown key run.stpes; did you mean run.steps?"},
      {"run.duration=1", "--set run.duration=1: unknown key run.duration; expected one of steps, check, plan"},
      {"output.frames_every=1",
       "--set output.frames_every=1: unknown key output.frames_every; did you mean output.frames.every?"},
      {"fluid.nu=1",
       "--set fluid.nu=1: unknown key fluid.nu; expected one of none, viscosity, force, collision, rates, magic, "
       "precision, zero_flux, kernel"},
      {"gravity=[0, 1]", "--set gravity=[0, 1]: unknown key gravity; did you mean particles.gravity?"},
      {"contact.cohesion=1",
       "--set contact.cohesion=1: unknown key contact.cohesion; expected one of law, area, search, edge, "
       "stiffness, overlap, alpha, damping, restitution, friction, tangential_ratio, rolling_friction, lubrication, "
       "damping_form, substeps, "
       "steps_per_contact"},
      {"fluid.viscosity=thick",
       "--set fluid.viscosity=thick: fluid.viscosity: got thick; expected a number > 0 and <= 10"},
      {"domain.left=wal",
       "--set domain.left=wal: domain.left.type: got wal; expected wall, periodic, inlet, outlet or slip"},
      {"fluid", "--set fluid: expected dotted.key=value"},
      {"=3", "--set =3: expected dotted.key=value"},
      {"title=", "--set title=: expected dotted.key=value"},
      {"title=# nothing", "--set title=# nothing: empty; expected a YAML document"},
      {"fluid..viscosity=1", "--set fluid..viscosity=1: an empty name in the key; expected dotted.key=value"},
      {"fluid.=1", "--set fluid.=1: an empty name in the key; expected dotted.key=value"},
      {"fluid.viscosity.x=1", "--set fluid.viscosity.x=1: the key leads into a single value"},
      {"domain.size.2=1", "--set domain.size.2=1: no entry 2 in the list, which has 2, from 0"},
      {"domain.size.x=1", "--set domain.size.x=1: no entry x in the list, which has 2, from 0"},
      {"domain.size=[1,", "--set domain.size=[1,: not valid YAML: did not find expected node content, "
                          "while parsing a flow node"},
      {"contact={alpha: 1, alpha: 2}", "--set contact={alpha: 1, alpha: 2}: key alpha given twice"},
      {"title=a: b: c", "--set title=a: b: c: not valid YAML: mapping values are not allowed in this context"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    struct reading reading = read_with(minimal, cases[i].set);
    cr_expect_not(reading.valid, "%s", cases[i].set);
    cr_assert_geq(reading.errors.count, 1, "%s", cases[i].set);
    cr_expect_str_eq(reading.errors.lines[0], cases[i].error);
    release(&reading);
  }
}

Test(scene, errors_in_file_and_overrides_are_reported_together)
{
  char *set[] = {"run.stops=3", "nonsense"};
  struct reading reading = read_sized("fluid: {viscosity: -1}\n", 23, set, 2);
  cr_expect_not(reading.valid);
  cr_expect_eq(reading.status.code, DELBM_INVALID);
  cr_expect_eq(reading.errors.count, 5);
  cr_expect(strstr(reading.status.message, "5 errors in "), "%s", reading.status.message);
  release(&reading);
}

Test(scene, missing_file_is_an_input_error)
{
  struct scene scene;
  struct case_errors errors = {0};
  struct status status;
  cr_expect_not(case_read(&scene, "/nonexistent/case.yaml", NULL, 0, &errors, &status));
  cr_expect_eq(status.code, DELBM_IO);
  cr_expect_str_eq(status.message, "cannot open /nonexistent/case.yaml: No such file or directory");
  cr_expect_not(case_read(&scene, "/tmp", NULL, 0, &errors, &status));
  cr_expect_eq(status.code, DELBM_IO);
  cr_expect_str_eq(status.message, "cannot open /tmp/case.yaml: No such file or directory");
  cr_expect_eq(errors.count, 0);
}

static void make_file(const char *path)
{
  FILE *file = fopen(path, "w");
  cr_assert(file);
  fputs(minimal, file);
  fclose(file);
}

static void expect_name(const char *path, const char *name)
{
  struct scene scene;
  struct case_errors errors = {0};
  struct status status;
  cr_assert(case_read(&scene, path, NULL, 0, &errors, &status), "%s", path);
  cr_expect_str_eq(scene.name, name, "%s: %s", path, scene.name);
  scene_clear(&scene);
}

Test(scene, name_is_the_folders_or_the_files)
{
  char root[] = "/tmp/delbm-scene-XXXXXX";
  cr_assert(mkdtemp(root));
  cr_assert_eq(chdir(root), 0);
  cr_assert_eq(mkdir("sedimentation", 0755), 0);
  make_file("sedimentation/case.yaml");
  make_file("sedimentation/re.10.yaml");
  expect_name("sedimentation", "sedimentation");
  expect_name("sedimentation/", "sedimentation");
  expect_name("sedimentation/case.yaml", "sedimentation");
  expect_name("sedimentation/re.10.yaml", "re.10");
  cr_assert_eq(chdir("sedimentation"), 0);
  expect_name(".", "sedimentation");
  expect_name("case.yaml", "sedimentation");
  unlink("case.yaml");
  unlink("re.10.yaml");
  rmdir("../sedimentation");
  rmdir(root);
}

Test(scene, fill_starts_lower_left_and_goes_row_by_row)
{
  struct scene scene =
      scene_with("particles.fill={spacing: 20, radius: 5, density: 2, jitter: 0, region: [1, 2, 82, 61]}");
  cr_assert_eq(scene.particles.count, 4 * 2);
  for (size_t i = 0; i < 8; i++) {
    cr_expect_eq(scene.particles.discs[i].position[0], 11 + 20.0 * (double)(i % 4));
    cr_expect_eq(scene.particles.discs[i].position[1], 12 + 20.0 * (double)(i / 4));
  }
  scene_clear(&scene);
}

Test(scene, fill_covers_the_box_and_displaces_by_at_most_a_quarter_of_the_gap)
{
  struct scene scene = scene_with("particles.fill={spacing: 20, radius: 6, density: 2}");
  cr_assert_eq(scene.particles.count, 5 * 10);
  double largest = 0;
  for (size_t i = 0; i < scene.particles.count; i++) {
    double x = 10 + 20.0 * (double)(i % 5), y = 10 + 20.0 * (double)(i / 5);
    largest = fmax(largest, fabs(scene.particles.discs[i].position[0] - x));
    largest = fmax(largest, fabs(scene.particles.discs[i].position[1] - y));
  }
  cr_expect(largest > 1.8 && largest <= 2, "%g", largest);
  scene_clear(&scene);
}

Test(scene, fill_depends_on_its_seed_alone)
{
  struct scene one = scene_with("particles.fill={spacing: 20, radius: 5, density: 2, seed: 7}");
  struct scene same = scene_with("particles.fill={spacing: 20, radius: 5, density: 2, seed: 7}");
  struct scene other = scene_with("particles.fill={spacing: 20, radius: 5, density: 2, seed: 8}");
  expect_same_discs(&one, &same);
  cr_expect_neq(one.particles.discs[0].position[0], other.particles.discs[0].position[0]);
  scene_clear(&one);
  scene_clear(&same);
  scene_clear(&other);
}

Test(scene, whole_number_may_have_an_exponent)
{
  struct scene scene = scene_with("run.steps=12.50e2");
  cr_expect_eq(scene.run.steps, 1250);
  scene_clear(&scene);
  scene = scene_with("run.steps=2000e-3");
  cr_expect_eq(scene.run.steps, 2);
  scene_clear(&scene);
  struct reading reading = read_with(minimal, "run.steps=2001e-3");
  cr_expect_not(reading.valid);
  release(&reading);
}

Test(scene, flag_may_be_any_word_for_a_truth_value_that_yaml_knows)
{
  static const struct {
    const char *word;
    bool flag;
  } words[] = {{"true", true},   {"True", true},   {"TRUE", true},   {"yes", true},  {"Yes", true},  {"YES", true},
               {"on", true},     {"On", true},     {"ON", true},     {"no", false},  {"No", false},  {"NO", false},
               {"false", false}, {"False", false}, {"FALSE", false}, {"off", false}, {"Off", false}, {"OFF", false}};
  static const char *const wrong[] = {"tRUE", "TRue", "TrUE", "oN", "\"yes\"", "y", "n", "1", "0", "yess", "o", "T"};
  char set[128];
  for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
    snprintf(set, sizeof set, "particles={density: 2, discs: [{radius: 5, position: [50, 50], fixed: %s}]}",
             words[i].word);
    struct scene scene = scene_with(set);
    cr_expect_eq(scene.particles.discs[0].motion, words[i].flag ? DISC_FIXED : DISC_FREE, "%s", words[i].word);
    scene_clear(&scene);
  }
  for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
    snprintf(set, sizeof set, "fluid.zero_flux=%s", wrong[i]);
    struct reading reading = read_with(minimal, set);
    cr_expect_not(reading.valid, "%s", wrong[i]);
    release(&reading);
  }
}

Test(scene, errors_beyond_the_limit_are_counted)
{
  enum { WRONG = 5000 };
  char *text = NULL;
  size_t size;
  FILE *file = open_memstream(&text, &size);
  fprintf(file, "%sparticles:\n  discs:\n", minimal);
  for (int i = 0; i < WRONG; i++) fputs("    - 1\n", file);
  fclose(file);
  struct reading reading = read_sized(text, size, NULL, 0);
  cr_expect_not(reading.valid);
  cr_expect_eq(reading.errors.count, SCENE_ERRORS_KEPT);
  cr_expect_eq(case_errors_total(&reading.errors), WRONG);
  free(text);
  release(&reading);
}

Test(scene, file_that_is_too_large_is_refused)
{
  size_t size = ((size_t)SCENE_FILE_MIB << 20) + 1;
  char *text = malloc(size);
  cr_assert(text);
  memset(text, '\n', size);
  struct reading reading = read_sized(text, size, NULL, 0);
  cr_expect_not(reading.valid);
  cr_assert_eq(reading.errors.count, 1);
  cr_expect(strstr(reading.errors.lines[0], "the file is too large; expected at most 64 MiB"));
  free(text);
  release(&reading);
}

Test(scene, deep_nesting_is_refused_at_once, .timeout = 10 * SLOWNESS)
{
  size_t size = (size_t)8 << 20;
  char *text = malloc(size);
  cr_assert(text);
  memset(text, '[', size);
  struct reading reading = read_sized(text, size, NULL, 0);
  cr_expect_not(reading.valid);
  cr_assert_eq(reading.errors.count, 1);
  cr_expect(strstr(reading.errors.lines[0], ":1:33: nested too deep"), "%s", reading.errors.lines[0]);
  free(text);
  release(&reading);
}

Test(scene, key_reference_has_every_key)
{
  char *text = NULL;
  size_t size, count;
  FILE *file = open_memstream(&text, &size);
  case_print_keys(file);
  fclose(file);
  const struct key *keys = key_table(&count);
  for (size_t i = 0; i < count; i++) cr_expect(strstr(text, keys[i].path), "%s", keys[i].path);
  free(text);
}

/* A case with a listed disc and a fill, so that any key may be replaced. */
static const char furnished[] = "domain: {size: [100, 200]}\nfluid: {viscosity: 0.05}\nrun: {steps: 10}\n"
                                "particles:\n  density: 2\n  discs: [{radius: 5, position: [50, 180]}]\n"
                                "  fill: {radius: 4, spacing: 20, region: [0, 0, 100, 100]}\n";

/* True if this number (for a vector: in x) is refused by the range of the key. */
static bool out_of_range(const struct key *key, double number)
{
  char path[KEY_PATH + 8], set[256], allowed[VALUE_TEXT];
  const char *brackets = strstr(key->path, "[]");
  const int before = brackets ? (int)(brackets - key->path) : (int)strlen(key->path);
  snprintf(path, sizeof path, "%.*s%s%s", before, key->path, brackets ? ".0" : "", brackets ? brackets + 2 : "");
  snprintf(set, sizeof set, key->kind == KEY_VECTOR ? "%s=[%.17g, 0]" : "%s=%.17g", path, number);
  value_describe(key, allowed);
  struct reading reading = read_with(furnished, set);
  bool refused = false;
  for (size_t i = 0; i < reading.errors.count; i++) {
    const char *line = reading.errors.lines[i];
    refused |= strstr(line, path) && strstr(line, allowed) && strstr(line, "got ");
  }
  release(&reading);
  return refused;
}

/* Tests an end of the range and its neighbours inside and outside. */
static void expect_end(const struct key *key, double end, bool open, int outwards)
{
  const bool whole = key->kind == KEY_INTEGER || key->kind == KEY_LONG;
  const double far = outwards > 0 ? (double)INFINITY : -(double)INFINITY;
  double outside = whole ? end + outwards : nextafter(end, far), inside = whole ? end - outwards : nextafter(end, -far);
  if (end == 0 && !whole) outside = outwards * 1e-300, inside = -outside; /* smaller numbers underflow */
  cr_expect_eq(out_of_range(key, end), open, "%s at %g", key->path, end);
  cr_expect(out_of_range(key, outside), "%s beyond %g", key->path, end);
  cr_expect_not(out_of_range(key, inside), "%s before %g", key->path, end);
}

Test(scene, every_range_of_the_table_ends_exactly_where_it_says)
{
  size_t count, ends = 0;
  const struct key *keys = key_table(&count);
  for (size_t i = 0; i < count; i++) {
    const struct key *key = &keys[i];
    const bool single = key->kind == KEY_NUMBER || key->kind == KEY_INTEGER || key->kind == KEY_LONG;
    char left, right;
    double low, high;
    if ((!single && key->kind != KEY_VECTOR) || key_within(key->path, "units")) continue;
    const bool or_automatic = strncmp(key->allowed, key_or_automatic, strlen(key_or_automatic)) == 0;
    const char *range = key->allowed + (or_automatic ? strlen(key_or_automatic) : 0);
    cr_assert_eq(sscanf(range, "%c%lf, %lf%c", &left, &low, &high, &right), 4, "%s", key->path);
    if (single && isfinite(low)) expect_end(key, low, left == '(', -1), ends++;
    if (isfinite(high)) expect_end(key, high, right == ')', 1), ends++;
  }
  cr_expect_gt(ends, 45);
}

/* Limits by several keys: values on either side of each limit. */
Test(scene, limits_between_keys_are_refused_from_where_they_are_passed)
{
  static const struct {
    const char *key, *good, *bad;
  } limits[] = {
      {"domain.size", "[65536, 131072]", "[65536, 131073]"},
      {"particles.discs", "[{radius: 4, position: [0, 0]}]", "[{radius: 5, position: [-1e-300, 0]}]"},
      {"particles.discs", "[{radius: 4, position: [99.99999999999999, 199.99999999999997]}]",
       "[{radius: 5, position: [100, 150]}]"},
      {"particles.discs", "[{radius: 5, position: [50, 150]}]", "[{radius: 5, position: [50, 200]}]"},
      {"particles.discs", "[{radius: 10, position: [50, 150], spin: 0.03}]",
       "[{radius: 10, position: [50, 150], spin: 0.0300000001}]"},
      {"particles.discs", "[{radius: 4, position: [50, 150], velocity: [-0.15, 0.2], spin: -0.0124}]",
       "[{radius: 4, position: [50, 150], velocity: [-0.15, 0.2], spin: -0.0126}]"},
      {"particles.discs", "[{radius: 5, position: [50, 150], fixed: true, spin: 0.06}]",
       "[{radius: 5, position: [50, 150], fixed: true, velocity: [1e-300, 0]}]"},
      {"particles.discs", "[{radius: 1, position: [50, 150]}, {radius: 1, position: [50, 150.00000000000003]}]",
       "[{radius: 1, position: [50, 150]}, {radius: 1, position: [50, 150]}]"},
      {"particles.discs",
       "[{radius: 99, position: [50, 150], fixed: true}, {radius: 99, position: [51, 150], fixed: true}, {radius: 99, "
       "position: [52, 150], fixed: true}, "
       "{radius: "
       "99, position: [53, 150], fixed: true}]",
       "[{radius: 99, position: [50, 150], fixed: true}, {radius: 99, position: [51, 150], fixed: true}, {radius: 99, "
       "position: [52, 150], fixed: true}, "
       "{radius: "
       "99, position: [53, 150], fixed: true}, {radius: 0.5, position: [54, 150], fixed: true}]"},
      {"domain", "{size: [100, 200], left: periodic, right: periodic, top: {velocity: [0.1, 0]}}",
       "{size: [100, 200], left: periodic, right: periodic, top: {velocity: [0.1, 1e-300]}}"},
      {"domain", "{size: [100, 200], left: {type: inlet, velocity: [1e-300, 0.1]}, right: outlet}",
       "{size: [100, 200], left: {type: inlet, velocity: [0, 0.1]}, right: outlet}"},
      {"domain", "{size: [100, 200], right: {type: inlet, velocity: [-1e-300, 0]}, left: outlet}",
       "{size: [100, 200], right: {type: inlet, velocity: [1e-300, 0]}, left: outlet}"},
      {"particles.fill", "{radius: 10, spacing: 20}", "{radius: 10, spacing: 19.999999999999996}"},
      {"particles.fill", "{radius: 4, spacing: 20, jitter: 10}",
       "{radius: 4, spacing: 20, jitter: 10.000000000000002}"},
      {"particles.fill", "{radius: 4, spacing: 20, region: [0, 0, 100, 200]}",
       "{radius: 4, spacing: 20, region: [0, 0, 100, 200.00000000000003]}"},
      {"particles.fill", "{radius: 4, spacing: 20, region: [0, 0, 100, 200]}",
       "{radius: 4, spacing: 20, region: [0, 0, 100.00000000000001, 200]}"},
      {"particles.fill", "{radius: 4, spacing: 8, region: [0, 92, 8, 100]}",
       "{radius: 4, spacing: 8.000000000000002, region: [0, 92, 8, 100]}"},
      {"particles.fill", "{radius: 1, spacing: 2, region: [0, 0, 2, 2]}",
       "{radius: 1, spacing: 2, region: [2, 0, 2, 2]}"},
      {"output.fields", "{every: 0, region: [99, 199, 100, 200]}", "{every: 0, region: [100, 199, 100, 200]}"},
      {"output.fields", "{every: 0, region: [0, 0, 100, 200]}", "{every: 0, region: [0, 0, 101, 200]}"},
      {"output.fields", "{every: 0, region: [0, 0, 100, 200]}", "{every: 0, region: [0, 0, 100, 201]}"},
      {"output.fields", "{every: 0, region: [0, 0, 1, 1]}", "{every: 0, region: [0, 0, 1.5, 1]}"},
      {"contact", "{law: linear, area: lens}", "{law: linear, area: cells}"},
      {"contact", "{area: cells, search: linked-cell, substeps: 1}", "{area: cells, substeps: 2}"},
      {"fluid", "{viscosity: 0.05, zero_flux: true}", "{viscosity: 0.05, zero_flux: 2}"},
      {"fluid", "{viscosity: 1e-15}", "{viscosity: 1e-17}"},
      {"fluid", "{viscosity: 0.1, magic: 1e-15}", "{viscosity: 0.1, magic: 1e-17}"},
  };
  for (size_t i = 0; i < sizeof limits / sizeof limits[0]; i++)
    for (int bad = 0; bad < 2; bad++) {
      char set[512];
      snprintf(set, sizeof set, "%s=%s", limits[i].key, bad ? limits[i].bad : limits[i].good);
      struct reading reading = read_with(furnished, set);
      if (reading.valid == bad) case_errors_print(&reading.errors, stderr);
      cr_expect_eq(reading.valid, !bad, "%s", set);
      release(&reading);
    }
}

/* Along a periodic axis a wider disc would touch its own image. */
Test(scene, disc_may_be_four_cells_narrower_than_a_periodic_extent)
{
  static const struct {
    const char *sides;
    double radius;
    bool valid;
  } discs[] = {{"left: periodic, right: periodic", 48, true},
               {"left: periodic, right: periodic", 48.00000000000001, false},
               {"bottom: periodic, top: periodic", 98, true},
               {"bottom: periodic, top: periodic", 98.00000000000001, false},
               {"left: wall", 200, true}};
  for (size_t i = 0; i < sizeof discs / sizeof discs[0]; i++)
    for (int fill = 0; fill < 2; fill++) {
      char text[512];
      if (fill && discs[i].radius > 100) continue;
      snprintf(text, sizeof text,
               fill ? "domain: {size: [100, 200], %s}\nfluid: {viscosity: 0.05}\nrun: {steps: 1}\n"
                      "particles: {density: 2, fill: {spacing: 100, radius: %.17g}}\n"
                    : "domain: {size: [100, 200], %s}\nfluid: {viscosity: 0.05}\nrun: {steps: 1}\n"
                      "particles: {density: 2, discs: [{position: [50, 100], radius: %.17g, fixed: true}]}\n",
               discs[i].sides, discs[i].radius);
      struct reading reading = read_text(text);
      if (fill && discs[i].radius > 50) {
        cr_expect_not(reading.valid); /* than half the spacing */
        cr_expect_eq(reading.errors.count, discs[i].valid ? 1 : 2);
      } else {
        cr_expect_eq(reading.valid, discs[i].valid, "%s", text);
      }
      release(&reading);
    }
}

/* Golden tests: tests/broken/NAME.yaml and the message in NAME.expected. */

static char *read_expected(const char *name)
{
  char path[512];
  snprintf(path, sizeof path, "%s.expected", name);
  FILE *file = fopen(path, "r");
  cr_assert(file, "cannot open %s", path);
  char *text = NULL;
  size_t capacity = 0;
  if (getdelim(&text, &capacity, '\0', file) < 0) cr_assert_fail("%s is empty", path);
  fclose(file);
  return text;
}

static void expect_errors(const char *name)
{
  char path[512], *text = NULL;
  size_t size;
  struct scene scene;
  struct case_errors errors = {0};
  struct status status;
  snprintf(path, sizeof path, "%s.yaml", name);
  cr_expect_not(case_read(&scene, path, NULL, 0, &errors, &status), "%s is taken as valid", path);
  cr_expect_eq(status.code, DELBM_INVALID, "%s: %s", path, status.message);
  FILE *file = open_memstream(&text, &size);
  case_errors_print(&errors, file);
  fclose(file);
  char *expected = read_expected(name);
  cr_expect_str_eq(text, expected, "%s gives\n%sinstead of\n%s", path, text, expected);
  free(expected);
  free(text);
  case_errors_clear(&errors);
}

static bool strip(char *name, const char *extension)
{
  char *dot = strrchr(name, '.');
  if (!dot || strcmp(dot, extension) != 0) return false;
  *dot = '\0';
  return true;
}

Test(scene, broken_cases_get_the_expected_errors, .timeout = 60 * SLOWNESS)
{
  const char *root = getenv("DELBM_SOURCE_ROOT");
  cr_assert_eq(chdir(root ? root : TEST_DIR), 0);
  cr_assert_eq(chdir(root ? "tests/broken" : "broken"), 0);
  DIR *folder = opendir(".");
  cr_assert(folder);
  size_t count = 0;
  for (struct dirent *entry = readdir(folder); entry; entry = readdir(folder)) {
    if (!strip(entry->d_name, ".yaml")) continue;
    expect_errors(entry->d_name);
    count++;
  }
  closedir(folder);
  cr_expect_geq(count, 100);
}

Test(errors, beyond_the_limit_are_counted_in_a_last_line)
{
  struct case_errors errors = {0};
  char *text = NULL;
  size_t size = 0;
  for (int k = 0; k < SCENE_ERRORS_KEPT + 3; k++) case_errors_add(&errors, "error %d", k);
  FILE *file = open_memstream(&text, &size);
  cr_assert(file);
  case_errors_print(&errors, file);
  cr_assert_eq(fclose(file), 0);
  cr_expect_eq(case_errors_total(&errors), SCENE_ERRORS_KEPT + 3);
  cr_expect(strstr(text, "error 999\nand 3 more\n"), "%s", text + size - 40);
  free(text);
  case_errors_clear(&errors);
}
