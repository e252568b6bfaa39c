/* Beds of discs with a hydraulic radius: who bears the weight, how much fluid passes, fluidisation. */
#include "drive.h"
#include "scenes.h"
#include "sim/load.h"
#include "sim/simulation.h"
#include "solid/lens.h"
#include "stokes_array.h"

#include <criterion/criterion.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>

static const double density = 2.5, part = 0.8;

/* Weight of a disc less buoyancy. */
static double weight_of(const struct scene *scene, const struct disc_spec *disc)
{
  return -disc_spec_area(disc) * (disc->density - 1) * scene->particles.gravity[1];
}

/* Part of the weight that contacts with sides bear; contacts of two discs cancel in the sum. */
static double borne_by_contacts(const struct scene *scene, const struct discs *d)
{
  double weight = 0, force = 0;
  for (size_t i = 0; i < d->count; i++) {
    weight += weight_of(scene, &scene->particles.discs[i]);
    force += d->contact_fy[i];
  }
  return force / weight;
}

static double fastest(const struct discs *d)
{
  double max = 0;
  for (size_t i = 0; i < d->count; i++) max = fmax(max, hypot(d->vx[i], d->vy[i]));
  return max;
}

/* Small discs of R = 2 on the ground, and one of R = 40 above them. Gravity would move it at 0.1 cells/step, at a drag
 * coefficient of 1. */
static struct scene mixture(void)
{
  const double radius = 2, large = 40;
  struct scene scene = scene_box(110, 150, 0.05, SIDES_CLOSED);
  scene.fluid.zero_flux = true;
  scene.particles.gravity[1] = -0.01 / (M_PI * large * (density - 1));
  for (int k = 0; k < 6 * 24; k++)
    scene_add_disc(&scene, radius, density, 2.5 + 4.5 * (k % 24) + 0.3 * (k / 24 % 2), 3 + 4.5 * (k / 24));
  scene_add_disc(&scene, large, density, 54, 72);
  const struct loads loads = loads_of(&scene);
  load_set_stiffness(&scene, &loads, INFINITY);
  return scene;
}

Test(beds, a_disc_twenty_times_larger_settles_among_small_ones_at_the_automatic_stiffness)
{
  struct scene scene = mixture();
  struct simulation *simulation = start(&scene);
  const struct discs *d = simulation_discs(simulation);
  advance(simulation, 12000);
  struct simulation_report report;
  simulation_report(simulation, &report);
  cr_expect_lt(report.max_overlap, scene.contact.overlap, "%g", report.max_overlap);
  cr_expect_lt(fastest(d), 0.003, "%g", fastest(d));
  const double lowest = 40, bed = lowest + 2 * 2;
  cr_expect(d->y[d->count - 1] > lowest && d->y[d->count - 1] < bed, "%g", d->y[d->count - 1]);
  for (size_t i = 0; i < d->count; i++)
    cr_expect(d->y[i] > 0.99 * d->radius[i] && d->x[i] > 0.99 * d->radius[i] && d->x[i] < 110 - 0.99 * d->radius[i]);
  simulation_destroy(simulation);
  scene_clear(&scene);
}

/* Twenty discs in a closed box, as the pile of bench/README.md at half its resolution. */
static double pile_after(double hydraulic_radius, double stiffness, int64_t steps, double *speed)
{
  struct scene scene = scene_box(60, 60, 0.02, SIDES_CLOSED);
  scene.coupling.hydraulic_radius = hydraulic_radius;
  scene.contact.stiffness = stiffness;
  scene.fluid.zero_flux = true;
  scene.particles.gravity[1] = -2e-4;
  for (int k = 0; k < 20; k++)
    scene_add_disc(&scene, 5, density, 5.7 + 11.8 * (k % 5) + 0.3 * (k / 5 % 2), 6 + 11.3 * (k / 5));
  struct simulation *simulation = start(&scene);
  advance(simulation, steps);
  const double borne = borne_by_contacts(&scene, simulation_discs(simulation));
  *speed = fastest(simulation_discs(simulation));
  simulation_destroy(simulation);
  scene_clear(&scene);
  return borne;
}

