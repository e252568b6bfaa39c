#include "contact/law.h"

#include "solid/lens.h"

#include <math.h>

/* (10): proportional to the overlap area. */
static struct spring spring_of_area(const struct contact_law *law, const struct kinematics *k)
{
  return (struct spring){law->alpha_k_n * k->overlap.lens.area, law->alpha_k_n * k->overlap.lens.chord};
}

/* (8): F = alpha k_n c delta, delta the overlap, c the chord of the lens at delta = 1 % of the smaller radius, where
 * the stiffness is equal to the area law's. */
static struct spring spring_of_overlap(const struct contact_law *law, const struct kinematics *k)
{
  const double design = 0.01 * fmin(k->overlap.radius[0], k->overlap.radius[1]);
  const bool side = isinf(k->overlap.radius[1]);
  const double touch = side ? k->overlap.radius[0] : k->overlap.radius[0] + k->overlap.radius[1];
  const struct lens lens = side ? lens_of_wall(k->overlap.radius[0], touch - design)
                                : lens_of_discs(k->overlap.radius[0], k->overlap.radius[1], touch - design);
  const double stiffness = law->alpha_k_n * lens.chord;
  return (struct spring){stiffness * fmax(0, k->overlap.depth), stiffness};
}

/* In the order of the choices of the key contact.law. */
static contact_spring *const springs[] = {spring_of_area, spring_of_overlap};

struct contact_law contact_law_of(const struct scene *scene)
{
  return (struct contact_law){.force_of = springs[scene->contact.law],
                              .alpha_k_n = scene->contact.alpha * scene->contact.stiffness,
                              .k_n = scene->contact.stiffness,
                              .damping = scene->contact.damping,
                              .form = scene->contact.damping_form};
}

double contact_damping(const struct contact_law *law, double inverse_mass)
{
  if (inverse_mass <= 0) return 0;
  return 2 * law->damping * sqrt(law->form == DAMPING_CRITICAL ? law->k_n / inverse_mass : law->k_n * inverse_mass);
}

struct contact_impulse contact_law_impulse(const struct contact_law *law, struct contact_state *state,
                                           const struct kinematics *k, double h)
{
  state_count_work(state, k->approach_speed);
  if (k->overlap.lens.area <= 0) {
    state->stored = 0;
    return (struct contact_impulse){0};
  }
  const double spring = law->force_of(law, k).force, force = fmax(0, spring + k->damping * k->approach_speed);
  const double max = state_max_impulse(state, k->mean_speed, k->compliance, h * k->damping);
  state->approach_speed = k->approach_speed;
  state->spring_impulse = fmin(h * spring, max);
  state->impulse = fmin(h * force, max);
  return (struct contact_impulse){.normal = state->impulse};
}

struct spring contact_spring_at(const struct contact_law *law, const double radius[2], double overlap)
{
  struct kinematics k = {.overlap = {.depth = overlap, .radius = {radius[0], radius[1]}}};
  k.overlap.lens = isinf(radius[1]) ? lens_of_wall(radius[0], radius[0] - overlap)
                                    : lens_of_discs(radius[0], radius[1], radius[0] + radius[1] - overlap);
  return law->force_of(law, &k);
}

/* Simpson's rule in the root of the overlap: forces proportional to overlap^(3/2) are smooth in the root. */
double contact_energy(const struct contact_law *law, const double radius[2], double overlap)
{
  enum { PARTS = 32 };
  const double top = sqrt(fmax(0, overlap));
  double sum = 0;
  for (int k = 1; k <= PARTS; k++) {
    const double root = top * k / PARTS, weight = k == PARTS ? 1 : k % 2 ? 4 : 2;
    sum += weight * 2 * root * contact_spring_at(law, radius, root * root).force;
  }
  return sum * top / (3 * PARTS);
}
