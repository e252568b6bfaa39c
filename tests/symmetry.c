#include "symmetry.h"

#include "drive.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const struct symmetry symmetries[SYMMETRIES] = {
    {"as it is", {{1, 0}, {0, 1}}},
    {"turned by 90 degrees", {{0, -1}, {1, 0}}},
    {"turned by 180 degrees", {{-1, 0}, {0, -1}}},
    {"turned by 270 degrees", {{0, 1}, {-1, 0}}},
    {"mirrored in x", {{-1, 0}, {0, 1}}},
    {"mirrored in y", {{1, 0}, {0, -1}}},
    {"mirrored in the rising diagonal", {{0, 1}, {1, 0}}},
    {"mirrored in the falling diagonal", {{0, -1}, {-1, 0}}},
};

/* Sense of rotation: 1 for turns, -1 for reflections. */
static int sense(const struct symmetry *s)
{
  return s->matrix[0][0] * s->matrix[1][1] - s->matrix[0][1] * s->matrix[1][0];
}

static void apply(const struct symmetry *s, double vector[2])
{
  const double x = vector[0], y = vector[1];
  for (int axis = 0; axis < 2; axis++) vector[axis] = s->matrix[axis][0] * x + s->matrix[axis][1] * y;
}

/* The inverse of a turn or a reflection is its transpose. */
static void apply_inverse(const struct symmetry *s, double vector[2])
{
  const double x = vector[0], y = vector[1];
  for (int axis = 0; axis < 2; axis++) vector[axis] = s->matrix[0][axis] * x + s->matrix[1][axis] * y;
}

static bool swaps_axes(const struct symmetry *s)
{
  return s->matrix[0][0] == 0;
}

/* Maps a position in a box of this size to the image. */
static void place(const struct symmetry *s, const int size[2], double at[2])
{
  for (int axis = 0; axis < 2; axis++) at[axis] -= size[axis] / 2.0;
  apply(s, at);
  for (int axis = 0; axis < 2; axis++) at[axis] += size[swaps_axes(s) ? 1 - axis : axis] / 2.0;
}

/* Maps a position in the image back to a box of this size. */
static void place_back(const struct symmetry *s, const int size[2], double at[2])
{
  for (int axis = 0; axis < 2; axis++) at[axis] -= size[swaps_axes(s) ? 1 - axis : axis] / 2.0;
  apply_inverse(s, at);
  for (int axis = 0; axis < 2; axis++) at[axis] += size[axis] / 2.0;
}

static enum side_name image_of_side(const struct symmetry *s, enum side_name name)
{
  static const double outward[SIDE_COUNT][2] = {
      [SIDE_LEFT] = {-1, 0}, [SIDE_RIGHT] = {1, 0}, [SIDE_BOTTOM] = {0, -1}, [SIDE_TOP] = {0, 1}};
  double normal[2] = {outward[name][0], outward[name][1]};
  enum side_name image = SIDE_LEFT;
  apply(s, normal);
  while (outward[image][0] != normal[0] || outward[image][1] != normal[1]) image++;
  return image;
}

struct scene symmetry_image(const struct scene *scene, const struct symmetry *s)
{
  struct scene image = *scene;
  const int *size = scene->domain.size;
  const size_t bytes = scene->particles.count * sizeof *scene->particles.discs;
  for (int axis = 0; axis < 2; axis++) image.domain.size[axis] = size[swaps_axes(s) ? 1 - axis : axis];
  for (enum side_name name = SIDE_LEFT; name < SIDE_COUNT; name++) {
    struct side *to = &image.domain.side[image_of_side(s, name)];
    *to = scene->domain.side[name];
    apply(s, to->velocity);
  }
  image.title = image.name = NULL;
  image.fluid.kernel = scene->fluid.kernel ? strdup(scene->fluid.kernel) : NULL;
  apply(s, image.fluid.force);
  apply(s, image.particles.gravity);
  image.particles.discs = bytes > 0 ? malloc(bytes) : NULL;
  if (bytes > 0) memcpy(image.particles.discs, scene->particles.discs, bytes);
  for (size_t i = 0; i < image.particles.count; i++) {
    struct disc_spec *disc = &image.particles.discs[i];
    place(s, size, disc->position);
    apply(s, disc->velocity);
    disc->spin *= sense(s);
    disc->angle *= sense(s);
  }
  return image;
}

