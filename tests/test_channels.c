/* Steady flows through channels and in cavities, against published values: longer than the fast suite allows. */
#include "drive.h"
#include "scenes.h"

#include <criterion/criterion.h>
#include <math.h>
#include <stdlib.h>

/* Mean density at the face of the outlet and pressure drop, as a density, after `steps` steps in a channel of resting walls. */
static void channel(int length, int height, double speed, double viscosity, int64_t steps, double *face, double *drop)
{
  struct scene scene = scene_box(length, height, viscosity, SIDES_CLOSED);
  scene.domain.side[SIDE_LEFT] = (struct side){SIDE_INLET, {speed, 0}};
  scene.domain.side[SIDE_RIGHT].type = SIDE_OUTLET;
  struct simulation *simulation = start(&scene);
  double *rho = malloc(sizeof(double) * (size_t)(length * height)),
         *u = malloc(sizeof(double) * (size_t)(length * height));
  advance(simulation, steps);
  simulation_fields(simulation, rho, u, NULL);
  double mean[3] = {0}, flux = 0;
  for (int y = 0; y < height; y++) {
    mean[0] += rho[y * length] / height;
    mean[1] += rho[y * length + length - 2] / height;
    mean[2] += rho[y * length + length - 1] / height;
    flux += rho[y * length + length - 1] * u[y * length + length - 1];
  }
  *face = mean[2] + (mean[2] - mean[1]) / 2;
  *drop = mean[0] - *face;
  cr_expect(fabs(flux / (speed * height) - 1) < 1e-3, "%d x %d: flux out %g of %g", length, height, flux,
            speed * height);
  free(rho);
  free(u);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

Test(outlet, has_the_reference_density_within_1_percent_of_the_pressure_drop_of_channels)
{
  static const int aspects[] = {5, 10, 20};
  static const double reynolds[] = {4, 20, 100};
  enum { HEIGHT = 10 };
  for (int a = 0; a < 3; a++)
    for (int r = 0; r < 3; r++) {
      const double speed = reynolds[r] < 10 ? 0.02 : 0.05, viscosity = speed * HEIGHT / reynolds[r];
      const int length = aspects[a] * HEIGHT;
      double face, drop;
      channel(length, HEIGHT, speed, viscosity, 200 * length, &face, &drop);
      cr_expect(fabs(face - 1) < 0.01 * drop, "L/H %d, Re %g: density %.6f, pressure drop %g", aspects[a], reynolds[r],
                face, drop);
    }
}

/* Lowest velocity along x on the vertical line through the middle of a lid-driven cavity of n x n cells, over the lid's. */
static double cavity_minimum(int n, double reynolds, int64_t steps)
{
  const double speed = 0.1;
  struct scene scene = scene_box(n, n, speed * n / reynolds, SIDES_CLOSED);
  scene.domain.side[SIDE_TOP].velocity[0] = speed;
  struct simulation *simulation = start(&scene);
  double *u = malloc(sizeof(double) * (size_t)(n * n)), *line = calloc((size_t)n, sizeof *line);
  advance(simulation, steps);
  simulation_fields(simulation, NULL, u, NULL);
  int low = 1;
  for (int y = 0; y < n; y++) line[y] = (u[y * n + n / 2 - 1] + u[y * n + n / 2]) / 2 / speed;
  for (int y = 1; y < n - 1; y++)
    if (line[y] < line[low]) low = y;
  const double slope = (line[low + 1] - line[low - 1]) / 2, bend = line[low + 1] - 2 * line[low] + line[low - 1];
  const double minimum = line[low] - slope * slope / (2 * bend);
  free(u);
  free(line);
  simulation_destroy(simulation);
  scene_clear(&scene);
  return minimum;
}

/* Converged values: Botella & Peyret 1998, and at Re 100 an independent computation. */
Test(cavity, has_the_published_lowest_velocity_within_0_3_percent)
{
  static const struct {
    int n, steps;
    double reynolds, expected;
  } cavities[] = {{64, 15000, 100, -0.21404}, {128, 30000, 100, -0.21404}, {128, 80000, 1000, -0.38857}};
  for (int k = 0; k < 3; k++) {
    const double minimum = cavity_minimum(cavities[k].n, cavities[k].reynolds, cavities[k].steps);
    cr_expect(fabs(minimum / cavities[k].expected - 1) < 0.003, "%d cells, Re %g: %g, expected %g", cavities[k].n,
              cavities[k].reynolds, minimum, cavities[k].expected);
  }
}
