#include "case/case_check.h"

#include "base/memory.h"
#include "case/case_keys.h"
#include "case/case_overlaps.h"
#include "case/case_query.h"
#include "case/case_units.h"
#include "contact/law.h"
#include "model/fill_grid.h"
#include "sim/load.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double max_cells = 8589934592.0; /* 2^33 */
static const double cell_bytes = 72;          /* nine populations in double precision */
static const double max_discs = 5e7;
static const double max_cover = 4; /* sum of the areas of the discs, over the area of the box */
static const double clearance = 4; /* cells between a disc and its own image across a periodic axis */

static const double gib = 1 << 30;

static void check_cells(struct draft *draft)
{
  const int *size = draft->scene.domain.size;
  double cells = (double)size[0] * size[1];
  if (!draft_knows(draft, "domain.size") || cells <= max_cells) return;
  if (draft->scene.fluid.none)
    draft_refuse(draft, "domain.size", "at most 2^33 cells, not %.4g", cells);
  else
    draft_refuse(draft, "domain.size", "at most 2^33 cells; these would take %.0f GiB at 72 bytes a cell",
                 cells * cell_bytes / gib);
}

/* Paths of the keys of a side. */
struct side_keys {
  const char *type, *velocity;
};

static const struct side_keys side_keys[SIDE_COUNT] = {
    [SIDE_LEFT] = {"domain.left.type", "domain.left.velocity"},
    [SIDE_RIGHT] = {"domain.right.type", "domain.right.velocity"},
    [SIDE_BOTTOM] = {"domain.bottom.type", "domain.bottom.velocity"},
    [SIDE_TOP] = {"domain.top.type", "domain.top.velocity"},
};

static enum side_name opposite(enum side_name side)
{
  static const enum side_name other[] = {SIDE_RIGHT, SIDE_LEFT, SIDE_TOP, SIDE_BOTTOM};
  return other[side];
}

static bool sides_known(const struct draft *draft)
{
  for (int s = 0; s < SIDE_COUNT; s++) {
    if (!draft_knows(draft, side_keys[s].type)) return false;
  }
  return true;
}

static bool has_side(const struct draft *draft, enum side_type type)
{
  for (int s = 0; s < SIDE_COUNT; s++) {
    if (draft->scene.domain.side[s].type == type) return true;
  }
  return false;
}

static void check_side_velocity(struct draft *draft, enum side_name s)
{
  const struct side_keys *keys = &side_keys[s];
  const struct side *side = &draft->scene.domain.side[s];
  const char axis = "xy"[side_axis(s)];
  if (!draft_knows(draft, keys->type) || !draft_knows(draft, keys->velocity)) return;
  bool given = draft_has(draft, keys->velocity);
  const double normal = side->velocity[side_axis(s)];
  const struct side_kind *kind = side_kind_of(side->type);
  if (kind->velocity == VELOCITY_ALONG && normal != 0)
    draft_refuse(draft, keys->velocity, "a velocity along the wall, with no component in %c", axis);
  if (kind->velocity == VELOCITY_INTO && !draft->scene.fluid.none && !(side_is_high(s) ? normal < 0 : normal > 0))
    draft_refuse(draft, keys->velocity, "a velocity into the box, with a component %s 0 in %c",
                 side_is_high(s) ? "<" : ">", axis);
  if (given && kind->velocity == VELOCITY_NONE) draft_refuse(draft, keys->velocity, "no velocity on %s", kind->name);
}

static void check_sides(struct draft *draft)
{
  bool known = sides_known(draft);
  for (int s = 0; s < SIDE_COUNT; s++) {
    check_side_velocity(draft, s);
    const struct side *sides = draft->scene.domain.side;
    enum side_name other = opposite(s);
    if (!known) continue;
    if (sides[s].type == SIDE_PERIODIC && sides[other].type != SIDE_PERIODIC)
      draft_refuse(draft, side_keys[s].type, "the %s side to be periodic too, or neither", side_name_text(other));
    if (sides[s].type == SIDE_INLET && !has_side(draft, SIDE_OUTLET) && !draft->scene.fluid.none)
      draft_refuse(draft, side_keys[s].type, "an outlet on another side, for the inflow");
  }
}

