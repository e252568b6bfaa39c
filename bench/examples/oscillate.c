/* A disc oscillates in fluid at rest, driven by a callback that also notes the force that the fluid exerts on it.
 *
 *   cc oscillate.c $(pkg-config --cflags --libs delbm) -lm && ./a.out
 *
 * For a small amplitude Stokes (1851) gives the force as -m w U (k cos wt + k' sin wt) for the velocity U sin wt, m being
 * the mass of the fluid displaced: k is the added mass, k' the drag. With b = pi D^2/(nu T), Wang (1968):
 *   k  = 1 + 4/sqrt(b) + b^(-3/2),   k' = 4/sqrt(b) + 4/b - b^(-3/2). */
#include <delbm/delbm.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846, radius = 6, viscosity = 0.02, amplitude = 0.002;

enum { SIZE = 160, PERIOD = 2400, PERIODS = 3 };

/* Fourier sums of the force over the last period. */
struct response {
  double in_phase, out_of_phase;
};

static double velocity_after(double steps)
{
  return amplitude * sin(2 * pi / PERIOD * steps);
}

/* Called before each step: `now` has the force of the step before, which ended at time `step`. */
static void drive(void *context, int64_t step, const struct delbm_disc_state *now, double velocity[2], double *spin)
{
  struct response *response = context;
  if (step > (PERIODS - 1) * PERIOD) {
    const double phase = 2 * pi / PERIOD * ((double)step - 0.5); /* the middle of that step */
    response->in_phase += now->force[0] * sin(phase) * 2 / PERIOD;
    response->out_of_phase += now->force[0] * cos(phase) * 2 / PERIOD;
  }
  velocity[0] = velocity_after((double)step + 1);
  velocity[1] = 0;
  *spin = 0;
}

/* Steps once more than PERIODS, so that the force of the last step is noted too. */
static enum delbm_code run(struct response *response, struct delbm_status *status)
{
  const struct delbm_disc disc = {.radius = radius, .position = {SIZE / 2.0, SIZE / 2.0}, .motion = DELBM_DRIVEN};
  const struct delbm_scene scene = {.size = {SIZE, SIZE}, .viscosity = viscosity, .discs = &disc, .disc_count = 1};
  struct delbm_simulation *simulation;
  enum delbm_code code = delbm_open_scene(&simulation, &scene, NULL, 0, status);
  if (code == DELBM_OK) code = delbm_drive(simulation, 0, drive, response, status);
  if (code == DELBM_OK) code = delbm_step(simulation, PERIODS * PERIOD + 1, status);
  delbm_close(simulation);
  return code;
}

int main(void)
{
  struct response response = {0, 0};
  struct delbm_status status;
  if (run(&response, &status) != DELBM_OK) {
    fprintf(stderr, "%s\n", status.message);
    return status.code;
  }
  const double unit = pi * radius * radius * amplitude * 2 * pi / PERIOD;
  const double b = pi * 4 * radius * radius / (viscosity * PERIOD);
  const double added_mass = 1 + 4 / sqrt(b) + pow(b, -1.5), drag = 4 / sqrt(b) + 4 / b - pow(b, -1.5);
  printf("added mass %.4f, by Stokes %.4f\n", -response.out_of_phase / unit, added_mass);
  printf("drag       %.4f, by Stokes %.4f\n", -response.in_phase / unit, drag);
  return EXIT_SUCCESS;
}
