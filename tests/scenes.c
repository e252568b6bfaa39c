#include "scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void use_mrt(struct scene *scene, double q)
{
  scene->fluid.collision = COLLISION_MRT;
  scene->fluid.rates = (struct rates){.s_nu = rate_from_viscosity(scene->fluid.viscosity), .s_e = 1.4, .s_q = q};
}

void scene_use_paper_rates(struct scene *scene)
{
  use_mrt(scene, 1.2);
}

void scene_use_magic(struct scene *scene)
{
  use_mrt(scene, rate_from_magic(3.0 / 16, scene->fluid.viscosity));
}

void scene_use_adaptive(struct scene *scene)
{
  use_mrt(scene, rate_from_magic(1.0 / 12, scene->fluid.viscosity));
  scene->fluid.collision = COLLISION_ADAPTIVE;
  if (scene->fluid.rates.s_q < 1.2) scene->fluid.rates.s_q_fast = 1.2;
}

struct scene scene_box(int nx, int ny, double viscosity, enum sides sides)
{
  struct scene scene = {0};
  scene.domain.size[0] = nx;
  scene.domain.size[1] = ny;
  for (int k = 0; k < SIDE_COUNT; k++) scene.domain.side[k].type = sides == SIDES_PERIODIC ? SIDE_PERIODIC : SIDE_WALL;
  scene.fluid.viscosity = viscosity;
  scene_use_adaptive(&scene);
  scene.coupling.form = FORM_MIDPOINT;
  scene.coupling.hydraulic_radius = 1;
  scene.contact.stiffness = 0.25;
  scene.contact.overlap = 0.01;
  scene.contact.alpha = 0.3;
  scene.contact.tangential_ratio = 0.8;
  scene.contact.lubrication.least_gap = 0.01;
  scene.contact.damping = 0.34;
  scene.contact.steps_per_contact = 20;
  scene.run.check = 50;
  return scene;
}

struct disc_spec *scene_add_disc(struct scene *scene, double radius, double density, double x, double y)
{
  const size_t count = scene->particles.count + 1;
  struct disc_spec *discs = realloc(scene->particles.discs, count * sizeof *discs);
  if (!discs) abort();
  scene->particles.discs = discs;
  scene->particles.count = scene->particles.listed = count;
  discs[count - 1] = (struct disc_spec){.radius = radius, .density = density, .position = {x, y}};
  return &discs[count - 1];
}

struct scene scene_square_array(double radius, double solid_fraction, double viscosity, double force)
{
  /* a whole number of cells; the radius is adapted to the exact fraction */
  const int size = (int)lround(sqrt(M_PI * radius * radius / solid_fraction));
  struct scene scene = scene_box(size, size, viscosity, SIDES_PERIODIC);
  scene.fluid.force[0] = force;
  scene_add_disc(&scene, size * sqrt(solid_fraction / M_PI), 1, size / 2.0, size / 2.0)->motion = DISC_FIXED;
  return scene;
}

void scene_dry(struct scene *scene)
{
  memset(&scene->fluid, 0, sizeof scene->fluid);
  scene->fluid.none = true;
  scene->contact.search = SEARCH_LINKED_CELL;
}

struct scene scene_crowd(int nx, int ny, double radius, double spacing, double jitter)
{
  struct scene scene = scene_box(nx, ny, 0.05, SIDES_CLOSED);
  struct status status;
  scene.particles.gravity[1] = -0.024525;
  scene.fluid.zero_flux = true;
  scene.particles.fill = (struct fill_spec){.present = true,
                                            .spacing = spacing,
                                            .radius = radius,
                                            .density = 1.01,
                                            .jitter = jitter,
                                            .region = {0, 0, nx, ny},
                                            .seed = 1};
  if (!scene_fill(&scene, &status)) abort();
  return scene;
}
