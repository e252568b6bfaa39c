/* The drag of a square array of cylinders at solid fraction 0.2 (Sangani & Acrivos 1982: K = F/(mu U) = 51.53), for
 * every form of the coupling and choice of rates, over viscosity. */
#include "bench.h"
#include "scenes.h"
#include "sim/simulation.h"

#include <math.h>
#include <stdlib.h>

static const double exact = 51.52695; /* at 0.2, converged series */

static const struct choice {
  const char *name;
  enum coupling_form form;
  bool magic;
} choices[] = {{"unified, s_q 1.2", FORM_UNIFIED, false},
               {"unified, magic 3/16", FORM_UNIFIED, true},
               {"owen, s_q 1.2", FORM_OWEN, false},
               {"owen, magic 3/16", FORM_OWEN, true}};

static double mean(const double *values, size_t count)
{
  double sum = 0;
  for (size_t k = 0; k < count; k++) sum += values[k];
  return sum / (double)count;
}

/* Runs until the drag changes by less than 1e-7 over 200 steps. */
static bool steady_drag(const struct scene *scene, double *drag, struct status *status)
{
  const size_t cells = (size_t)scene->domain.size[0] * (size_t)scene->domain.size[1];
  struct simulation *simulation = NULL;
  double *ux = malloc(cells * sizeof *ux), before = 0;
  bool ok = ux && simulation_create(&simulation, scene, status);
  *drag = 1;
  while (ok && fabs(*drag - before) > 1e-7 * fabs(*drag)) {
    before = *drag;
    ok = simulation_advance(simulation, 200, status);
    if (!ok) break;
    simulation_fields(simulation, NULL, ux, NULL);
    *drag = scene->fluid.force[0] * (double)cells / (scene->fluid.viscosity * mean(ux, cells));
  }
  simulation_destroy(simulation);
  free(ux);
  return ok;
}

bool bench_drag(const struct bench_report *report, struct status *status)
{
  static const double viscosities[] = {0.005, 0.05, 1.0 / 6};
  printf("drag of a square array, solid fraction 0.2, K = F/(mu U); exact %.2f\n", exact);
  printf("%-22s %4s %9s %9s %9s\n", "form and rates", "R", "nu 0.005", "0.05", "0.1667");
  for (int radius = 5; radius <= (report->quick ? 5 : 10); radius += 5)
    for (size_t c = 0; c < sizeof choices / sizeof choices[0]; c++) {
      printf("%-22s %4d", choices[c].name, radius);
      if (report->json)
        fprintf(report->json, "%s\"%s, R = %d\": [", c || radius > 5 ? ", " : "", choices[c].name, radius);
      for (int v = 0; v < 3; v++) {
        struct scene scene = scene_square_array(radius, 0.2, viscosities[v], 1e-6 * viscosities[v]);
        scene.coupling.form = choices[c].form;
        if (choices[c].magic) scene_use_magic(&scene);
        double drag = NAN;
        const bool ok = steady_drag(&scene, &drag, status);
        scene_clear(&scene);
        if (!ok && status->code != DELBM_FAILED) return false;
        if (ok)
          printf(" %9.2f", drag);
        else
          printf(" %9s", "diverged");
        if (report->json)
          ok ? fprintf(report->json, "%s%.17g", v ? ", " : "", drag) : fprintf(report->json, "%snull", v ? ", " : "");
      }
      printf("\n");
      fflush(stdout);
      if (report->json) fprintf(report->json, "]");
    }
  return true;
}
