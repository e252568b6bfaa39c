/* The eight symmetries of a square, applied to a scene and its initial flow; the inverse is applied to the result.
 * The equations of motion have all eight symmetries, so that the result of an image must be the image of the result. */
#ifndef DELBM_TESTS_SYMMETRY_H
#define DELBM_TESTS_SYMMETRY_H

#include "model/scene.h"
#include "sim/initial.h"

/* A turn or a reflection, as the matrix that acts on displacements from the middle of the box. */
struct symmetry {
  const char *name;
  int matrix[2][2];
};

enum { SYMMETRIES = 8 };

/* The first is the identity. */
extern const struct symmetry symmetries[SYMMETRIES];

/* The scene turned or reflected: sides, their velocities, forces, discs. The result owns its discs (scene_clear). */
struct scene symmetry_image(const struct scene *scene, const struct symmetry *symmetry);

/* A run to compare: initial flow (NULL: rest); results are compared after `steps` steps and after one more. */
struct symmetric_run {
  flow_initial *initial;
  int64_t steps;
  const char *what; /* name in messages */
};

/* Runs the scene and its images, and expects of each the scene's density, velocity, vorticity, occupation, and of
 * discs the place, angle, velocity, force and torque, within 1e-12 in double precision and 1e-5 in single precision.
 * Forces and torques are compared as the changes, in one step, of velocity and rim speed of the fluid that fills a disc. */
void expect_symmetric(const struct scene *scene, const struct symmetric_run *run);

#endif
