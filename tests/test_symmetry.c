/* Each scene turned by 90, 180 and 270 degrees, mirrored in x, in y and along both diagonals must have the same
 * flow: sides and their corners, forces, discs. The code is its own reference. */
#include "scenes.h"
#include "symmetry.h"

#include <criterion/criterion.h>
#include <math.h>
#include <stdio.h>

enum { FLUID_STEPS = 200, DISC_STEPS = 50 };

/* A smooth flow without any symmetry, up to about 0.05 cells/step, with its gradient. */
static struct flow_state waves(const void *context, int x, int y)
{
  static const struct {
    double amplitude, kx, ky, phase;
  } wave[2][2] = {{{0.02, 0.31, 0.17, 0.4}, {0.02, -0.23, 0.41, 1.9}},
                  {{0.02, 0.19, -0.29, 2.7}, {0.02, 0.37, 0.11, 0.9}}};
  struct flow_state state = {.density = 1 + 0.01 * sin(0.27 * x - 0.21 * y + 0.5)};
  (void)context;
  for (int axis = 0; axis < 2; axis++)
    for (int k = 0; k < 2; k++) {
      const double argument = wave[axis][k].kx * x + wave[axis][k].ky * y + wave[axis][k].phase;
      state.velocity[axis] += wave[axis][k].amplitude * sin(argument);
      state.gradient[axis][0] += wave[axis][k].amplitude * wave[axis][k].kx * cos(argument);
      state.gradient[axis][1] += wave[axis][k].amplitude * wave[axis][k].ky * cos(argument);
    }
  return state;
}

/* A kind of side. Velocity: into the box, and along the side with the box on the left. */
struct kind {
  const char *name;
  enum side_type type;
  double inward, along;
  int opposite; /* the kind of the side that faces it, in the table */
};

enum { RESTING, MOVING, INLET, SLANTING, OUTLET, PERIODIC, SLIP, KINDS };

static const struct kind kinds[KINDS] = {
    [RESTING] = {"a resting wall", SIDE_WALL, 0, 0, RESTING},
    [MOVING] = {"a moving wall", SIDE_WALL, 0, 0.04, RESTING},
    [INLET] = {"an inlet", SIDE_INLET, 0.03, 0, OUTLET},
    [SLANTING] = {"a slanting inlet", SIDE_INLET, 0.03, 0.02, OUTLET},
    [OUTLET] = {"an outlet", SIDE_OUTLET, 0, 0, INLET},
    [PERIODIC] = {"a periodic side", SIDE_PERIODIC, 0, 0, PERIODIC},
    [SLIP] = {"a slip side", SIDE_SLIP, 0, 0, RESTING},
};

static void set_side(struct scene *scene, enum side_name name, const struct kind *kind)
{
  static const double inward[SIDE_COUNT][2] = {
      [SIDE_LEFT] = {1, 0}, [SIDE_RIGHT] = {-1, 0}, [SIDE_BOTTOM] = {0, 1}, [SIDE_TOP] = {0, -1}};
  const double *n = inward[name];
  scene->domain.side[name] =
      (struct side){.type = kind->type,
                    .velocity = {kind->inward * n[0] + kind->along * n[1], kind->inward * n[1] - kind->along * n[0]}};
}

/* Kinds `left` and `bottom` form the lower left corner; the opposite sides have the kinds' opposites. */
static void set_sides(struct scene *scene, int left, int bottom)
{
  set_side(scene, SIDE_LEFT, &kinds[left]);
  set_side(scene, SIDE_RIGHT, &kinds[kinds[left].opposite]);
  set_side(scene, SIDE_BOTTOM, &kinds[bottom]);
  set_side(scene, SIDE_TOP, &kinds[kinds[bottom].opposite]);
}

/* Variants of a scene: one bit each. */
enum { WITH_FORCE = 1, WITH_MRT = 2, BLOCKED = 4, SINGLE = 8, VARIANTS = 16 };

static struct scene box(int nx, int ny, int left, int bottom, int variant)
{
  struct scene scene = scene_box(nx, ny, 0.05, SIDES_CLOSED);
  set_sides(&scene, left, bottom);
  if (variant & WITH_FORCE) scene.fluid.force[0] = 2e-5, scene.fluid.force[1] = -3e-5;
  if (variant & WITH_MRT) scene_use_paper_rates(&scene);
  if (variant & SINGLE) scene.fluid.precision = PRECISION_SINGLE;
  scene.run.plan.depth = variant & BLOCKED ? 8 : 1;
  return scene;
}

