#include "cli/advice.h"

#include "contact/substeps.h"
#include "sim/estimate.h"
#include "sim/stages.h"

#include <math.h>
#include <stdio.h>

/* Maps "shear layer": a ghost mode with little damping by s_q, at different rates s_e and s_nu. */
static void advise_rates(const struct scene *scene)
{
  const struct rates *rates = &scene->fluid.rates;
  if (scene->fluid.collision == COLLISION_MRT && rates->s_q < 0.25 && fabs(rates->s_e - rates->s_nu) > 0.1)
    printf(
        "  note: s_q %.3g beside s_e %.3g diverges first of all choices at small viscosity; collision: adaptive is as "
        "accurate in slow flow and goes farther (bench/STABILITY.md)\n",
        rates->s_q, rates->s_e);
}

/* Map "density of a settling disc". */
static void advise_solve(const struct scene *scene)
{
  const size_t disc = estimate_lightest_explicit(scene);
  if (disc < scene->particles.count)
    printf(
        "  note: explicit-averaged diverges for light discs (disc %zu: density %g); coupling.solve: implicit does not "
        "(bench/STABILITY.md)\n",
        disc, scene->particles.discs[disc].density);
}

/* At small viscosity the fluid inside a disc of a few cells has less mass than pi R_h^2, on which the inertia is based:
 * the effective inertia of a light disc is negative. */
static void advise_light(const struct scene *scene)
{
  const double viscosity = scene->fluid.viscosity;
  if (scene->coupling.solve != SOLVE_IMPLICIT) return;
  for (size_t i = 0; i < scene->particles.count; i++) {
    const struct disc_spec *disc = &scene->particles.discs[i];
    const double radius = scene_hydraulic_radius(scene, disc), part = radius / disc->radius;
    const bool small = radius < 0.7 || (radius < 1.8 && viscosity <= 0.1);
    if (disc->motion != DISC_FREE || disc->density > 0.97 * part * part || !small) continue;
    printf("  note: disc %zu (radius %g, density %g) is so small and light that, at viscosity %g, it may gain speed by "
           "itself until the run diverges; a radius of 2 or more does not (bench/STABILITY.md)\n",
           i, disc->radius, disc->density, viscosity);
    return;
  }
}

/* Benchmark `drag`: errors of a square array grow with viscosity and with 1/R in the paper's form. */
static void advise_form(const struct scene *scene)
{
  double smallest = INFINITY;
  for (size_t i = 0; i < scene->particles.count; i++)
    smallest = fmin(smallest, scene_hydraulic_radius(scene, &scene->particles.discs[i]));
  if (scene->coupling.form == FORM_UNIFIED && scene->fluid.viscosity >= 0.05 && smallest <= 10)
    printf("  note: form: unified has 5 %% too little drag on discs of R = 5 at viscosity 0.05 and 11 %% at 1/6; form: "
           "midpoint is within 2 %% at any viscosity (bench/README.md, drag)\n");
}

/* True if the disc overlaps a moving wall. */
static bool is_under_moving_side(const struct scene *scene, const struct disc_spec *disc)
{
  for (enum side_name name = 0; name < SIDE_COUNT; name++) {
    const struct side *side = &scene->domain.side[name];
    if (side->type == SIDE_WALL && hypot(side->velocity[0], side->velocity[1]) > 0 &&
        scene_distance_to_side(scene, name, disc->position) < scene_hydraulic_radius(scene, disc))
      return true;
  }
  return false;
}

/* owen has no damping of the fluid inside discs, unified little: maps "fixed disc that spins" and "fixed disc under
 * a lid", and piles. */
