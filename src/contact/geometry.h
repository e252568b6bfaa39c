/* Geometry and kinematics of a contact of two discs a and b, or of disc a and a side of the box. Overlap, normal n (from a to b) and arms
 * a_a, a_b of the contact point come from the shapes; a_a + a_b is the distance of the centroids. With t = (-n_y, n_x),
 *   approach speed = (V_a - V_b) . n,   slip speed = (V_a - V_b) . t + omega_a a_a + omega_b a_b. */
#ifndef DELBM_CONTACT_GEOMETRY_H
#define DELBM_CONTACT_GEOMETRY_H

#include "contact/state.h"
#include "coupling/exchange.h"

/* Positions, velocities and spins: [disc]. */
struct disc_motions {
  double *x, *y, *vx, *vy, *omega;
};

struct kinematics {
  struct body_overlap overlap; /* of the shapes: n, arms, area (solid/shape.h) */
  double radius[2];            /* of b: infinite for a side */
  double approach_speed;       /* (V_a - V_b) . n */
  double
      slip_speed; /* (V_a - V_b) . t + omega_a a_a + omega_b a_b, t = (-n_y, n_x): of the surface of a past that of b */
  double mean_speed; /* of approach over the sub-step, without contacts */
  double compliance; /* speed of parting per impulse along n, the fluid that moves with the discs included */
  double damping;    /* eta (law.h) */
};

static inline bool contact_is_with_side(uint32_t b)
{
  return b >= contact_sides;
}

/* All but the response and the damping. */
struct kinematics kinematics_of(const struct scene *scene, const struct discs *discs, uint32_t a, uint32_t b,
                                const struct disc_motions *at);

/* Adds the response of the discs (exchange.h) over a sub-step of length h: mean_speed and compliance. */
void kinematics_respond(struct kinematics *kinematics, const struct exchange *exchange, uint32_t a, uint32_t b,
                        double h);

#endif