static const char *in_words(char text[160], int left, int bottom, int variant, const char *more)
{
  snprintf(text, 160, "%s that meets %s, force %d, %s, blocked %d, %s%s", kinds[left].name, kinds[bottom].name,
           (variant & WITH_FORCE) != 0, variant & WITH_MRT ? "mrt" : "adaptive", (variant & BLOCKED) != 0,
           variant & SINGLE ? "single" : "double", more);
  return text;
}

/* Fluid alone, from the flow `waves`. */
static void expect_fluid_symmetric(int left, int bottom)
{
  char text[160];
  for (int variant = 0; variant < VARIANTS; variant++) {
    const struct scene scene = box(24, 17, left, bottom, variant);
    expect_symmetric(&scene, &(struct symmetric_run){.initial = waves,
                                                     .steps = FLUID_STEPS,
                                                     .what = in_words(text, left, bottom, variant, "")});
  }
}

static bool is_open(int kind)
{
  return kinds[kind].type == SIDE_INLET || kinds[kind].type == SIDE_OUTLET;
}

Test(fluid, is_symmetric_in_periodic_boxes_and_between_walls)
{
  expect_fluid_symmetric(PERIODIC, PERIODIC);
  expect_fluid_symmetric(RESTING, RESTING);
  expect_fluid_symmetric(RESTING, PERIODIC);
  expect_fluid_symmetric(MOVING, PERIODIC);
}

Test(fluid, is_symmetric_where_moving_walls_meet_walls)
{
  expect_fluid_symmetric(MOVING, RESTING);
  expect_fluid_symmetric(MOVING, MOVING);
}

Test(fluid, is_symmetric_between_an_inlet_and_an_outlet_across_a_periodic_box)
{
  for (int kind = 0; kind < KINDS; kind++)
    if (is_open(kind)) expect_fluid_symmetric(kind, PERIODIC);
}

Test(fluid, is_symmetric_where_inlets_and_outlets_meet_walls)
{
  for (int kind = 0; kind < KINDS; kind++)
    for (int wall = RESTING; wall <= MOVING; wall++)
      if (is_open(kind)) expect_fluid_symmetric(kind, wall);
}

Test(fluid, is_symmetric_where_inlets_and_outlets_meet_each_other)
{
  for (int left = INLET; left <= OUTLET; left++)
    for (int bottom = INLET; bottom <= left; bottom++)
      if (left != SLANTING && bottom != SLANTING) expect_fluid_symmetric(left, bottom);
}

Test(fluid, is_symmetric_where_slanting_inlets_meet_inlets_and_outlets)
{
  for (int kind = INLET; kind <= OUTLET; kind++) expect_fluid_symmetric(SLANTING, kind);
}

/* Each has a resting wall on the other side: every slip side has corners with two kinds. */
Test(fluid, is_symmetric_where_slip_sides_meet_any_side)
{
  for (int kind = 0; kind < KINDS; kind++) expect_fluid_symmetric(SLIP, kind);
}

/* Sides of boxes with discs. */
static const int disc_boxes[][2] = {
    {RESTING, RESTING}, {PERIODIC, RESTING}, {PERIODIC, PERIODIC}, {INLET, PERIODIC}, {PERIODIC, SLIP}};

enum { DISC_BOXES = sizeof disc_boxes / sizeof disc_boxes[0] };

/* Discs of every kind, apart at first; two collide with each other, one with the lower side. */
static struct scene crew(const int sides[2], int variant, enum coupling_solve solve)
{
  struct scene scene = box(40, 35, sides[0], sides[1], variant);
  const bool periodic = sides[1] == PERIODIC;
  scene.coupling.solve = solve;
  if (variant & WITH_FORCE) scene.particles.gravity[0] = 1e-4, scene.particles.gravity[1] = -2e-4;
  struct disc_spec *disc = scene_add_disc(&scene, 3.7, 15, 10.2, 20.3);
  disc->velocity[0] = 0.05, disc->velocity[1] = 0.01, disc->spin = 0.008;
  disc = scene_add_disc(&scene, 3.1, 20, 19.1, 22.4);
  disc->velocity[0] = -0.04, disc->velocity[1] = -0.02, disc->spin = -0.01;
  disc = scene_add_disc(&scene, 2.6, 15, 10.4, periodic ? 1.3 : 4.3);
  disc->velocity[1] = -0.05, disc->spin = 0.01;
  disc = scene_add_disc(&scene, 3.3, 1, 32.4, 9.3);
  disc->motion = DISC_FIXED, disc->spin = -0.01;
  disc = scene_add_disc(&scene, 2.9, 1, 31.3, 27.6);
  disc->motion = DISC_DRIVEN, disc->velocity[0] = -0.03, disc->velocity[1] = 0.02, disc->spin = 0.01;
  if (solve == SOLVE_IMPLICIT) scene_add_disc(&scene, 2.8, 0.3, 20.7, 10.1)->velocity[0] = 0.03;
  return scene;
}

