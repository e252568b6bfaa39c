/* A scene described in code, in place of a case file. Lattice units: lengths in cells, time in steps, the density of
 * the fluid at rest is 1. All zero is the default of everything but size and viscosity. A scene is checked like a
 * case file; other settings (contacts, coupling, precision) are made by the keys of case files (`settings` in
 * delbm.h). The setting "fluid=none" makes a scene of dry discs, without viscosity and force. */
#ifndef DELBM_SCENE_H
#define DELBM_SCENE_H

#include <stddef.h>

/* A side of the box. Velocity of a wall along itself, or of the fluid at an inlet; cells/step. */
enum delbm_side_type { DELBM_WALL, DELBM_PERIODIC, DELBM_INLET, DELBM_OUTLET, DELBM_SLIP };
struct delbm_side {
  enum delbm_side_type type;
  double velocity[2];
};

enum delbm_motion {
  DELBM_FREE,  /* moves by the forces on it */
  DELBM_FIXED, /* at a constant position; may spin */
  DELBM_DRIVEN /* at prescribed velocity and spin, constant or set by a callback (delbm_drive) */
};

struct delbm_disc {
  double radius;      /* cells */
  double density;     /* relative to the fluid; required for a free disc */
  double position[2]; /* centre, cells from the lower left corner of the box */
  double velocity[2]; /* cells/step */
  double angle;       /* radians, counter-clockwise */
  double spin;        /* radians/step, counter-clockwise */
  enum delbm_motion motion;
};

struct delbm_scene {
  int size[2]; /* cells, x then y */
  struct delbm_side left, right, bottom, top;
  double viscosity;  /* cells^2/step */
  double force[2];   /* on the fluid, per unit mass: cells/step^2 */
  double gravity[2]; /* on discs, with buoyancy: cells/step^2 */
  const struct delbm_disc *discs;
  size_t disc_count;
};

#endif
