/* Stiffness of contacts from the load that they are expected to bear, and overlaps in runs with it. */
#include "scenes.h"

#include "case/case_file.h"
#include "case/case_write.h"
#include "contact/law.h"
#include "sim/load.h"
#include "sim/simulation.h"

#include <criterion/criterion.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

TestSuite(load);

/* A case of the text, with its stiffness derived. */
static struct scene read_case(const char *yaml)
{
  struct scene scene;
  struct case_errors errors = {0};
  struct status status;
  const struct yaml_text text = {"text", true, yaml, strlen(yaml)};
  const bool read = case_read_text(&scene, &text, NULL, 0, &errors, &status);
  cr_assert(read, "%s: %s", yaml, errors.count > 0 ? errors.lines[0] : status.message);
  case_errors_clear(&errors);
  return scene;
}

static struct scene read_discs(const char *domain, const char *particles, const char *contact)
{
  char yaml[1024];
  snprintf(yaml, sizeof yaml,
           "domain: {size: [100, 200]%s}\nfluid: {viscosity: 0.05}\nparticles: {%s}\ncontact: {%s}\nrun: {steps: 1}\n",
           domain, particles, contact);
  return read_case(yaml);
}

#define ALL_PERIODIC ", left: periodic, right: periodic, bottom: periodic, top: periodic"

Test(load, sets_the_default_stiffness_where_gravity_or_initial_speeds_give_one_and_else_it_is_a_quarter)
{
  static const struct {
    const char *domain, *particles, *contact;
    enum stiffness_source source;
    double stiffness; /* 0: any above 0.25 */
  } cases[] = {
      {"", "density: 2, gravity: [0, -0.001], discs: [{radius: 5, position: [50, 100]}]", "", STIFFNESS_IMPACT, 0},
      {"", "density: 2, gravity: [0, -0.001], discs: [{radius: 5, position: [50, 100]}]", "stiffness: auto",
       STIFFNESS_IMPACT, 0},
      {"", "density: 0.5, gravity: [0, -0.001], discs: [{radius: 5, position: [50, 100]}]", "", STIFFNESS_IMPACT, 0},
      {"", "density: 1, discs: [{radius: 5, position: [50, 100], velocity: [0.05, 0]}]", "", STIFFNESS_IMPACT, 0},
      {"",
       "density: 1, discs: [{radius: 5, position: [50, 100]}, {radius: 5, position: [80, 100], driven: true, "
       "velocity: [-0.05, 0]}]",
       "", STIFFNESS_IMPACT, 0},
      {ALL_PERIODIC,
       "density: 2, gravity: [0, -0.001], discs: [{radius: 5, position: [50, 100]}, {radius: 5, position: "
       "[50, 60]}]",
       "", STIFFNESS_IMPACT, 0},
      {"", "density: 5, gravity: [0, -0.01], discs: [{radius: 5, position: [50, 5]}]", "", STIFFNESS_AT_REST, 0},
      /* no load */
      {"", "density: 2, discs: [{radius: 5, position: [50, 100]}]", "", STIFFNESS_LEAST, 0.25},
      {"", "density: 1, gravity: [0, -0.001], discs: [{radius: 5, position: [50, 100]}]", "", STIFFNESS_LEAST, 0.25},
      {"", "gravity: [0, -0.001], discs: [{radius: 5, position: [50, 100], fixed: true}]", "", STIFFNESS_LEAST, 0.25},
      {ALL_PERIODIC, "density: 2, gravity: [0, -0.001], discs: [{radius: 5, position: [50, 100]}]", "", STIFFNESS_LEAST,
       0.25},
      /* given */
      {"", "density: 2, gravity: [0, -0.001], discs: [{radius: 5, position: [50, 100]}]", "stiffness: 3",
       STIFFNESS_GIVEN, 3},
      {"", "density: 2, gravity: [0, -0.001], discs: [{radius: 5, position: [50, 100]}]", "stiffness: 0",
       STIFFNESS_GIVEN, 0}};
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
    struct scene scene = read_discs(cases[k].domain, cases[k].particles, cases[k].contact);
    cr_expect_eq(scene.contact.stiffness_source, cases[k].source, "case %zu: source %d", k,
                 scene.contact.stiffness_source);
    if (cases[k].stiffness > 0 || cases[k].source == STIFFNESS_GIVEN)
      cr_expect_eq(scene.contact.stiffness, cases[k].stiffness, "case %zu: %g", k, scene.contact.stiffness);
    else
      cr_expect_gt(scene.contact.stiffness, 0.25, "case %zu: %g", k, scene.contact.stiffness);
    scene_clear(&scene);
  }
}