static void advise_form_inside(const struct scene *scene)
{
  const double min_rim = 0.1; /* of unified */
  const bool owen = scene->coupling.form == FORM_OWEN;
  size_t free_discs = 0;
  if (scene->coupling.form == FORM_MIDPOINT) return;
  for (size_t i = 0; i < scene->particles.count; i++) {
    const struct disc_spec *disc = &scene->particles.discs[i];
    const double rim = scene_hydraulic_radius(scene, disc) * fabs(disc->spin);
    free_discs += disc->motion == DISC_FREE;
    if (disc->motion == DISC_FREE || !(owen ? rim > 0 || is_under_moving_side(scene, disc) : rim > min_rim)) continue;
    printf("  note: with form: %s the fluid inside disc %zu, which %s, accelerates until the run diverges; form: "
           "midpoint does "
           "not (bench/STABILITY.md)\n",
           owen ? "owen" : "unified", i, rim > 0 ? "is made to spin" : "a moving side passes over");
    return;
  }
  if (owen && free_discs > 1 && scene->run.steps > 10000)
    printf("  note: with form: owen the fluid inside discs that shake each other accelerates until the run diverges (a "
           "pile "
           "of 150: in 31,000 steps); form: midpoint does not (bench/STABILITY.md)\n");
}

/* Maps "impact": contacts too short for the sub-steps that the case fixes. */
static void advise_substeps(const struct scene *scene)
{
  if (scene->contact.substeps == 0 || scene->contact.area == AREA_CELLS) return;
  const int needed = substeps_automatic(scene);
  if (needed > scene->contact.substeps)
    printf("  note: %d sub-steps are fewer than the %d that contacts may need: damping and overlap of contacts are "
           "inaccurate; better: substeps: auto (bench/STABILITY.md)\n",
           scene->contact.substeps, needed);
}

/* Map "packing": weight of discs beyond the pressure that the fluid can supply. */
static void advise_weight(const struct scene *scene)
{
  for (int axis = 0; axis < 2; axis++) {
    const double part = estimate_load(scene, axis);
    if (part < estimate_max_load) continue;
    printf("  note: the discs weigh %.0f %% of the fluid's pressure on the side below; it rings or diverges; better: "
           "particles.gravity <= %.2g cells/step^2, and more steps (bench/STABILITY.md)\n",
           100 * part, fabs(scene->particles.gravity[axis]) * estimate_max_load / part);
  }
}

static bool has_prescribed_discs(const struct scene *scene)
{
  bool found = false;
  for (size_t i = 0; i < scene->particles.count; i++) found |= scene->particles.discs[i].motion != DISC_FREE;
  return found;
}

/* Along a periodic axis the weight accelerates fluid and discs without bound, unless walls along the axis or fixed
 * discs resist: upper bound from plane Poiseuille flow. */
static void advise_fall(const struct scene *scene, const double weight[2])
{
  const double cells = (double)scene->domain.size[0] * scene->domain.size[1], *force = scene->fluid.force;
  double fall[2] = {0, 0};
  for (int axis = 0; axis < 2; axis++) {
    if (!scene_is_periodic(scene, axis) || weight[axis] == 0) continue;
    const double pull = fabs(weight[axis] / cells + force[axis]), width = scene->domain.size[!axis];
    fall[axis] = pull * (double)scene->run.steps;
    if (!scene_is_periodic(scene, !axis))
      fall[axis] = fmin(fall[axis], pull * width * width / (8 * scene->fluid.viscosity));
  }
  const double max_fall = fmax(fall[0], fall[1]);
  if (max_fall > 0.05 && !has_prescribed_discs(scene))
    printf("  note: no force balances the weight of the discs along the periodic sides: within the run all fluid and "
           "discs "
           "may gain %.2g cells/step; fluid.force: [%.9g, %.9g] balances the weight\n",
           max_fall, fall[0] > 0 ? 0 - weight[0] / cells : force[0], fall[1] > 0 ? 0 - weight[1] / cells : force[1]);
}

void print_advice(const struct scene *scene)
{
  double weight[2];
  if (scene->fluid.none) {
    advise_substeps(scene);
    advise_rest(scene);
    return;
  }
  advise_rates(scene);
  if (scene->particles.count == 0) return;
  advise_solve(scene);
  advise_light(scene);
  advise_form(scene);
  advise_form_inside(scene);
  estimate_weight(scene, weight);
  advise_weight(scene);
  advise_fall(scene, weight);
  advise_substeps(scene);
  advise_sound(scene);
  advise_rest(scene);
}
