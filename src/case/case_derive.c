#include "case/case_derive.h"

#include "case/case_overlaps.h"
#include "case/case_query.h"
#include "sim/load.h"

#include <math.h>
#include <string.h>

static const double default_magic = 3.0 / 16.0;
static const double adaptive_magic = 1.0 / 12.0;
static const double default_density = 1.0;

static void derive_rates(struct draft *draft)
{
  const double viscosity = draft->scene.fluid.viscosity;
  const enum collision collision = draft_collision(draft);
  struct rates *rates = &draft->scene.fluid.rates;
  double *magic = &draft->scene.fluid.magic;
  draft->scene.fluid.collision = collision;
  rates->s_nu = rate_from_viscosity(viscosity);
  if (collision == COLLISION_BGK || collision == COLLISION_TRT) rates->s_e = rates->s_nu;
  const double fast = rates->s_q; /* the default: the rate of the paper */
  if (collision == COLLISION_BGK) rates->s_q = rates->s_nu;
  if (collision == COLLISION_TRT && *magic == 0) *magic = default_magic;
  if (collision == COLLISION_ADAPTIVE && *magic == 0) *magic = adaptive_magic;
  if (*magic > 0) rates->s_q = rate_from_magic(*magic, viscosity);
  if (collision == COLLISION_ADAPTIVE && rates->s_q < fast) rates->s_q_fast = fast;
}

static void derive_densities(struct draft *draft)
{
  double density = draft->density > 0 ? draft->density : default_density;
  struct scene *scene = &draft->scene;
  for (size_t i = 0; i < scene->particles.listed; i++) {
    if (scene->particles.discs[i].density == 0) scene->particles.discs[i].density = density;
  }
  if (scene->particles.fill.present && scene->particles.fill.density == 0) scene->particles.fill.density = density;
}

static void derive_fill(struct draft *draft)
{
  struct fill_spec *fill = &draft->scene.particles.fill;
  if (!fill->present) return;
  draft_fill_region(draft, fill->region);
  if (!draft_has(draft, "particles.fill.jitter")) fill->jitter = (fill->spacing - 2 * fill->radius) / 4;
}

static bool has_free_discs(const struct scene *scene)
{
  if (scene->particles.fill.present) return true;
  for (size_t i = 0; i < scene->particles.listed; i++) {
    if (scene->particles.discs[i].motion == DISC_FREE) return true;
  }
  return false;
}

static void derive_zero_flux(struct draft *draft)
{
  struct scene *scene = &draft->scene;
  if (draft_has(draft, "fluid.zero_flux")) return;
  bool closed = scene_is_closed(scene, 0) || scene_is_closed(scene, 1);
  bool heavy = scene->particles.gravity[0] != 0 || scene->particles.gravity[1] != 0;
  scene->fluid.zero_flux = !scene->fluid.none && closed && heavy && has_free_discs(scene);
}

static void derive_shown(struct draft *draft)
{
  struct scene *scene = &draft->scene;
  if (draft_has(draft, "output.fields.region")) return;
  const double box[4] = {0, 0, scene->domain.size[0], scene->domain.size[1]};
  memcpy(scene->output.fields.region, box, sizeof box);
}

/* Without fluid: no rates, and no rows of painted cells in which pairs are searched. */
static void derive_dry(struct draft *draft)
{
  draft->scene.fluid.rates = (struct rates){0};
  draft->scene.contact.search = SEARCH_LINKED_CELL;
}

void case_derive(struct draft *draft)
{
  if (draft->scene.fluid.none)
    derive_dry(draft);
  else
    derive_rates(draft);
  derive_densities(draft);
  derive_fill(draft);
  derive_zero_flux(draft);
  derive_shown(draft);
}

/* The stiffness that parts all overlaps at the start at the advised speed at most; INFINITY if there are none. */
static bool find_parting_stiffness(const struct scene *scene, double *max, struct status *status)
{
  struct case_overlaps found;
  const struct disc_spec *discs = scene->particles.discs;
  const bool ok = case_overlaps_find(scene, scene->particles.count, &found, status);
  *max = INFINITY;
  for (size_t k = 0; ok && k < found.count; k++) {
    const struct case_overlap *overlap = &found.list[k];
    const struct disc_spec *other = case_overlap_is_with_side(overlap) ? NULL : &discs[overlap->b];
    *max = fmin(*max, load_parting_stiffness(scene, &discs[overlap->a], other, overlap->depth));
  }
  case_overlaps_clear(&found);
  return ok;
}

bool case_derive_stiffness(struct draft *draft, struct status *status)
{
  struct scene *scene = &draft->scene;
  if (!draft_is_auto(draft, "contact.stiffness")) return true;
  const struct loads loads = loads_of(scene);
  double max = INFINITY;
  const bool loaded = loads.at_rest.force > 0 || loads.impact.energy > 0;
  if (loaded && !find_parting_stiffness(scene, &max, status)) return false;
  load_set_stiffness(scene, &loads, max);
  return true;
}