/* Stiffness of a scene whose discs have been added in code. */
static double stiffness_of(struct scene *scene)
{
  const struct loads loads = loads_of(scene);
  load_set_stiffness(scene, &loads, INFINITY);
  return scene->contact.stiffness;
}

/* Discs that touch, from the ground up, in a box hardly wider than they are. */
static struct scene column(int count, double radius, double gravity)
{
  struct scene scene = scene_box((int)ceil(2 * radius) + 1, (int)(2 * radius * (count + 1)), 0.1, SIDES_CLOSED);
  scene.particles.gravity[1] = -gravity;
  scene.fluid.zero_flux = true;
  for (int k = 0; k < count; k++) scene_add_disc(&scene, radius, 2.5, scene.domain.size[0] / 2.0, radius * (2 * k + 1));
  return scene;
}

Test(load, at_rest_gives_a_stiffness_in_proportion_to_gravity_and_to_the_height_of_the_pile)
{
  const double gravity = 0.002;
  double k[3];
  for (int n = 0; n < 3; n++) {
    struct scene scene = column(n == 2 ? 6 : 3, 10, n == 1 ? 2 * gravity : gravity);
    k[n] = stiffness_of(&scene);
    cr_expect_eq(scene.contact.stiffness_source, STIFFNESS_AT_REST);
    scene_clear(&scene);
  }
  cr_expect_float_eq(k[1] / k[0], 2, 1e-9);
  cr_expect_float_eq(k[2] / k[0], 2, 1e-9);
}

static struct scene impact(double speed, double radius)
{
  struct scene scene = scene_box(100, 100, 0.05, SIDES_PERIODIC);
  for (int k = 0; k < 2; k++)
    scene_add_disc(&scene, radius, 2, 50 + (2 * k - 1) * 1.5 * radius, 50)->velocity[0] = (0.5 - k) * speed;
  return scene;
}

Test(load, of_an_impact_gives_a_stiffness_in_proportion_to_the_square_of_relative_speed)
{
  struct scene slow = impact(0.02, 8), fast = impact(0.06, 8), small = impact(0.02, 4);
  const double k = stiffness_of(&slow);
  cr_expect_float_eq(stiffness_of(&fast) / k, 9, 1e-9);
  cr_expect_float_eq(stiffness_of(&small) / k, 2, 1e-9, "the same impact at half the scale");
  slow.contact.overlap = 0.005;
  cr_expect_float_eq(stiffness_of(&slow) / k, pow(2, 2.5), 0.02);
  scene_clear(&slow);
  scene_clear(&fast);
  scene_clear(&small);
}

Test(load, is_borne_with_the_overlap_asked_for_by_every_law)
{
  for (unsigned law = 0; law < 3; law++)
    for (int k = 0; k < 4; k++) {
      struct scene scene = k % 2 ? impact(0.05, 8) : column(5, 10, 0.002);
      scene.contact.law = law;
      scene.contact.overlap = k < 2 ? 0.01 : 0.03;
      stiffness_of(&scene);
      const struct loads loads = loads_of(&scene);
      cr_expect_float_eq(load_overlap(&scene, k % 2 ? &loads.impact : &loads.at_rest), scene.contact.overlap, 1e-9,
                         "law %u, scene %d", law, k);
      scene_clear(&scene);
    }
}

Test(load, of_discs_of_several_sizes_is_that_of_the_largest_on_the_smallest)
{
  struct scene scene = column(4, 10, 0.002);
  struct load load = loads_of(&scene).at_rest;
  const double alike = load_stiffness(&scene, &load);
  scene.particles.discs[1].radius = 5;
  load = loads_of(&scene).at_rest;
  const double mixed = load_stiffness(&scene, &load);
  cr_expect_eq(fmax(load.radius[0], load.radius[1]), 10);
  cr_expect_eq(fmin(load.radius[0], load.radius[1]), 5);
  /* weight 13/16 of before; force of the law at 1 % of half the radius, effective radius 10/3 for 5 */
  cr_expect_float_eq(mixed / alike, 13. / 16 * pow(2, 1.5) * sqrt(5 / (10. / 3)), 0.01 * mixed / alike);
  scene_clear(&scene);
}

Test(load, of_few_discs_is_their_own_weight_on_the_side_or_of_a_large_one_on_a_smaller_one)
{
  struct scene scene = scene_box(200, 200, 0.1, SIDES_CLOSED);
  scene.particles.gravity[1] = -0.001;
  scene_add_disc(&scene, 10, 2, 50, 10);
  scene_add_disc(&scene, 10, 2, 150, 10);
  struct load load = loads_of(&scene).at_rest;
  cr_expect_float_eq(load.force, M_PI * 100 * 0.001, 1e-12);
  cr_expect_eq(load.radius[0], 10);
  cr_expect(isinf(load.radius[1]));
  scene.particles.discs[1].radius = 4;
  load = loads_of(&scene).at_rest;
  cr_expect_float_eq(load.force, M_PI * 100 * 0.001, 1e-12);
  cr_expect_eq(load.radius[0], 10);
  cr_expect_eq(load.radius[1], 4);
  scene_clear(&scene);
}