/* The initial flow of an image: the scene's flow, turned or reflected. */
struct image_of_flow {
  const struct symmetry *symmetry;
  const int *size; /* of the scene's box */
  flow_initial *initial;
};

static struct flow_state initial_of_image(const void *context, int x, int y)
{
  const struct image_of_flow *flow = context;
  const struct symmetry *s = flow->symmetry;
  double at[2] = {x + 0.5, y + 0.5};
  place_back(s, flow->size, at);
  const struct flow_state from = flow->initial(NULL, (int)floor(at[0]), (int)floor(at[1]));
  struct flow_state state = from;
  apply(s, state.velocity);
  for (int a = 0; a < 2; a++)
    for (int b = 0; b < 2; b++) {
      state.gradient[a][b] = 0;
      for (int c = 0; c < 2; c++)
        for (int d = 0; d < 2; d++) state.gradient[a][b] += s->matrix[a][c] * s->matrix[b][d] * from.gradient[c][d];
    }
  return state;
}

/* Values compared in each cell, and of each disc. */
enum { RHO, UX, UY, VORTICITY, OCCUPATION, CELL_VALUES };
enum { X, Y, ANGLE, VX, VY, RIM, FX, FY, TORQUE, CONTACT_FX, CONTACT_FY, CONTACT_TORQUE, DISC_VALUES };

static const char *const cell_names[CELL_VALUES] = {"density", "ux", "uy", "vorticity", "occupation"};
static const char *const disc_names[DISC_VALUES] = {"x",  "y",  "angle",  "vx",         "vy",         "spin",
                                                    "fx", "fy", "torque", "contact fx", "contact fy", "contact torque"};

/* A state in the coordinates of the scene. */
struct result {
  size_t cells, discs;
  double (*cell)[CELL_VALUES];
  double (*disc)[DISC_VALUES];
};

static struct result allocate_result(const struct scene *scene)
{
  struct result r = {.cells = (size_t)scene_cells(scene), .discs = scene->particles.count};
  r.cell = calloc(r.cells, sizeof *r.cell);
  r.disc = calloc(r.discs + 1, sizeof *r.disc);
  return r;
}

static void free_result(struct result *r)
{
  free(r->cell);
  free(r->disc);
}

/* Cell values of an image in coordinates of the scene; size: of the scene's box. */
static void cells_back(struct simulation *simulation, const struct symmetry *s, const int size[2], struct result *r)
{
  const int nx = simulation_scene(simulation)->domain.size[0], ny = simulation_scene(simulation)->domain.size[1];
  double *fields = calloc(CELL_VALUES * r->cells, sizeof *fields), *values[CELL_VALUES];
  struct status status;
  for (int k = 0; k < CELL_VALUES; k++) values[k] = fields + (size_t)k * r->cells;
  simulation_fields(simulation, values[RHO], values[UX], values[UY]);
  const struct sample_grid grid = {.count = {nx, ny}, .stride = 1};
  const struct sample sample = {.vorticity = values[VORTICITY], .occupation = values[OCCUPATION]};
  cr_assert(simulation_sample(simulation, &grid, &sample, &status), "%s", status.message);
  for (size_t k = 0; k < r->cells; k++) {
    double at[2] = {(double)(k % (size_t)nx) + 0.5, (double)(k / (size_t)nx) + 0.5};
    place_back(s, size, at);
    double *cell = r->cell[(size_t)floor(at[1]) * (size_t)size[0] + (size_t)floor(at[0])];
    for (int v = 0; v < CELL_VALUES; v++) cell[v] = values[v][k];
    apply_inverse(s, &cell[UX]);
    cell[VORTICITY] *= sense(s);
  }
  free(fields);
}