static void refuse_if_given(struct draft *draft, const char *const paths[], size_t count, const char *expected)
{
  for (size_t i = 0; i < count; i++) {
    if (draft_has(draft, paths[i])) draft_refuse(draft, paths[i], "%s", expected);
  }
}

/* Without fluid: refuses the keys of the fluid and of the coupling. */
static void check_keys_of_fluid(struct draft *draft)
{
  size_t count;
  const struct key *keys = key_table(&count);
  for (size_t i = 0; i < count; i++) {
    const char *of_fluid = key_within(keys[i].path, "fluid");
    if (!of_fluid && !key_within(keys[i].path, "coupling")) continue;
    if ((!of_fluid || strcmp(of_fluid, "none") != 0) && draft_has(draft, keys[i].path))
      draft_refuse(draft, keys[i].path, "no such key with fluid: none");
  }
}

/* Without fluid: what needs cells, or fluid that enters, is refused; and there must be discs. */
static void check_dry(struct draft *draft)
{
  const struct scene *scene = &draft->scene;
  if (!scene->fluid.none) return;
  check_keys_of_fluid(draft);
  for (int s = 0; s < SIDE_COUNT; s++)
    if (scene->domain.side[s].type == SIDE_INLET || scene->domain.side[s].type == SIDE_OUTLET)
      draft_refuse(draft, side_keys[s].type, "wall, periodic or slip: with fluid: none no fluid enters or leaves");
  if (scene->contact.area == AREA_CELLS)
    draft_refuse(draft, "contact.area", "lens: areas by cells are those of the cells of a fluid, and there is none");
  if (draft_has(draft, "contact.search") && draft_knows(draft, "contact.search") &&
      scene->contact.search == SEARCH_GRID)
    draft_refuse(draft, "contact.search", "linked-cell: the grid is that of the cells of a fluid, and there is none");
  if (scene->output.fields.every > 0) draft_refuse(draft, "output.fields.every", "0: fluid: none has no fields");
  if (scene->particles.listed == 0 && !scene->particles.fill.present && draft_knows(draft, "particles.discs"))
    draft_refuse(draft, "particles.discs", "at least one disc, since with fluid: none there is nothing else");
}

/* The collision operator decides which rates are allowed. */
static void check_rate_keys(struct draft *draft)
{
  static const char *const paths[] = {"fluid.rates.e", "fluid.rates.q", "fluid.rates.magic", "fluid.magic"};
  if (!draft_knows(draft, "fluid.collision")) return;
  enum collision collision = draft_collision(draft);
  bool magic = draft_has(draft, "fluid.magic"), rates_magic = draft_has(draft, "fluid.rates.magic");
  if (collision == COLLISION_BGK) {
    refuse_if_given(draft, paths, 4, "no such key with collision bgk, whose one rate follows from the viscosity");
    return;
  }
  if (collision == COLLISION_TRT)
    refuse_if_given(draft, paths, 2, "no such key with collision trt, whose rates follow from viscosity and magic");
  if (collision == COLLISION_ADAPTIVE)
    refuse_if_given(draft, &paths[1], 1,
                    "no such key with collision adaptive, whose rate q follows from magic and speed");
  if (magic && rates_magic) draft_refuse(draft, "fluid.rates.magic", "magic once, here or as fluid.magic");
  if (collision == COLLISION_MRT && (magic || rates_magic) && draft_has(draft, "fluid.rates.q"))
    draft_refuse(draft, "fluid.rates.q", "q or magic, which sets q, but not both");
}

/* s_nu and s_q must lie between 0 and 2 also after rounding to floating point. */
static void check_rates(struct draft *draft)
{
  const char *magic = draft_has(draft, "fluid.magic") ? "fluid.magic" : "fluid.rates.magic";
  double viscosity = draft->scene.fluid.viscosity;
  if (draft->scene.fluid.none) return;
  check_rate_keys(draft);
  if (!draft_knows(draft, "fluid.viscosity")) return;
  if (rate_from_viscosity(viscosity) >= 2) {
    draft_refuse(draft, "fluid.viscosity", "a viscosity large enough for 3 viscosity + 1/2 to differ from 1/2");
    return;
  }
  if (!draft_has(draft, magic) || !draft_knows(draft, magic)) return;
  double rate = rate_from_magic(draft->scene.fluid.magic, viscosity);
  if (rate >= 2) draft_refuse(draft, magic, "a value large enough for the rate q to be below 2");
}