Test(load, of_a_dense_column_is_borne_by_its_own_width_whatever_the_width_of_the_box)
{
  struct scene narrow = column(8, 10, 0.002), wide = column(8, 10, 0.002);
  wide.domain.size[0] = 60;
  cr_expect_float_eq(loads_of(&narrow).at_rest.force, 8 * 1.5 * M_PI * 100 * 0.002, 1e-9);
  cr_expect_float_eq(loads_of(&wide).at_rest.force, 8 * 1.5 * M_PI * 100 * 0.002, 1e-9);
  scene_clear(&narrow);
  scene_clear(&wide);
}

/* Free fall from `height` through fluid, or terminal velocity where that is less. */
Test(load, of_a_falling_disc_grows_with_the_height_of_the_fall_up_to_that_of_terminal_velocity)
{
  double speed[5];
  for (int k = 0; k < 5; k++) {
    static const double heights[] = {0, 0.1, 0.4, 300, 0.3};
    struct scene scene = scene_box(100, 400, 0.05, SIDES_CLOSED);
    scene.particles.gravity[1] = -0.001;
    scene_add_disc(&scene, 10, 2, 50, 10 + heights[k]);
    if (k == 4) scene.particles.discs[0].velocity[1] = -sqrt(2 * 0.001 / 3 * 0.1);
    speed[k] = loads_of(&scene).impact.speed;
    scene_clear(&scene);
  }
  cr_expect_eq(speed[0], 0);
  cr_expect_float_eq(speed[1], sqrt(2 * 0.001 / 3 * 0.1), 1e-12, "m g/(m + m_f) with density 2, less buoyancy");
  cr_expect_float_eq(speed[2], 2 * speed[1], 1e-12);
  cr_expect(speed[3] > speed[2] && speed[3] < sqrt(2 * 0.001 / 3 * 300), "%g", speed[3]);
  cr_expect_float_eq(speed[4], speed[2], 1e-12, "thrown with the speed of the upper part of the fall");
}

Test(load, without_fluid_is_that_of_a_free_fall_and_of_the_whole_weight)
{
  struct scene scene =
      read_case("domain: {size: [100, 200]}\nfluid: none\nparticles: {density: 2, gravity: [0, -0.0001], "
                "discs: [{radius: 5, position: [50, 105]}]}\nrun: {steps: 1}\n");
  const struct loads loads = loads_of(&scene);
  cr_expect_eq(scene.contact.stiffness_source, STIFFNESS_IMPACT);
  cr_expect_float_eq(loads.at_rest.force, 2 * M_PI * 25 * 0.0001, 1e-12);
  cr_expect_float_eq(loads.impact.speed, sqrt(2 * 0.0001 * 100), 1e-12);
  cr_expect_float_eq(loads.impact.mass, 2 * M_PI * 25, 1e-9);
  scene_clear(&scene);
}

Test(load, gives_a_stiffness_that_parts_discs_that_overlap_at_the_start_gently)
{
  struct scene apart = read_discs("",
                                  "density: 2, gravity: [0, -0.001], discs: [{radius: 10, position: [50, 100]}, "
                                  "{radius: 10, position: [50, 120]}]",
                                  "");
  struct scene into = read_discs("",
                                 "density: 2, gravity: [0, -0.001], discs: [{radius: 10, position: [50, 100]}, "
                                 "{radius: 10, position: [50, 118]}]",
                                 "");
  const struct contact_law law = contact_law_of(&into);
  const double energy = contact_energy(&law, (const double[2]){10, 10}, 2), mass = 3 * M_PI * 100 / 2;
  cr_expect_eq(apart.contact.stiffness_source, STIFFNESS_IMPACT);
  cr_expect_eq(into.contact.stiffness_source, STIFFNESS_START);
  cr_expect_float_eq(sqrt(2 * energy / mass), 0.1, 1e-9);
  struct scene deep = read_discs("",
                                 "density: 2, gravity: [0, -0.001], discs: [{radius: 10, position: [50, 100]}, "
                                 "{radius: 10, position: [50, 113]}]",
                                 "");
  cr_expect_eq(deep.contact.stiffness_source, STIFFNESS_LEAST);
  cr_expect_eq(deep.contact.stiffness, 0.25);
  scene_clear(&apart);
  scene_clear(&into);
  scene_clear(&deep);
}