Test(beds, contacts_bear_the_weight_of_a_pile_at_any_stiffness)
{
  static const double stiffnesses[] = {0.1, 1, 10};
  for (int k = 0; k < 3; k++) {
    double speed;
    const double borne = pile_after(part, stiffnesses[k], 20000, &speed);
    cr_expect_float_eq(borne, 1, 0.02, "stiffness %g: %g", stiffnesses[k], borne);
    cr_expect_lt(speed, 1e-4, "stiffness %g: at rest: %g", stiffnesses[k], speed);
  }
}

Test(beds, fluid_bears_a_part_of_the_weight_of_a_pile_without_a_hydraulic_radius)
{
  double speed;
  const double borne = pile_after(1, 1, 20000, &speed);
  cr_expect_lt(borne, 0.85, "%g", borne);
}

/* Discs of radii 6 +- 20 % that settle between periodic sides. */
static struct scene settling_discs(unsigned long seed)
{
  const int columns = 7, rows = 5, width = 96;
  const double spacing = width / (double)columns;
  struct scene scene = scene_box(width, 90, 0.05, SIDES_CLOSED);
  gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(random, seed);
  scene.domain.side[SIDE_LEFT].type = scene.domain.side[SIDE_RIGHT].type = SIDE_PERIODIC;
  scene.coupling.hydraulic_radius = part;
  scene.contact.stiffness = 10;
  scene.fluid.zero_flux = true;
  scene.particles.gravity[1] = -4e-4;
  for (int k = 0; k < columns * rows; k++) {
    const double radius = 6 * (0.8 + 0.4 * gsl_rng_uniform(random)), jitter = gsl_rng_uniform(random) - 0.5;
    scene_add_disc(&scene, radius, density, (k % columns + 0.5) * spacing + jitter, 8 + spacing * (k / columns));
  }
  gsl_rng_free(random);
  return scene;
}

/* Solid fraction of R between half a layer from the ground and a layer from the top. */
static double solid_fraction(const struct scene *scene, const struct discs *d)
{
  double top = 0, area = 0;
  for (size_t i = 0; i < d->count; i++) top = fmax(top, d->y[i]);
  const double low = 6, high = top - 12;
  for (size_t i = 0; i < d->count; i++)
    area += lens_of_wall(d->radius[i], d->y[i] - high).area - lens_of_wall(d->radius[i], d->y[i] - low).area;
  return area / (high - low) / scene->domain.size[0];
}

/* Mean drag per disc over mu U of the same discs, fixed, in a periodic box, driven across the layers. */
static double drag_of_bed(const struct scene *settled, const struct discs *d)
{
  struct scene scene = scene_box(settled->domain.size[0], settled->domain.size[1], 0.05, SIDES_PERIODIC);
  double speed = 0, before = 1;
  scene.coupling.hydraulic_radius = part;
  scene.fluid.force[1] = 5e-8;
  for (size_t i = 0; i < d->count; i++) scene_add_disc(&scene, d->radius[i], 1, d->x[i], d->y[i])->motion = DISC_FIXED;
  struct simulation *simulation = start(&scene);
  for (int k = 0; k < 20 && !(fabs(speed / before - 1) < 1e-3); k++) {
    struct simulation_report report;
    before = speed;
    advance(simulation, 500);
    simulation_report(simulation, &report);
    speed = report.mean_velocity[1];
  }
  const double drag = scene.fluid.force[1] * (double)scene_cells(&scene) / (double)d->count / (0.05 * speed);
  simulation_destroy(simulation);
  scene_clear(&scene);
  return drag;
}

