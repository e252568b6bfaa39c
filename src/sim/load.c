#include "sim/load.h"

#include "contact/law.h"
#include "contact/substeps.h"
#include "sim/estimate.h"

#include <math.h>

/* Free discs, and the smallest of the others; NULL: none. At one speed the disc of the largest m/R^3 needs the stiffest
 * contact. */
struct extremes {
  size_t free;
  const struct disc_spec *heaviest, *stiffest;
  const struct disc_spec *smallest_prescribed;
};

double load_mass(const struct scene *scene, const struct disc_spec *disc)
{
  const double part = scene->coupling.hydraulic_radius;
  return disc_spec_area(disc) * (disc->density + part * part * sediment_fluid(scene));
}

static double mass_by_cube(const struct scene *scene, const struct disc_spec *disc)
{
  return load_mass(scene, disc) / pow(disc->radius, 3);
}

static struct extremes extremes_of(const struct scene *scene)
{
  struct extremes e = {0};
  for (size_t i = 0; i < scene->particles.count; i++) {
    const struct disc_spec *disc = &scene->particles.discs[i];
    if (disc->motion != DISC_FREE) {
      if (!e.smallest_prescribed || disc->radius < e.smallest_prescribed->radius) e.smallest_prescribed = disc;
      continue;
    }
    e.free++;
    if (!e.heaviest || load_mass(scene, disc) > load_mass(scene, e.heaviest)) e.heaviest = disc;
    if (!e.stiffest || mass_by_cube(scene, disc) > mass_by_cube(scene, e.stiffest)) e.stiffest = disc;
  }
  return e;
}

static double smallest_radius(const struct scene *scene)
{
  double radius = INFINITY;
  for (size_t i = 0; i < scene->particles.count; i++) radius = fmin(radius, scene->particles.discs[i].radius);
  return radius;
}

static double smaller_radius(const struct load *load)
{
  return fmin(load->radius[0], load->radius[1]);
}

/* The law of the scene with k_n = 1. */
static struct contact_law unit_law(const struct scene *scene)
{
  struct scene unit = *scene;
  unit.contact.stiffness = 1;
  return contact_law_of(&unit);
}

/* Force or energy over that of the law at an overlap. */
static double excess_at(const struct contact_law *law, const struct load *load, double overlap)
{
  return load->energy > 0 ? load->energy / contact_energy(law, load->radius, overlap)
                          : load->force / contact_spring_at(law, load->radius, overlap).force;
}

double load_stiffness(const struct scene *scene, const struct load *load)
{
  if (load->force <= 0 && load->energy <= 0) return 0;
  const struct contact_law law = unit_law(scene);
  return excess_at(&law, load, scene->contact.overlap * smaller_radius(load));
}

double load_overlap(const struct scene *scene, const struct load *load)
{
  if (load->force <= 0 && load->energy <= 0) return 0;
  const struct contact_law law = contact_law_of(scene);
  double low = 0, high = 1;
  for (int k = 0; k < 50; k++) {
    const double part = (low + high) / 2;
    if (excess_at(&law, load, part * smaller_radius(load)) > 1)
      low = part;
    else
      high = part;
  }
  return high;
}

int load_substeps(const struct scene *scene, const struct load *load)
{
  const struct contact_law law = contact_law_of(scene);
  const double overlap = load_overlap(scene, load) * smaller_radius(load), compliance = 1 / load->mass;
  const double stiffness = contact_spring_at(&law, load->radius, overlap).stiffness;
  const struct contact_rates rates = substeps_rates(&law, stiffness, compliance);
  return substeps_needed(scene, &rates);
}

/* The load that demands the larger stiffness. */
static void consider(const struct scene *scene, struct load *load, const struct load *other)
{
  if (load_stiffness(scene, other) > load_stiffness(scene, load)) *load = *other;
}

static struct load rest_of(const struct scene *scene, const struct disc_spec *on, double radius, double force)
{
  return (struct load){.radius = {on->radius, radius}, .force = force, .mass = load_mass(scene, on)};
}

/* Two of the free discs that gravity draws along an axis, or to one side of it: the one with the largest load, at least
 * its own weight, and the one with the largest weight over R^2, the stiffest demand of discs on a side. */
struct loaded {
  const struct disc_spec *most, *densest;
  double load, density; /* of these */
};