/* Areas by cells exist once a step, not once a sub-step. */
static void check_substeps(struct draft *draft)
{
  const struct scene *scene = &draft->scene;
  if (scene->contact.area == AREA_CELLS && scene->contact.substeps > 1)
    draft_refuse(draft, "contact.substeps", "auto or 1: with contact.area: cells the overlap is known once a step");
}

/* Areas are used by contact.law: overlap only. */
static void check_law(struct draft *draft)
{
  if (draft->scene.contact.area == AREA_CELLS && draft->scene.contact.law != SPRING_OVERLAP)
    draft_refuse(draft, "contact.area", "lens: areas by cells are for contact.law: overlap");
}

/* The part of the force that cells resolve was measured for one form. */
static void check_lubrication(struct draft *draft)
{
  const struct scene *scene = &draft->scene;
  if (!(scene->contact.lubrication.cutoff > 0)) return;
  if (scene->fluid.none)
    draft_refuse(draft, "contact.lubrication.cutoff", "0: with fluid: none there is no lubrication");
  else if (scene->coupling.form != FORM_MIDPOINT)
    draft_refuse(draft, "contact.lubrication.cutoff",
                 "0: lubrication is for coupling.form: midpoint, whose resolved part of the force is known");
  else if (scene->coupling.hydraulic_radius < 1)
    draft_refuse(draft, "contact.lubrication.cutoff",
                 "0: with coupling.hydraulic_radius the gap in the fluid is another than that between the discs");
}

/* Restitution determines the damping. */
static void check_restitution(struct draft *draft)
{
  static const char *const paths[] = {"contact.damping", "contact.damping_form"};
  if (draft_has(draft, "contact.restitution"))
    refuse_if_given(draft, paths, 2, "no such key beside contact.restitution, which determines the damping");
}

static void check_zero_flux(struct draft *draft)
{
  if (draft->scene.fluid.none || !draft_has(draft, "fluid.zero_flux") || !draft_knows(draft, "fluid.zero_flux") ||
      !sides_known(draft))
    return;
  bool closed = scene_is_closed(&draft->scene, 0) || scene_is_closed(&draft->scene, 1);
  if (draft->scene.fluid.zero_flux && !closed)
    draft_refuse(draft, "fluid.zero_flux", "false, because walls close neither axis");
}

/* Refuses a disc that would touch its own image across a periodic axis. */
static void check_images(struct draft *draft, double radius, const char *path)
{
  static const char *const names[] = {"x", "y"};
  if (!sides_known(draft) || !draft_knows(draft, "domain.size")) return;
  for (int axis = 0; axis < 2; axis++) {
    int size = draft->scene.domain.size[axis];
    if (scene_is_periodic(&draft->scene, axis) && 2 * radius + clearance > size)
      draft_refuse(draft, path, "2 radius + %g <= %d, the periodic extent in %s", clearance, size, names[axis]);
  }
}

enum { DISC_PATH = 64 };

static const char *disc_path(char path[DISC_PATH], size_t i, const char *name)
{
  snprintf(path, DISC_PATH, "particles.discs.%zu.%s", i, name);
  return path;
}

/* True if a listed disc has passed the checks of the table. */
static bool disc_known(const struct tree_node *list, size_t i)
{
  return !list->entries[i].value->refused;
}

/* Radius of the smallest disc that has passed the checks of the table; INFINITY without one. */
static double smallest_radius(const struct draft *draft)
{
  const struct scene *scene = &draft->scene;
  const struct tree_node *list = tree_find(draft->root, "particles.discs");
  const bool fill = scene->particles.fill.present && draft_knows(draft, "particles.fill.radius");
  double smallest = fill ? scene->particles.fill.radius : INFINITY;
  for (size_t i = 0; list && list->kind == TREE_LIST && i < list->count; i++)
    if (disc_known(list, i)) smallest = fmin(smallest, scene->particles.discs[i].radius);
  return smallest;
}

