/* The initial state of the fluid. */
#ifndef DELBM_SIM_INITIAL_H
#define DELBM_SIM_INITIAL_H

/* Density, velocity and gradient[a][b] = d velocity[a]/d x_b at the centre of a cell. */
struct flow_state {
  double density, velocity[2], gradient[2][2];
};

typedef struct flow_state flow_initial(const void *context, int x, int y);

#endif
