/* Sound between two sides that both reflect rings at c_s/(2 H), H apart. Near the shedding frequency of a disc in a
 * stream this changes lift and Strouhal number, without any other sign. Measured (R = 5, Re 100, U = 0.03, walls
 * that move with the stream; tone over shedding frequency, length over height of the box, Strouhal number, standard
 * deviation of the lift coefficient; published, without sides: 0.165 and 0.23):
 *
 *     tone   2.9    2.9    2.9    1.46   1.46   1.46   0.73   3.9    4.5    5.9
 *     L/H    0.90   1.35   1.80   0.45   0.90   1.80   0.45   1.20   1.38   1.80
 *     St     0.473  0.167  0.166  0.162  0.169  0.165  0.130  0.160  0.163  0.170
 *     C_L    0.56   0.36   0.32   0.52   0.46   0.30   0.23   0.19   0.20   0.25
 *
 * Hence the warning for L/H up to 1.5 and a tone within a factor of 3.5 of the shedding frequency. */
#include "cli/advice.h"

#include <math.h>
#include <stdio.h>

static const double near_factor = 3.5, short_box = 1.5, min_reynolds = 47;

/* Strouhal number of a cylinder's shedding: the fit of Williamson 1988 (Phys. Fluids 31, 2742) up to Re 180, and
 * about 0.2 beyond. */
static double strouhal(double reynolds)
{
  return reynolds > 180 ? 0.2 : 0.1816 - 3.3265 / reynolds + 1.6e-4 * reynolds;
}

static bool reflects(const struct side *side)
{
  const struct side_kind *kind = side_kind_of(side->type);
  return kind->closed || kind->velocity == VELOCITY_INTO;
}

/* The first of the two sides at the ends of an axis. */
static const struct side *sides_of(const struct scene *scene, int axis)
{
  return &scene->domain.side[axis == 0 ? SIDE_LEFT : SIDE_BOTTOM];
}

/* Speed of the stream that enters along the axis. */
static double stream(const struct scene *scene, int axis)
{
  const struct side *sides = sides_of(scene, axis);
  double speed = 0;
  for (int k = 0; k < 2; k++)
    if (sides[k].type == SIDE_INLET) speed = fmax(speed, fabs(sides[k].velocity[axis]));
  return speed;
}

void advise_sound(const struct scene *scene)
{
  for (int along = 0; along < 2; along++) {
    const double speed = stream(scene, along), height = scene->domain.size[!along];
    const struct side *across = sides_of(scene, !along);
    const double tone = 1 / (sqrt(3) * 2 * height);
    if (!reflects(&across[0]) || !reflects(&across[1]) || scene->domain.size[along] >= short_box * height) continue;
    for (size_t i = 0; i < scene->particles.count; i++) {
      const struct disc_spec *disc = &scene->particles.discs[i];
      const double diameter = 2 * scene_hydraulic_radius(scene, disc);
      const double reynolds = diameter * speed / scene->fluid.viscosity;
      if (disc->motion != DISC_FIXED || reynolds <= min_reynolds) continue;
      const double shedding = strouhal(reynolds) * speed / diameter;
      if (tone > near_factor * shedding || shedding > near_factor * tone) continue;
      printf("  note: sound between the %s sides rings %.3g times a step, and disc %zu sheds vortices about %.3g times "
             "(Strouhal number %.2g): in so short a box the sound may spoil lift and Strouhal number; better: "
             "domain.size[%d] >= %.0f\n",
             along == 0 ? "bottom and top" : "left and right", tone, i, shedding, strouhal(reynolds), along,
             ceil(short_box * height));
      return;
    }
  }
}