/* Areas by cells are those of the fluid's cells; R_h has the lower bound of the key of a radius. */
static void check_hydraulic_radius(struct draft *draft)
{
  static const char path[] = "coupling.hydraulic_radius";
  const double min_radius = 0.5, factor = draft->scene.coupling.hydraulic_radius, smallest = smallest_radius(draft);
  if (!draft_knows(draft, path) || factor == 1) return;
  if (draft->scene.contact.area == AREA_CELLS)
    draft_refuse(draft, path, "1 with contact.area: cells, whose overlaps are those of the cells of the fluid");
  if (factor * smallest < min_radius)
    draft_refuse(draft, path, "a part that leaves each disc at least %g cells of radius, not %.3g of %g", min_radius,
                 factor * smallest, smallest);
}

static void check_disc(struct draft *draft, size_t i)
{
  const struct disc_spec *disc = &draft->scene.particles.discs[i];
  const int *size = draft->scene.domain.size;
  const double *at = disc->position, *velocity = disc->velocity;
  char path[DISC_PATH];
  bool inside = at[0] >= 0 && at[0] < size[0] && at[1] >= 0 && at[1] < size[1];
  if (!inside && draft_knows(draft, "domain.size"))
    draft_refuse(draft, disc_path(path, i, "position"), "a centre in the box, 0 <= x < %d and 0 <= y < %d", size[0],
                 size[1]);
  check_images(draft, disc->radius, disc_path(path, i, "radius"));
  if (disc->motion == DISC_FIXED && (velocity[0] != 0 || velocity[1] != 0))
    draft_refuse(draft, disc_path(path, i, "velocity"), "none for a fixed disc, which may only spin");
  double speed = hypot(velocity[0], velocity[1]) + fabs(disc->spin) * disc->radius;
  if (speed > scene_max_speed)
    draft_refuse(draft, disc_path(path, i, disc->spin != 0 ? "spin" : "velocity"),
                 "|velocity| + |spin| radius <= %g, not %.3g, for the sake of %s", scene_max_speed, speed,
                 draft->scene.fluid.none ? "contacts, which a faster disc may miss" : "the Mach number");
}

/* Centre of a disc. */
struct centre {
  double at[2];
  size_t disc;
};

static int compare_centres(const void *a, const void *b)
{
  const struct centre *left = a, *right = b;
  for (int axis = 0; axis < 2; axis++) {
    if (left->at[axis] < right->at[axis]) return -1;
    if (left->at[axis] > right->at[axis]) return 1;
  }
  return (left->disc > right->disc) - (left->disc < right->disc);
}

/* Refuses two discs with the same centre: their contact has no normal. */
static bool check_centres(struct draft *draft, const struct tree_node *list, struct status *status)
{
  size_t count = 0;
  struct centre *centres = memory_allocate(list->count, sizeof *centres, "the discs' centres", status);
  if (!centres) return false;
  for (size_t i = 0; i < list->count; i++) {
    const double *at = draft->scene.particles.discs[i].position;
    if (disc_known(list, i)) centres[count++] = (struct centre){{at[0], at[1]}, i};
  }
  qsort(centres, count, sizeof *centres, compare_centres);
  for (size_t i = 1; i < count; i++) {
    const struct centre *one = &centres[i - 1], *two = &centres[i];
    char path[DISC_PATH];
    if (one->at[0] == two->at[0] && one->at[1] == two->at[1])
      draft_refuse(draft, disc_path(path, two->disc, "position"), "another: discs %zu and %zu have the same centre",
                   one->disc, two->disc);
  }
  free(centres);
  return true;
}

/* Limits the number of overlapping pairs, which would exceed memory. */
static void check_cover(struct draft *draft, const struct tree_node *list)
{
  const double box = (double)draft->scene.domain.size[0] * draft->scene.domain.size[1];
  double covered = 0;
  for (size_t i = 0; i < list->count; i++) {
    const double radius = draft->scene.particles.discs[i].radius;
    if (disc_known(list, i)) covered += fmin(M_PI * radius * radius, box);
  }
  if (draft_knows(draft, "domain.size") && covered > max_cover * box)
    draft_refuse(draft, "particles.discs", "discs with a total area of at most %g times the box, not %.4g times",
                 max_cover, covered / box);
}

