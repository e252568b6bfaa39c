/* Geometry and kinematics of a contact between bodies a and b, or between body a and a side. Overlap, normal n (from a to
 * b), arms a and offsets o of the contact point come from the shapes (solid/shape.h); t = (-n_y, n_x). With the velocities of
 * the contact point on both bodies,
 *   approach speed = (V_a - V_b) . n - omega_a o_a + omega_b o_b,
 *   slip speed     = (V_a - V_b) . t + omega_a a_a + omega_b a_b. */
#ifndef DELBM_CONTACT_GEOMETRY_H
#define DELBM_CONTACT_GEOMETRY_H

#include "contact/state.h"
#include "coupling/exchange.h"

/* [disc] */
struct disc_motions {
  double *x, *y, *angle, *vx, *vy, *omega;
};

struct kinematics {
  struct body_overlap overlap;
  double approach_speed, slip_speed;
  double mean_speed; /* w: mean approach speed over the sub-step without contacts */
  double compliance; /* c: separation speed per impulse along n, with the inertia of the coupled fluid */
  double damping;    /* eta (law.h) */
};

static inline bool contact_is_with_side(uint32_t b)
{
  return b >= contact_sides;
}

/* Sets overlap, approach_speed and slip_speed. */
struct kinematics kinematics_of(const struct scene *scene, const struct discs *discs, uint32_t a, uint32_t b,
                                const struct disc_motions *at);

/* Sets mean_speed and compliance, from the response of the discs (exchange.h) over a sub-step of length h. */
void kinematics_respond(struct kinematics *kinematics, const struct exchange *exchange, uint32_t a, uint32_t b,
                        double h);

#endif
