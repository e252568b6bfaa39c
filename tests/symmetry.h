/* The eight symmetries of a square, applied to a scene, to its initial flow and, backwards, to what comes of them. The
 * equations of motion have all of them, so that each image of a scene must have the image of its result. */
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

/* The scene turned or reflected: sides, their velocities, forces, discs. Its discs are its own (scene_clear). */
struct scene symmetry_image(const struct scene *scene, const struct symmetry *symmetry);

/* A run to compare: where the flow starts from (NULL: from rest), the steps after which results are compared, and then
 * once more after one step. */
struct symmetric_run {
  flow_initial *initial;
  int64_t steps;
  const char *what; /* named where results differ */
};

/* Runs the scene and its images, and expects of each the scene's density, velocity, vorticity, occupation, and of discs
 * the place, angle, velocity, force and torque, within 1e-12 in double precision and 1e-5 in single precision. Forces and
 * torques are compared as what they change in one step in the velocity and in the rim's speed of the displaced fluid. */
void expect_symmetric(const struct scene *scene, const struct symmetric_run *run);

#endif
