/* Two discs in unbounded Stokes flow: forces and torques, by collocation. Slow; the reference of the lubrication
 * model (src/contact/lubrication.h). */
#ifndef DELBM_BENCH_TWO_DISCS_H
#define DELBM_BENCH_TWO_DISCS_H

#include <stdbool.h>

/* Motion of two discs relative to each other: n from a to b, t is n turned by +90 degrees. */
struct two_discs {
  double radius[2], gap;
  double approach, slide; /* (V_a - V_b) . n and . t */
  double spin[2];
};

/* Per viscosity, on disc a and by disc a on the fluid: force along n and t (on b the opposite: the pair as a whole is free
 * of force), and the torques of both discs on the fluid. False if memory runs out. */
struct two_discs_force {
  double normal, tangential, torque[2];
};
bool two_discs_force(const struct two_discs *discs, struct two_discs_force *force);

#endif
