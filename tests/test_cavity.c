/* Lid-driven cavities against published values: longer than the fast suite allows. */
#include "drive.h"
#include "scenes.h"

#include <criterion/criterion.h>
#include <math.h>
#include <stdlib.h>

/* Lowest velocity along x on the vertical line through the middle of a lid-driven cavity of n x n cells, over the
 * lid's. */
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