static struct loaded loaded_along(const struct scene *scene, int axis, const struct sediment *s, double pressure)
{
  struct loaded loaded = {0};
  for (size_t i = 0; i < scene->particles.count; i++) {
    const struct disc_spec *disc = &scene->particles.discs[i];
    if (disc->motion != DISC_FREE || (s && !sediment_has(scene, s, disc))) continue;
    const double weight = fabs(sediment_disc_weight(scene, disc, axis)), density = weight / disc_spec_area(disc);
    const double load = fmax(weight, pressure * 2 * disc->radius);
    if (load > loaded.load) loaded.most = disc;
    if (density > loaded.density) loaded.densest = disc;
    loaded.load = fmax(loaded.load, load);
    loaded.density = fmax(loaded.density, density);
  }
  return loaded;
}

struct load load_in_sediment(const struct scene *scene, const struct sediment *s)
{
  const bool pile = s->count > 1 && sediment_layers(scene, s) > 1;
  const struct loaded loaded = loaded_along(scene, s->axis, s, pile ? sediment_pressure(scene, s) : 0);
  const double smallest = smallest_radius(scene);
  struct load load = {0};
  if (!loaded.most || !loaded.densest) return load;
  if (pile || smallest < loaded.most->radius) load = rest_of(scene, loaded.most, smallest, loaded.load);
  const struct load on_side = rest_of(scene, loaded.densest, INFINITY, loaded.density * disc_spec_area(loaded.densest));
  consider(scene, &load, &on_side);
  return load;
}

static struct load at_rest(const struct scene *scene)
{
  struct load load = {0};
  for (int axis = 0; axis < 2; axis++) {
    for (int end = 0; end < 2 && !scene_is_periodic(scene, axis); end++) {
      const struct sediment s = sediment_of(scene, axis, end == 1);
      const struct load other = load_in_sediment(scene, &s);
      consider(scene, &load, &other);
    }
    if (!scene_is_periodic(scene, axis) || scene->particles.count < 2) continue;
    const struct loaded loaded = loaded_along(scene, axis, NULL, 0);
    if (!loaded.most) continue;
    const struct load other = rest_of(scene, loaded.most, smallest_radius(scene), loaded.load);
    consider(scene, &load, &other);
  }
  return load;
}

/* Bounds of expected velocities, of a body at rest included. */
struct velocities {
  double low[2], high[2];
};

static void extend(struct velocities *v, const double velocity[2])
{
  for (int axis = 0; axis < 2; axis++) {
    v->low[axis] = fmin(v->low[axis], velocity[axis]);
    v->high[axis] = fmax(v->high[axis], velocity[axis]);
  }
}

/* Terminal velocity or, where that is less, the velocity of a free fall by fall[axis][end], with the inertia of the
 * displaced fluid. */
static void extend_by_fall(struct velocities *v, const struct scene *scene, const struct disc_spec *disc,
                           double terminal, double fall[2][2])
{
  double velocity[2], weight[2];
  for (int axis = 0; axis < 2; axis++) weight[axis] = sediment_disc_weight(scene, disc, axis);
  for (int axis = 0; axis < 2; axis++) {
    const double along = weight[axis] == 0 ? 0 : terminal * fabs(weight[axis]) / hypot(weight[0], weight[1]);
    const double gain = 2 * fabs(weight[axis]) / load_mass(scene, disc) * fmax(0, fall[axis][weight[axis] > 0]);
    const double free = sqrt(disc->velocity[axis] * disc->velocity[axis] + gain);
    velocity[axis] = copysign(fmin(along, free), weight[axis]);
  }
  extend(v, velocity);
}

static double terminal_speed(const struct scene *scene, const struct disc_spec *disc)
{
  const double weight = hypot(sediment_disc_weight(scene, disc, 0), sediment_disc_weight(scene, disc, 1));
  if (weight > 0 && sediment_fluid(scene) == 0) return INFINITY;
  return weight > 0 ? estimate_settling(scene_hydraulic_radius(scene, disc), scene->fluid.viscosity, weight) : 0;
}

/* Height of the fall towards an end of an axis. Along a periodic axis it ends by drag or, without fluid, is taken as the
 * size of the box. */
static double height_of_fall(const struct scene *scene, int axis, bool at_high_end)
{
  if (scene_is_periodic(scene, axis)) return sediment_fluid(scene) > 0 ? INFINITY : (double)scene->domain.size[axis];
  const struct sediment s = sediment_of(scene, axis, at_high_end);
  return s.count > 0 ? sediment_fall(scene, &s) : 0;
}

