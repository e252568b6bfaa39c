#include "contact/law.h"

#include "contact/restitution.h"
#include "solid/lens.h"

#include <math.h>

static struct lens lens_at(const double radius[2], double overlap)
{
  return isinf(radius[1]) ? lens_of_wall(radius[0], radius[0] - overlap)
                          : lens_of_discs(radius[0], radius[1], radius[0] + radius[1] - overlap);
}

/* f(beta) of (11) = (4 sqrt(2)/(3 pi)) (1 + beta^2)/(1 + beta)^2, symmetric in both radii. */
static double alpha_of(const struct contact_law *law, const double radius[2])
{
  if (law->alpha > 0) return law->alpha;
  const double beta = isinf(radius[1]) ? 0 : radius[0] / radius[1];
  return 4 * M_SQRT2 / (3 * M_PI) * (1 + beta * beta) / ((1 + beta) * (1 + beta));
}

static double area_factor(const double radius[2])
{
  (void)radius;
  return 1;
}

static double hertz_factor(const double radius[2])
{
  const double reduced = 1 / (1 / radius[0] + 1 / radius[1]);
  return 4. / 3 * sqrt(2 * reduced);
}

static double linear_factor(const double radius[2])
{
  return lens_at(radius, 0.01 * fmin(radius[0], radius[1])).chord;
}

/* Strength over alpha k_n, and the exponent of the overlap in the limit of small overlap. */
static const struct {
  double (*factor)(const double radius[2]);
  double exponent;
} laws[] = {
    [SPRING_OVERLAP] = {area_factor, 1.5}, [SPRING_HERTZ] = {hertz_factor, 1.5}, [SPRING_LINEAR] = {linear_factor, 1}};

struct contact_law contact_law_of(const struct scene *scene)
{
  const double restitution = scene->contact.restitution;
  struct contact_law law = {.spring = scene->contact.law,
                            .k_n = scene->contact.stiffness,
                            .alpha = scene->contact.alpha,
                            .damping = scene->contact.damping,
                            .by_rate = restitution > 0,
                            .form = scene->contact.damping_form,
                            .friction = scene->contact.friction,
                            .tangential_ratio = scene->contact.tangential_ratio,
                            .rolling_friction = scene->contact.rolling_friction};
  if (law.by_rate) law.damping = restitution_damping(restitution, laws[law.spring].exponent);
  return law;
}

double contact_strength(const struct contact_law *law, const double radius[2])
{
  return alpha_of(law, radius) * law->k_n * laws[law->spring].factor(radius);
}

double contact_damping(const struct contact_law *law, double inverse_mass, double stiffness)
{
  if (inverse_mass <= 0) return 0;
  const double k = law->by_rate ? stiffness : law->k_n;
  return 2 * law->damping * sqrt(law->by_rate || law->form == DAMPING_CRITICAL ? k / inverse_mass : k * inverse_mass);
}

struct spring contact_spring_at(const struct contact_law *law, const double radius[2], double overlap)
{
  const double strength = contact_strength(law, radius), depth = fmax(0, overlap);
  const struct lens lens = lens_at(radius, depth);
  return (struct spring){spring_force(law->spring, strength, depth, lens.area),
                         spring_stiffness(law->spring, strength, depth, lens.chord)};
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