Test(load, gives_no_stiffness_that_the_available_sub_steps_do_not_resolve)
{
  static const char *const contacts[] = {"", "area: cells", "substeps: 1", "substeps: 2"};
  double stiffness[4];
  for (int k = 0; k < 4; k++) {
    struct scene scene =
        read_discs("", "density: 2, gravity: [0, -0.001], discs: [{radius: 10, position: [50, 100]}]", contacts[k]);
    stiffness[k] = scene.contact.stiffness;
    cr_expect_eq(scene.contact.stiffness_source, k == 0 ? STIFFNESS_IMPACT : STIFFNESS_SUBSTEPS, "%s", contacts[k]);
    const struct contact_law law = contact_law_of(&scene);
    const double slope = contact_spring_at(&law, (const double[2]){10, INFINITY}, 1).stiffness;
    const double half_period = M_PI / sqrt(slope / (3 * M_PI * 100));
    if (k > 0) cr_expect_float_eq(half_period, k == 3 ? 10 : 20, 1e-9, "%s: %g steps", contacts[k], half_period);
    scene_clear(&scene);
  }
  cr_expect_eq(stiffness[1], stiffness[2]);
  cr_expect(stiffness[3] < stiffness[0]);
}

/* The case as written, of which the caller owns the memory. */
static char *written(const struct scene *scene)
{
  char *text = NULL;
  size_t size = 0;
  FILE *file = open_memstream(&text, &size);
  cr_assert(file && case_write(scene, file) && fclose(file) == 0);
  return text;
}

Test(load, derived_stiffness_is_written_as_a_number_that_reads_back_equal)
{
  static const char *const contacts[] = {"stiffness: auto, overlap: 0.007", "stiffness: 0", "stiffness: 0.25"};
  for (int k = 0; k < 3; k++) {
    struct scene scene =
        read_discs("", "density: 2, gravity: [0, -0.001], discs: [{radius: 10, position: [50, 100]}]", contacts[k]);
    char *text = written(&scene);
    struct scene again = read_case(text);
    cr_expect_eq(again.contact.stiffness, scene.contact.stiffness, "%s", contacts[k]);
    cr_expect_eq(again.contact.overlap, scene.contact.overlap, "%s", contacts[k]);
    cr_expect_eq(again.contact.stiffness_source, STIFFNESS_GIVEN);
    free(text);
    scene_clear(&scene);
    scene_clear(&again);
  }
}

/* Largest overlap of neighbours in the list and of disc 0 with the bottom, over the radius of disc 0. */
static double overlap_now(const struct scene *scene, struct simulation *simulation)
{
  const struct discs *discs = simulation_discs(simulation);
  const double radius = scene->particles.discs[0].radius;
  double deepest = radius - discs->y[0];
  for (size_t i = 1; i < scene->particles.count; i++)
    deepest = fmax(deepest, 2 * radius - hypot(discs->x[i] - discs->x[i - 1], discs->y[i] - discs->y[i - 1]));
  return deepest / radius;
}

/* The largest overlap over `steps` steps, and that at the end. */
static double largest_overlap(const struct scene *scene, int steps, double *last)
{
  struct simulation *simulation;
  struct status status;
  double largest = 0;
  cr_assert(simulation_create(&simulation, scene, &status), "%s", status.message);
  for (int k = 0; k < steps; k++) {
    cr_assert(simulation_advance(simulation, 1, &status), "%s", status.message);
    *last = overlap_now(scene, simulation);
    largest = fmax(largest, *last);
  }
  simulation_destroy(simulation);
  return largest;
}

Test(load, of_a_column_at_rest_is_borne_with_an_overlap_of_at_most_the_one_asked_for)
{
  struct scene scene = column(5, 10, 0.002);
  double last;
  stiffness_of(&scene);
  const double largest = largest_overlap(&scene, 4000, &last);
  cr_expect(largest > 0.003 && largest < 0.012, "%g", largest);
  cr_expect(last > 0.003 && last < 0.0105, "%g", last);
  scene_clear(&scene);
}

Test(load, of_an_impact_at_the_expected_speed_is_borne_with_an_overlap_of_at_most_the_one_asked_for)
{
  for (int damped = 0; damped < 2; damped++) {
    double last;
    struct scene scene = impact(0.02, 8);
    scene.particles.discs[0].density = scene.particles.discs[1].density = 20;
    if (!damped) scene.contact.damping = 0;
    stiffness_of(&scene);
    for (int k = 0; k < 2; k++) scene.particles.discs[k].position[0] = 50 + (2 * k - 1) * 8.01;
    const double largest = largest_overlap(&scene, 40, &last);
    cr_expect(largest > (damped ? 0.003 : 0.009) && largest < 0.0105, "damped %d: %g", damped, largest);
    scene_clear(&scene);
  }
}