/* Largest relative speed of two bodies. */
static double impact_speed(const struct scene *scene)
{
  struct velocities v = {.low = {0}, .high = {0}};
  double fall[2][2], terminal = 0;
  for (int axis = 0; axis < 2; axis++)
    for (int end = 0; end < 2; end++) fall[axis][end] = height_of_fall(scene, axis, end == 1);
  for (size_t i = 0; i < scene->particles.count; i++) {
    const struct disc_spec *disc = &scene->particles.discs[i];
    if (disc->motion != DISC_FIXED) extend(&v, disc->velocity);
    if (disc->motion != DISC_FREE) continue;
    if (i == 0 || disc->radius != disc[-1].radius || disc->density != disc[-1].density || disc[-1].motion != DISC_FREE)
      terminal = terminal_speed(scene, disc);
    if (terminal > 0) extend_by_fall(&v, scene, disc, terminal, fall);
  }
  return hypot(v.high[0] - v.low[0], v.high[1] - v.low[1]);
}

static double inverse_mass(const struct scene *scene, const struct disc_spec *disc)
{
  return disc && disc->motion == DISC_FREE ? 1 / load_mass(scene, disc) : 0;
}

/* `b` NULL: with a side. */
static struct load impact_of(const struct scene *scene, const struct disc_spec *a, const struct disc_spec *b,
                             double speed)
{
  const double mass = 1 / (inverse_mass(scene, a) + inverse_mass(scene, b));
  return (struct load){.radius = {a->radius, b ? b->radius : INFINITY},
                       .energy = 0.5 * mass * speed * speed,
                       .speed = speed,
                       .mass = mass};
}

static struct load in_impact(const struct scene *scene, const struct extremes *e)
{
  const double speed = impact_speed(scene);
  struct load load = {0};
  struct load all[5];
  size_t count = 0;
  if (!(scene_is_periodic(scene, 0) && scene_is_periodic(scene, 1)))
    all[count++] = impact_of(scene, e->stiffest, NULL, speed);
  if (e->free > 1) all[count++] = impact_of(scene, e->stiffest, e->stiffest, speed);
  if (e->free > 1 && e->heaviest != e->stiffest) all[count++] = impact_of(scene, e->stiffest, e->heaviest, speed);
  if (e->smallest_prescribed) {
    all[count++] = impact_of(scene, e->stiffest, e->smallest_prescribed, speed);
    all[count++] = impact_of(scene, e->heaviest, e->smallest_prescribed, speed);
  }
  for (size_t k = 0; k < count; k++) consider(scene, &load, &all[k]);
  return load;
}

struct loads loads_of(const struct scene *scene)
{
  const struct extremes e = extremes_of(scene);
  struct loads loads = {0};
  if (e.free == 0) return loads;
  loads.at_rest = at_rest(scene);
  loads.impact = in_impact(scene, &e);
  return loads;
}

double load_parting_stiffness(const struct scene *scene, const struct disc_spec *a, const struct disc_spec *b,
                              double overlap)
{
  const struct contact_law law = unit_law(scene);
  const struct load parting = impact_of(scene, a, b, scene_advised_speed);
  return parting.energy / contact_energy(&law, parting.radius, overlap);
}

/* The stiffness at which the available sub-steps resolve a contact at an overlap of one cell; INFINITY if their number is
 * free. */
static double resolved_stiffness(const struct scene *scene, const struct load *load)
{
  const bool once = scene->contact.area == AREA_CELLS;
  if (!once && scene->contact.substeps == 0) return INFINITY;
  const struct contact_law law = unit_law(scene);
  const double frequency = M_PI * (once ? 1 : scene->contact.substeps) / scene->contact.steps_per_contact;
  return frequency * frequency * load->mass / contact_spring_at(&law, load->radius, 1).stiffness;
}

void load_set_stiffness(struct scene *scene, const struct loads *loads, double max)
{
  const double at_rest = load_stiffness(scene, &loads->at_rest), impact = load_stiffness(scene, &loads->impact);
  const bool rests = at_rest > impact;
  scene->contact.stiffness = load_min_stiffness;
  scene->contact.stiffness_source = STIFFNESS_LEAST;
  if (fmax(at_rest, impact) <= load_min_stiffness) return;
  const double resolved = resolved_stiffness(scene, rests ? &loads->at_rest : &loads->impact);
  const double stiffness = fmin(fmax(at_rest, impact), fmin(resolved, max));
  if (stiffness <= load_min_stiffness || isinf(stiffness)) return;
  scene->contact.stiffness = stiffness;
  scene->contact.stiffness_source = stiffness == max        ? STIFFNESS_START
                                    : stiffness == resolved ? STIFFNESS_SUBSTEPS
                                    : rests                 ? STIFFNESS_AT_REST
                                                            : STIFFNESS_IMPACT;
}