/* Refuses overlaps that contacts would push apart faster than fluid flows in (case_overlaps.h). */
static void check_depth(struct draft *draft, const struct case_overlap *overlap)
{
  const bool side = case_overlap_is_with_side(overlap);
  char path[DISC_PATH];
  disc_path(path, overlap->a, "position");
  if (side && overlap->depth > max_depth_in_side)
    draft_refuse(
        draft, path,
        "at most %g cells beyond a side, not %.3g beyond the %s one, since fluid has to flow in as the disc leaves it",
        max_depth_in_side, overlap->depth, side_name_text((enum side_name)(overlap->b - overlap_sides)));
  if (!side && overlap->depth > max_depth_in_disc)
    draft_refuse(
        draft, path,
        "at most %g cells within another disc, not %.3g within disc %zu, since fluid has to flow in as they part",
        max_depth_in_disc, overlap->depth, overlap->b);
}

/* Largest overlap with a side of a disc at distance `gap` with this speed, at most its diameter. Kinetic energy on arrival
 * (in fluid: drag coefficient 1 of R_h, mass of the fluid inside included) equals the energy of the contact's spring. */
static double depth_of_impact(const struct draft *draft, const struct disc_spec *disc, double gap, double speed)
{
  const struct scene *scene = &draft->scene;
  const double mass = load_mass(scene, disc), hydraulic = scene_hydraulic_radius(scene, disc);
  const double arrival = scene->fluid.none ? speed : speed * exp(-gap * hydraulic / mass);
  const struct contact_law law = contact_law_of(scene);
  double low = 0, high = 2 * disc->radius;
  for (int k = 0; k < 40; k++) {
    const double middle = 0.5 * (low + high);
    const bool deeper =
        contact_energy(&law, (const double[2]){disc->radius, INFINITY}, middle) < 0.5 * mass * arrival * arrival;
    *(deeper ? &low : &high) = middle;
  }
  return high;
}

static void check_impact(struct draft *draft, size_t i)
{
  const struct scene *scene = &draft->scene;
  const struct disc_spec *disc = &scene->particles.discs[i];
  const double max_depth = scene->fluid.none ? disc->radius : max_depth_in_side;
  for (enum side_name side = 0; side < SIDE_COUNT && disc->motion == DISC_FREE; side++) {
    const double towards = disc->velocity[side_axis(side)], speed = side_is_high(side) ? towards : -towards;
    const double gap = scene_distance_to_side(scene, side, disc->position) - disc->radius;
    if (scene->domain.side[side].type == SIDE_PERIODIC || speed <= 0) continue;
    const double depth = depth_of_impact(draft, disc, fmax(0, gap), speed);
    char path[DISC_PATH];
    if (depth > max_depth)
      draft_refuse(
          draft, disc_path(path, i, "velocity"),
          "one that takes the disc at most %g cells beyond the %s side, not %.3g; a larger contact.stiffness stops "
          "it sooner",
          max_depth, side_name_text(side), depth);
  }
}

static bool check_depths(struct draft *draft, const struct tree_node *list, struct status *status)
{
  struct case_overlaps found;
  const bool in_contact = draft_is_auto(draft, "contact.stiffness") || draft->scene.contact.stiffness > 0;
  bool known = sides_known(draft) && draft_knows(draft, "domain.size") && in_contact;
  for (size_t i = 0; i < list->count; i++) known = known && disc_known(list, i);
  if (!known || case_errors_total(draft->errors) > 0) return true; /* wrong positions are reported first */
  const bool ok = case_overlaps_find(&draft->scene, list->count, &found, status);
  for (size_t k = 0; ok && k < found.count && !draft->scene.fluid.none; k++) check_depth(draft, &found.list[k]);
  case_overlaps_clear(&found);
  return ok;
}

static bool check_discs(struct draft *draft, struct status *status)
{
  const struct tree_node *list = tree_find(draft->root, "particles.discs");
  if (!list || list->kind != TREE_LIST) return true;
  for (size_t i = 0; i < list->count; i++) {
    if (disc_known(list, i)) check_disc(draft, i);
  }
  check_cover(draft, list);
  return check_centres(draft, list, status) && check_depths(draft, list, status);
}

