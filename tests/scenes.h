/* Scenes built in code, for tests and benchmarks. */
#ifndef DELBM_TESTS_SCENES_H
#define DELBM_TESTS_SCENES_H

#include "model/scene.h"

enum sides { SIDES_PERIODIC, SIDES_CLOSED };

/* A box of fluid at rest with the program's defaults, with no discs and no forces. */
struct scene scene_box(int nx, int ny, double viscosity, enum sides sides);

/* The paper's rates: s_e = 1.4, s_q = 1.2. */
void scene_use_paper_rates(struct scene *scene);

/* s_e = 1.4 and s_q from the magic parameter 3/16. */
void scene_use_magic(struct scene *scene);

/* The default: s_q from 1/12 in slow fluid, 1.2 in fast. */
void scene_use_adaptive(struct scene *scene);

/* Adds a free disc at rest; returns it for further settings, valid until the next one is added. */
struct disc_spec *scene_add_disc(struct scene *scene, double radius, double density, double x, double y);

/* A closed box full of discs on a jittered grid, settling as in the paper's Fig. 12: nu 0.05, density 1.01. */
struct scene scene_crowd(int nx, int ny, double radius, double spacing, double jitter);

/* Removes the fluid: dry discs, searched in linked cells. */
void scene_dry(struct scene *scene);

/* One fixed disc in a periodic square cell, driven by a body force: the square array of cylinders. The solid
 * fraction is exact, the radius approximate. */
struct scene scene_square_array(double radius, double solid_fraction, double viscosity, double force);

#endif
