/* The state that the fluid starts from. */
#ifndef DELBM_SIM_INITIAL_H
#define DELBM_SIM_INITIAL_H

/* Density, velocity and gradient[a][b] = d velocity[a]/d x_b in the middle of a cell. */
struct flow_state {
  double density, velocity[2], gradient[2][2];
};

typedef struct flow_state flow_initial(const void *context, int x, int y);

#endif
