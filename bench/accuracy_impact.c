/* Head-on impact of two discs so heavy that the fluid is negligible: restitution against the contact law, integrated
 * by GSL. */
#include "accuracy.h"

#include "contact/law.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <math.h>

static const double heavy = 1e6, radius = 10, speed = 0.01;
enum { BOX = 64, PHASES = 4 };

struct impactor {
  struct contact_law law;
  double mass; /* reduced */
};

static int spring_rate(double time, const double state[], double rate[], void *context)
{
  const struct impactor *s = context;
  const struct spring spring = contact_spring_at(&s->law, (const double[2]){radius, radius}, state[0]);
  const double force = fmax(0, spring.force + contact_damping(&s->law, 1 / s->mass, spring.stiffness) * state[1]);
  (void)time;
  rate[0] = state[1];
  rate[1] = state[0] > 0 ? -force / s->mass : 0;
  return GSL_SUCCESS;
}

/* Restitution of a contact of about `duration` steps; NAN if GSL fails. */
static double exact_restitution(struct impactor *impactor, double duration)
{
  gsl_odeiv2_system system = {spring_rate, NULL, 2, impactor};
  gsl_odeiv2_driver *driver =
      gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, duration / 1e3, 1e-12, 1e-10);
  double state[2] = {1e-12, speed}, time = 0;
  int result = driver ? GSL_SUCCESS : GSL_ENOMEM;
  while (result == GSL_SUCCESS && state[0] > 0 && time < 100 * duration)
    result = gsl_odeiv2_driver_apply(driver, &time, time + duration / 1e3, state);
  if (driver) gsl_odeiv2_driver_free(driver);
  return result == GSL_SUCCESS ? -state[1] / speed : NAN;
}

/* The stiffness for an undamped contact of `duration`: at small overlap the force is proportional to overlap^(3/2),
 * as in Hertz's law, and the duration is 2.943 times the largest overlap over the speed. */
static double stiffness_for(double duration, double mass, double alpha)
{
  const double overlap = duration * speed / 2.943, work = 8.0 / 15 * sqrt(radius) * pow(overlap, 2.5);
  return 0.5 * mass * speed * speed / (alpha * work);
}

static struct scene impact(const struct accuracy_choice *choice, double duration, double gap)
{
  struct scene scene = accuracy_scene(choice, BOX, BOX, 0.01, SIDES_PERIODIC);
  const double apart = 2 * radius + gap;
  scene.contact.substeps = 1;
  scene.contact.stiffness = stiffness_for(duration, heavy * M_PI * radius * radius / 2, scene.contact.alpha);
  for (int k = 0; k < 2; k++)
    scene_add_disc(&scene, radius, heavy, BOX / 2.0 + (k - 0.5) * apart, BOX / 2.0)->velocity[0] = (0.5 - k) * speed;
  return scene;
}

static bool verify_momentum(struct simulation *simulation, struct status *status)
{
  struct simulation_report report;
  simulation_report(simulation, &report);
  const double drift = report.momentum_drift * BOX * BOX / (heavy * M_PI * radius * radius * speed / 2);
  return drift < 1e-12 || status_fail(status, DELBM_FAILED, "an impact changes momentum by %g of a disc's", drift);
}

/* Restitution of one impact. */
static bool collide(const struct scene *scene, double duration, double *restitution, struct accuracy_outcome *outcome,
                    struct status *status)
{
  struct simulation *simulation = NULL;
  const int64_t steps = (int64_t)(10 + 2 / speed + 4 * duration);
  const bool ok = simulation_create(&simulation, scene, status) &&
                  accuracy_advance(simulation, steps, outcome, status) && verify_momentum(simulation, status);
  if (ok) *restitution = (simulation_discs(simulation)->vx[1] - simulation_discs(simulation)->vx[0]) / speed;
  simulation_destroy(simulation);
  return ok;
}

/* The worst of contacts that begin at different fractions of a step. */
static bool run_impact(void *context, const struct accuracy_choice *choice, int duration,
                       struct accuracy_outcome *outcome, struct status *status)
{
  bool ok = true;
  (void)context;
  for (int k = 0; ok && k < PHASES; k++) {
    struct scene scene = impact(choice, duration, 1.3 + k * speed / PHASES);
    struct impactor spring = {contact_law_of(&scene), heavy * M_PI * radius * radius / 2};
    double restitution = NAN;
    ok = collide(&scene, duration, &restitution, outcome, status);
    outcome->error = fmax(outcome->error, fabs(restitution - exact_restitution(&spring, duration)));
    scene_clear(&scene);
  }
  return ok;
}

const struct accuracy_case accuracy_impact = {
    .name = "impact",
    .error = "restitution of two discs, damping 0.34, against the contact law integrated, difference",
    .axis = "steps in a contact",
    .resolution = {5, 10, 20, 40, 80},
    .quick = 4,
    .bound = 0.45,
    .with_areas = true,
    .run = run_impact};