static void discs_back(const struct simulation *simulation, const struct symmetry *s, const int size[2],
                       struct result *r)
{
  const struct discs *d = simulation_discs(simulation);
  for (size_t i = 0; i < r->discs; i++) {
    const double per_mass = 1 / d->fluid_mass[i], per_inertia = d->radius[i] / d->fluid_inertia[i];
    const double values[DISC_VALUES] = {d->x[i],
                                        d->y[i],
                                        d->angle[i] * sense(s),
                                        d->vx[i],
                                        d->vy[i],
                                        d->omega[i] * d->radius[i] * sense(s),
                                        d->fx[i] * per_mass,
                                        d->fy[i] * per_mass,
                                        d->torque[i] * per_inertia * sense(s),
                                        d->contact_fx[i] * per_mass,
                                        d->contact_fy[i] * per_mass,
                                        d->contact_torque[i] * per_inertia * sense(s)};
    memcpy(r->disc[i], values, sizeof values);
    place_back(s, size, &r->disc[i][X]);
    apply_inverse(s, &r->disc[i][VX]);
    apply_inverse(s, &r->disc[i][FX]);
    apply_inverse(s, &r->disc[i][CONTACT_FX]);
  }
}

/* The largest difference of a result from its expected value, and its position. */
struct difference {
  double size;
  const char *quantity;
  size_t where;
  bool of_disc;
};

static void note(struct difference *largest, double difference, struct difference here)
{
  here.size = fabs(difference);
  if (!(here.size <= largest->size)) *largest = here; /* also NAN */
}

static struct difference compare(const struct scene *scene, const struct result *a, const struct result *b)
{
  struct difference largest = {.quantity = "nothing"};
  for (size_t k = 0; k < a->cells; k++)
    for (int v = 0; v < CELL_VALUES; v++)
      note(&largest, a->cell[k][v] - b->cell[k][v], (struct difference){.quantity = cell_names[v], .where = k});
  for (size_t i = 0; i < a->discs; i++)
    for (int v = 0; v < DISC_VALUES; v++) {
      double difference = a->disc[i][v] - b->disc[i][v];
      if (v == X || v == Y)
        difference = nearest_image(difference, scene->domain.size[v - X], scene_is_periodic(scene, v - X));
      note(&largest, difference, (struct difference){.quantity = disc_names[v], .where = i, .of_disc = true});
    }
  return largest;
}

/* The states of an image after run->steps steps and after one more. */
static void run_image(const struct scene *scene, const struct symmetry *s, const struct symmetric_run *run,
                      struct result results[2])
{
  struct scene image = symmetry_image(scene, s);
  struct simulation *simulation = start(&image);
  const struct image_of_flow flow = {s, scene->domain.size, run->initial};
  if (run->initial) simulation_start(simulation, initial_of_image, &flow);
  for (int k = 0; k < 2; k++) {
    advance(simulation, k == 0 ? run->steps : 1);
    results[k] = allocate_result(scene);
    cells_back(simulation, s, scene->domain.size, &results[k]);
    discs_back(simulation, s, scene->domain.size, &results[k]);
  }
  simulation_destroy(simulation);
  scene_clear(&image);
}

void expect_symmetric(const struct scene *scene, const struct symmetric_run *run)
{
  const double allowed = scene->fluid.precision == PRECISION_SINGLE ? 1e-5 : 1e-12;
  struct result expected[2], obtained[2];
  struct difference worst = {.quantity = "nothing"};
  size_t image = 0;
  int later = 0;
  run_image(scene, &symmetries[0], run, expected);
  for (size_t s = 1; s < SYMMETRIES; s++) {
    run_image(scene, &symmetries[s], run, obtained);
    for (int k = 0; k < 2; k++) {
      const struct difference here = compare(scene, &expected[k], &obtained[k]);
      if (!(here.size <= worst.size)) worst = here, image = s, later = k;
      free_result(&obtained[k]);
    }
  }
  for (int k = 0; k < 2; k++) free_result(&expected[k]);
  const size_t nx = (size_t)scene->domain.size[0], x = worst.of_disc ? 0 : worst.where % nx;
  cr_expect(worst.size <= allowed, "%s, %s: after %lld steps %s of %s %zu (x = %zu, y = %zu) differs by %.3g",
            run->what, symmetries[image].name, (long long)run->steps + later, worst.quantity,
            worst.of_disc ? "disc" : "cell", worst.where, x, worst.of_disc ? 0 : worst.where / nx, worst.size);
}
