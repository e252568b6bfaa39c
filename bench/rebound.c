/* How far does a disc rebound from a wall in viscous fluid, with and without sub-grid lubrication? A disc of R = 10 that
 * moves towards the wall is let go at a gap of 6 cells. The contact is stiff, an overlap of 1 % of R, with a restitution of
 * 0.97 without fluid. */
#include "rebound.h"

#include "bench.h"
#include "scenes.h"
#include "sim/simulation.h"

#include <math.h>

static const double radius = 10, speed = 0.02, dry_restitution = 0.97;

static struct scene impact(const struct rebound *r)
{
  struct scene scene = scene_box(160, 100, r->viscosity, SIDES_CLOSED);
  scene.domain.side[SIDE_LEFT].type = scene.domain.side[SIDE_RIGHT].type = SIDE_PERIODIC;
  struct disc_spec *disc = scene_add_disc(&scene, radius, r->density, 80.25, radius + 6);
  disc->velocity[1] = -speed;
  scene.contact.restitution = dry_restitution;
  scene.contact.lubrication.cutoff = r->cutoff;
  /* energy at an overlap of 1 % of R, alpha k_n (8/15) sqrt(2 R) overlap^(5/2), equal to that of the impact */
  const double mass = r->density * M_PI * radius * radius;
  scene.contact.stiffness =
      0.5 * mass * speed * speed / (scene.contact.alpha * 8.0 / 15 * sqrt(2 * radius) * pow(0.01 * radius, 2.5));
  return scene;
}

bool rebound_run(struct rebound *r, struct status *status)
{
  const double far = 0.2 * radius;
  struct scene scene = impact(r);
  struct simulation *simulation = NULL;
  bool ok = simulation_create(&simulation, &scene, status), arrives = false, returns = false;
  double before = 0, after = 0;
  for (int step = 0; ok && !returns && step < 4000; step++) {
    ok = simulation_advance(simulation, 1, status);
    const struct discs *d = simulation_discs(simulation);
    const double gap = d->y[0] - radius, v = d->vy[0];
    if (!arrives && gap < far) arrives = true, before = -v;
    returns = arrives && gap > far && v > 0;
    if (returns) after = v;
  }
  r->stokes = r->density / 9 * 2 * radius * before / r->viscosity;
  r->restitution = arrives ? after / before : 0;
  simulation_destroy(simulation);
  scene_clear(&scene);
  return ok;
}

static const struct fluid {
  double density, viscosity;
} fluids[] = {{80, 0.005}, {80, 0.01}, {80, 0.02}, {80, 0.03}, {80, 0.05}, {80, 0.08},
              {80, 0.12},  {80, 0.2},  {8, 0.005}, {8, 0.01},  {8, 0.02}};

/* From the exact force of approach alone, constant below the least gap of 0.01 R: each way takes the impulse F/v times the way, so
 * that with v_1 of them per mass e = e_dry (1 - v_1/v) - v_1/v. */
static double rebound_of_film(double stokes)
{
  const double least = 0.01, steps = 10000, part = log(0.2 / least) / steps;
  double work = 0; /* over viscosity and R */
  for (int k = 0; k < (int)steps; k++) {
    const double gap = least * exp((k + 0.5) * part), s = acosh(1 + gap);
    work += 4 * M_PI / (s - tanh(s)) * gap * part;
  }
  const double s = acosh(1 + least);
  const double loss = (work + 4 * M_PI / (s - tanh(s)) * least) * 2 / (9 * M_PI * stokes);
  return fmax(0, dry_restitution * (1 - loss) - loss);
}

static bool report_fluid(const struct fluid *fluid, bool first, const struct bench_report *report,
                         struct status *status)
{
  struct rebound without = {.density = fluid->density, .viscosity = fluid->viscosity}, with = without;
  with.cutoff = 2;
  if (!rebound_run(&without, status) || !rebound_run(&with, status)) return false;
  printf("%8g %9g %9.1f %9.3f %9.3f %10.3f\n", fluid->density, fluid->viscosity, with.stokes, without.restitution,
         with.restitution, rebound_of_film(with.stokes));
  fflush(stdout);
  if (report->json)
    fprintf(report->json,
            "%s\n{\"density\": %g, \"viscosity\": %g, \"stokes\": %.4g, \"without\": %.4g, \"with\": %.4g}",
            first ? "" : ",", fluid->density, fluid->viscosity, with.stokes, without.restitution, with.restitution);
  return with.restitution <= without.restitution ||
         status_fail(status, DELBM_FAILED, "bench rebound: lubrication raises the restitution at a Stokes number of %g",
                     with.stokes);
}

bool bench_rebound(const struct bench_report *report, struct status *status)
{
  const size_t count = sizeof fluids / sizeof fluids[0], stride = report->quick ? 5 : 1;
  printf("restitution of a disc at a wall; without fluid %g\n", dry_restitution);
  printf("%8s %9s %9s %9s %9s %10s\n", "density", "viscosity", "Stokes", "without", "with", "film alone");
  if (report->json) fprintf(report->json, "\"rows\": [");
  for (size_t k = 0; k < count; k += stride)
    if (!report_fluid(&fluids[k], k == 0, report, status)) return false;
  if (report->json) fprintf(report->json, "]");
  return true;
}