/* A free disc needs a density, its own or particles.density. */
static void check_density(struct draft *draft)
{
  const struct scene *scene = &draft->scene;
  if (draft_has(draft, "particles.density")) return;
  if (scene->particles.fill.present && !draft_has(draft, "particles.fill.density")) {
    draft_refuse(draft, "particles.density", "a number > 0, because the discs of particles.fill have no other density");
    return;
  }
  const struct tree_node *list = tree_find(draft->root, "particles.discs");
  for (size_t i = 0; i < scene->particles.listed; i++) {
    const struct disc_spec *disc = &scene->particles.discs[i];
    if (!disc_known(list, i) || disc->motion != DISC_FREE || disc->density > 0) continue;
    draft_refuse(draft, "particles.density", "a number > 0, because disc %zu is free and has no density of its own", i);
    return;
  }
}

static bool check_region(struct draft *draft, const char *path, const double region[4])
{
  const int *size = draft->scene.domain.size;
  bool inside = region[2] <= size[0] && region[3] <= size[1];
  if (region[0] < region[2] && region[1] < region[3] && inside) return true;
  draft_refuse(draft, path, "0 <= x0 < x1 <= %d and 0 <= y0 < y1 <= %d", size[0], size[1]);
  return false;
}

static void check_count(struct draft *draft, const double region[4])
{
  double spacing = draft->scene.particles.fill.spacing;
  double columns = fill_grid_cells(region, spacing, 0), rows = fill_grid_cells(region, spacing, 1);
  if (columns < 1 || rows < 1) {
    draft_refuse(draft, "particles.fill.spacing",
                 "at most the width and the height of the region, so that a disc fits");
    return;
  }
  double discs = columns * rows + (double)draft->scene.particles.listed;
  if (discs > max_discs)
    draft_refuse(draft, "particles.fill.spacing", "at most %.0f discs; these would be %.0f and take %.1f GiB to list",
                 max_discs, discs, discs * sizeof(struct disc_spec) / gib);
}

/* Extends a region to the edge of the box if both were equal before the box was rounded to whole cells. */
static void end_with_box(const struct draft *draft, double region[4])
{
  for (int axis = 0; axis < 2; axis++) {
    const double size = draft->scene.domain.size[axis];
    if (region[2 + axis] > size && region[2 + axis] <= draft->size_as_given[axis]) region[2 + axis] = size;
  }
}

static void check_fill(struct draft *draft)
{
  struct fill_spec *fill = &draft->scene.particles.fill;
  const bool radius = draft_knows(draft, "particles.fill.radius");
  const bool spacing = draft_knows(draft, "particles.fill.spacing");
  const bool region = draft_knows(draft, "particles.fill.region") && draft_knows(draft, "domain.size");
  if (!fill->present || !draft_knows(draft, "particles.fill")) return;
  if (radius && spacing && fill->spacing < 2 * fill->radius)
    draft_refuse(draft, "particles.fill.spacing", "at least 2 radius = %g", 2 * fill->radius);
  if (radius) check_images(draft, fill->radius, "particles.fill.radius");
  if (spacing && draft_knows(draft, "particles.fill.jitter") && fill->jitter > fill->spacing / 2)
    draft_refuse(draft, "particles.fill.jitter", "at most half the spacing = %g", fill->spacing / 2);
  if (!region) return;
  double box[4];
  end_with_box(draft, fill->region);
  draft_fill_region(draft, box);
  if (check_region(draft, "particles.fill.region", box) && spacing) check_count(draft, box);
}

/* output.fields.region: at least one cell, within the box. */
static void check_shown(struct draft *draft)
{
  static const char path[] = "output.fields.region";
  if (draft_has(draft, path) && draft_knows(draft, path) && draft_knows(draft, "domain.size"))
    check_region(draft, path, draft->scene.output.fields.region);
}

bool case_check(struct draft *draft, struct status *status)
{
  case_units_check(draft);
  check_cells(draft);
  check_sides(draft);
  check_dry(draft);
  check_rates(draft);
  check_zero_flux(draft);
  check_substeps(draft);
  check_law(draft);
  check_restitution(draft);
  check_lubrication(draft);
  check_fill(draft);
  check_hydraulic_radius(draft);
  check_shown(draft);
  check_density(draft);
  return check_discs(draft, status);
}

bool case_check_impacts(struct draft *draft)
{
  const struct scene *scene = &draft->scene;
  for (size_t i = 0; scene->contact.stiffness > 0 && i < scene->particles.listed; i++) check_impact(draft, i);
  return case_errors_total(draft->errors) == 0;
}