static void expect_crew_symmetric(const int sides[2], enum coupling_solve solve)
{
  char text[160];
  for (int variant = 0; variant < VARIANTS; variant++)
    for (int stirred = 0; stirred < 2; stirred++) {
      if (variant & BLOCKED) continue;
      struct scene scene = crew(sides, variant, solve);
      in_words(text, sides[0], sides[1], variant, stirred ? ", discs in waves" : ", discs in fluid at rest");
      expect_symmetric(&scene, &(struct symmetric_run){stirred ? waves : NULL, DISC_STEPS, text});
      scene_clear(&scene);
    }
}

Test(discs, are_symmetric_with_the_implicit_solve)
{
  for (int k = 0; k < DISC_BOXES; k++) expect_crew_symmetric(disc_boxes[k], SOLVE_IMPLICIT);
}

Test(discs, are_symmetric_with_the_explicit_averaged_solve)
{
  for (int k = 0; k < DISC_BOXES; k++) expect_crew_symmetric(disc_boxes[k], SOLVE_EXPLICIT_AVERAGED);
}

Test(discs, are_symmetric_with_every_form_area_search_and_without_volume_flux)
{
  char what[80];
  for (int k = 0; k < 24; k++) {
    struct scene scene = crew(disc_boxes[k % 2], WITH_FORCE, SOLVE_IMPLICIT);
    scene.coupling.form = k / 2 % FORM_COUNT;
    scene.contact.area = k / 6 % 2 ? AREA_CELLS : AREA_LENS;
    scene.contact.search = k / 6 == 2 ? SEARCH_LINKED_CELL : SEARCH_GRID;
    scene.contact.substeps = k / 6 == 2 ? 3 : 0;
    scene.fluid.zero_flux = k / 6 < 3;
    /* at this damping in one sub-step the impulse is limited by the stored energy */
    if (k / 6 == 0) scene.contact.damping = 40, scene.contact.substeps = 1;
    snprintf(what, sizeof what, "box %d, form %d, area and search %d", k % 2, k / 2 % FORM_COUNT, k / 6);
    expect_symmetric(&scene, &(struct symmetric_run){.steps = DISC_STEPS, .what = what});
    scene_clear(&scene);
  }
}

/* A disc in a corner of a box, whose other rows are swept several steps ahead. */
Test(discs, are_symmetric_where_rows_out_of_their_reach_go_ahead)
{
  char text[160];
  for (int k = 0; k < DISC_BOXES; k++)
    for (int variant = 0; variant < VARIANTS; variant++) {
      if (!(variant & BLOCKED)) continue;
      struct scene scene = box(64, 61, disc_boxes[k][0], disc_boxes[k][1], variant);
      scene.particles.gravity[0] = -1e-4;
      struct disc_spec *disc = scene_add_disc(&scene, 3.7, 2.5, 8.2, 9.3);
      disc->velocity[1] = 0.05, disc->spin = 0.01;
      scene_add_disc(&scene, 3.1, 1, 9.1, 18.4)->motion = DISC_FIXED;
      in_words(text, disc_boxes[k][0], disc_boxes[k][1], variant, ", two discs");
      expect_symmetric(&scene, &(struct symmetric_run){waves, DISC_STEPS, text});
      scene_clear(&scene);
    }
}

/* Fluid in a cell of two discs starts with the mean of their velocities, weighted by the occupation fractions. */
Test(discs, are_symmetric_with_common_cells_at_the_start)
{
  char text[160];
  for (int k = 0; k < DISC_BOXES; k++)
    for (int variant = 0; variant < VARIANTS; variant++) {
      if (variant & BLOCKED) continue;
      struct scene scene = box(40, 37, disc_boxes[k][0], disc_boxes[k][1], variant);
      struct disc_spec *disc = scene_add_disc(&scene, 2, 2, 18.5, 20.5);
      disc->velocity[0] = 0.05, disc->velocity[1] = 0.03, disc->spin = 0.01;
      scene_add_disc(&scene, 2, 2, 21.3, 23.6)->velocity[1] = -0.04;
      in_words(text, disc_boxes[k][0], disc_boxes[k][1], variant, ", discs that share cells");
      expect_symmetric(&scene, &(struct symmetric_run){.steps = DISC_STEPS, .what = text});
      scene_clear(&scene);
    }
}