/* Measured at R = 10: 1.12 times the drag of the hexagonal array (bench/README.md). */
Test(beds, a_settled_bed_has_about_the_drag_of_hexagonal_arrays_of_its_effective_solid_fraction)
{
  for (unsigned long seed = 1; seed <= 3; seed++) {
    struct scene scene = settling_discs(seed);
    struct simulation *simulation = start(&scene);
    const struct discs *d = simulation_discs(simulation);
    advance(simulation, 10000);
    const double fraction = solid_fraction(&scene, d), borne = borne_by_contacts(&scene, d);
    const double ratio = drag_of_bed(&scene, d) / stokes_array_drag(STOKES_HEXAGONAL, part * part * fraction);
    cr_expect_float_eq(borne, 1, 0.02, "seed %lu: %g of the weight", seed, borne);
    cr_expect(fraction > 0.78 && fraction < 0.92, "seed %lu: solid fraction %g", seed, fraction);
    cr_expect(ratio > 0.75 && ratio < 1.35, "seed %lu: solid fraction %g: %g times", seed, fraction, ratio);
    simulation_destroy(simulation);
    scene_clear(&scene);
  }
}

/* Twenty discs on an inlet, periodic to the left and right. */
static struct scene column(double speed)
{
  struct scene scene = scene_box(60, 140, 0.05, SIDES_PERIODIC);
  scene.domain.side[SIDE_BOTTOM] = (struct side){SIDE_INLET, {0, speed}};
  scene.domain.side[SIDE_TOP].type = SIDE_OUTLET;
  scene.coupling.hydraulic_radius = part;
  scene.contact.stiffness = 2;
  scene.particles.gravity[1] = -4e-4;
  for (int k = 0; k < 20; k++)
    scene_add_disc(&scene, 5, density, 6.2 + 12 * (k % 5) + 0.3 * (k / 5 % 2), 5.2 + 10.4 * (k / 5));
  return scene;
}

/* Pressure of the lowest row less that of the highest row. */
static double pressure_drop(struct simulation *simulation, const struct scene *scene)
{
  const size_t cells = (size_t)scene_cells(scene), width = (size_t)scene->domain.size[0];
  double *rho = malloc(cells * sizeof *rho), sum = 0;
  cr_assert(rho);
  simulation_fields(simulation, rho, NULL, NULL);
  for (size_t x = 0; x < width; x++) sum += (rho[x] - rho[cells - width + x]) / 3;
  free(rho);
  return sum / (double)width;
}

/* Means over time, over the weight per width: of the pressure drop, and of the contact force on the discs. */
struct support {
  double fluid, contacts;
};

static struct support support_in(double speed, int64_t settle, int samples)
{
  struct scene scene = column(speed);
  struct simulation *simulation = start(&scene);
  struct support mean = {0, 0};
  double weight = 0;
  for (size_t i = 0; i < scene.particles.count; i++) weight += weight_of(&scene, &scene.particles.discs[i]);
  advance(simulation, settle);
  for (int k = 0; k < samples; k++) {
    advance(simulation, 50);
    mean.fluid += pressure_drop(simulation, &scene) * scene.domain.size[0] / weight / samples;
    mean.contacts += borne_by_contacts(&scene, simulation_discs(simulation)) / samples;
  }
  simulation_destroy(simulation);
  scene_clear(&scene);
  return mean;
}

Test(beds, the_pressure_drop_over_a_fluidised_bed_is_its_buoyant_weight)
{
  const struct support bed = support_in(0.008, 10000, 600);
  cr_expect_float_eq(bed.fluid, 1, 0.02, "%g", bed.fluid);
  cr_expect_float_eq(bed.fluid + bed.contacts, 1, 0.01, "with discs that fall onto the inlet: %g", bed.contacts);
}

Test(beds, below_fluidisation_the_pressure_drop_is_in_proportion_to_the_flow)
{
  const struct support slow = support_in(0.0004, 8000, 20), fast = support_in(0.0008, 8000, 20);
  cr_expect_float_eq(fast.fluid / slow.fluid, 2, 0.06, "%g and %g", slow.fluid, fast.fluid);
  cr_expect_float_eq(slow.fluid + slow.contacts, 1, 0.02, "%g and %g", slow.fluid, slow.contacts);
  cr_expect_gt(slow.contacts, 0.5, "%g", slow.contacts);
}
