/* The discs: one array per quantity, indexed by disc. Lattice units; angles counter-clockwise; the reference density of
 * the fluid is 1.
 *
 * A disc has two shapes: `shape`, of radius R, for contacts, mass and buoyancy, and `hydraulic`, of the hydraulic radius
 * R_h = coupling.hydraulic_radius R, for the fluid. The cells of the disc are those of `hydraulic`. Without fluid m_f and
 * I_f are 0, and the buoyant mass is the mass. */
#ifndef DELBM_SOLID_DISCS_H
#define DELBM_SOLID_DISCS_H

#include "base/store.h"
#include "model/scene.h"
#include "solid/shape.h"

/* A force and its torque about the centre of a disc, or their impulse. */
struct wrench {
  double fx, fy, torque;
};

struct discs {
  size_t count;
  struct shape *shape, *hydraulic;
  double *radius;         /* of the shape's smallest circle about its centroid (shape.h) */
  double *mass, *inertia; /* of the solid: density times area, mass times square of the radius of gyration */
  double *fluid_mass, *fluid_inertia; /* m_f and I_f: of the fluid that fills the hydraulic shape */
  double *buoyant_mass;               /* mass less that of the fluid which the shape displaces, pi R^2 */
  uint8_t *motion;                    /* enum disc_motion */
  double *x, *y, *angle;              /* centre (inside the box where it is periodic), rotation since the start */
  double *vx, *vy, *omega;
  double *fx, *fy, *torque;                         /* of the fluid on the solid, last step (exchange.h) */
  double *contact_fx, *contact_fy, *contact_torque; /* of discs and walls on the disc, last step */
  size_t moving;                                    /* number of discs that are not fixed */
  size_t free;                                      /* number of discs that move by the forces on them */
  void *block;                                      /* memory of all arrays */
};

bool discs_create(struct discs *discs, const struct scene *scene, struct status *status);
void discs_destroy(struct discs *discs);

/* Centroid and angle of disc i. */
static inline struct pose discs_pose(const struct discs *discs, size_t i)
{
  return (struct pose){discs->x[i], discs->y[i], discs->angle[i]};
}

/* Saves or restores positions, velocities and the forces of the last step. */
bool discs_store(struct discs *discs, struct store *store, struct status *status);

/* Displacement d along an axis of this size; on a periodic axis the displacement of the nearest image. |d| < 3/2
 * size. */
static inline double nearest_image(double d, double size, bool periodic)
{
  if (!periodic || (d >= -size / 2 && d <= size / 2)) return d;
  return d > 0 ? d - size : d + size;
}

#endif
