#include "contact/table.h"

#include "base/memory.h"
#include "base/variant.h"
#include "contact/place.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { DOUBLE_ARRAYS = 24 };

bool table_create(struct contact_table *t, size_t discs, struct status *status)
{
  const char *what = "the contacts";
  *t = (struct contact_table){0};
  if ((t->member = memory_allocate(discs, sizeof *t->member, what, status)) &&
      (t->first = memory_allocate(discs + 1, sizeof *t->first, what, status)) &&
      (t->count = memory_allocate(discs + 1, sizeof *t->count, what, status)))
    return true;
  table_destroy(t);
  return false;
}

void table_destroy(struct contact_table *t)
{
  free(t->block);
  free(t->ends);
  free(t->member);
  free(t->first);
  free(t->count);
  *t = (struct contact_table){0};
}

/* Assigns the arrays of entries to parts of one block of memory. */
static void carve(struct contact_table *t, size_t entries)
{
  double **const doubles[DOUBLE_ARRAYS] = {&t->radius[0],
                                           &t->radius[1],
                                           &t->strength,
                                           &t->damper,
                                           &t->friction,
                                           &t->max_moment,
                                           &t->inverse_mass,
                                           &t->slip_compliance,
                                           &t->roll_compliance,
                                           &t->rolling_damper,
                                           &t->stored,
                                           &t->impulse,
                                           &t->spring_impulse,
                                           &t->approach_speed,
                                           &t->shear,
                                           &t->shear_stiffness,
                                           &t->moment,
                                           &t->moment_stiffness,
                                           &t->cells_area,
                                           &t->film,
                                           &t->fx,
                                           &t->fy,
                                           &t->torque_a,
                                           &t->torque_b};
  char *at = t->block;
  for (size_t k = 0; k < DOUBLE_ARRAYS; k++, at += entries * sizeof(double)) *doubles[k] = (double *)(void *)at;
  t->a = (uint32_t *)(void *)at;
  t->b = t->a + entries;
  t->live = (uint8_t *)(t->b + entries);
  t->is_near = t->live + entries;
  t->near = t->is_near + entries;
  t->near_count = t->near + entries;
}

/* Bytes of an entry, its part of near_count included. */
static size_t entry_bytes(void)
{
  return DOUBLE_ARRAYS * sizeof(double) + 2 * sizeof(uint32_t) + 4;
}

/* True for a contact that a free disc takes part in. */
static bool acts_on(const struct discs *d, uint32_t a, uint32_t b)
{
  return d->motion[a] == DISC_FREE || (!contact_is_with_side(b) && d->motion[b] == DISC_FREE);
}

static size_t count_pairs(const struct discs *d, const struct pair_list *list)
{
  size_t count = 0;
  for (size_t k = 0; k < list->count; k++) count += acts_on(d, list->pairs[k].a, list->pairs[k].b);
  return count;
}

/* Gap of disc i to a side below that of the list. */
static bool is_beside(const struct scene *scene, const struct discs *d, size_t i, enum side_name side, double within)
{
  const double place[2] = {d->x[i], d->y[i]};
  return scene->domain.side[side].type != SIDE_PERIODIC && d->motion[i] == DISC_FREE &&
         scene_distance_to_side(scene, side, place) < d->radius[i] + within;
}

static size_t count_sides(const struct scene *scene, const struct discs *d, double within)
{
  size_t count = 0;
  for (size_t i = 0; i < d->count; i++)
    for (enum side_name side = 0; side < SIDE_COUNT; side++) count += is_beside(scene, d, i, side, within);
  return count;
}

static size_t blocks_of(size_t entries)
{
  return (entries + CONTACT_BLOCK - 1) / CONTACT_BLOCK;
}

static bool reserve(struct contact_table *t, size_t pairs, size_t sides, struct status *status)
{
  t->pairs = pairs;
  t->sides = sides;
  t->pair_blocks = blocks_of(pairs);
  t->blocks = t->pair_blocks + blocks_of(sides);
  if (!memory_grow(&t->block, &t->block_capacity, t->blocks * CONTACT_BLOCK, entry_bytes(), "the contacts", status) ||
      !memory_grow(&t->ends, &t->end_capacity, 2 * pairs + sides, sizeof *t->end, "the contacts", status))
    return false;
  if (t->block) memset(t->block, 0, t->block_capacity * entry_bytes());
  t->end = t->ends;
  carve(t, t->block_capacity);
  return true;
}

static void add_entry(struct contact_table *t, size_t e, uint32_t a, uint32_t b, const struct contact_states *saved,
                      size_t *at)
{
  const struct contact_state *s = states_next(saved, at, a, b);
  t->a[e] = a;
  t->b[e] = b;
  t->count[a + 1]++;
  if (!contact_is_with_side(b)) t->count[b + 1]++;
  if (!s) return;
  t->live[e] = 1;
  t->stored[e] = s->stored;
  t->impulse[e] = s->impulse;
  t->spring_impulse[e] = s->spring_impulse;
  t->approach_speed[e] = s->approach_speed;
  t->shear[e] = s->shear;
  t->shear_stiffness[e] = s->shear_stiffness;
  t->moment[e] = s->moment;
  t->moment_stiffness[e] = s->moment_stiffness;
}

static void add_end(struct contact_table *t, size_t disc, size_t end)
{
  t->end[t->count[disc]++] = (uint32_t)end;
}

/* Ends by disc: counting sort, so that the ends of a disc are in the order of the entries. */
static void sort_ends(struct contact_table *t, size_t discs)
{
  t->members = 0;
  for (size_t i = 0; i < discs; i++) {
    const bool any = t->count[i + 1] > 0;
    t->count[i + 1] += t->count[i];
    if (!any) continue;
    t->member[t->members] = (uint32_t)i;
    t->first[t->members++] = t->count[i];
  }
  t->first[t->members] = t->count[discs];
  for (size_t e = 0; e < t->pairs; e++) {
    add_end(t, t->a[e], 2 * e);
    add_end(t, t->b[e], 2 * e + 1);
  }
  for (size_t k = 0; k < t->sides; k++) {
    const size_t e = table_first(t->pair_blocks) + k;
    add_end(t, t->a[e], 2 * e);
  }
}

bool table_build(struct contact_table *t, const struct scene *scene, const struct discs *d,
                 const struct pair_list *list, const struct contact_states *saved, struct status *status)
{
  const size_t pairs = count_pairs(d, list), sides = count_sides(scene, d, list->within);
  size_t at = 0, e = 0;
  if (!reserve(t, pairs, sides, status)) return false;
  memset(t->count, 0, (d->count + 1) * sizeof *t->count);
  for (size_t k = 0; k < list->count; k++)
    if (acts_on(d, list->pairs[k].a, list->pairs[k].b))
      add_entry(t, e++, list->pairs[k].a, list->pairs[k].b, saved, &at);
  e = table_first(t->pair_blocks);
  for (uint32_t i = 0; i < d->count; i++)
    for (enum side_name side = 0; side < SIDE_COUNT; side++)
      if (is_beside(scene, d, i, side, list->within)) add_entry(t, e++, i, contact_sides + side, saved, &at);
  sort_ends(t, d->count);
  return true;
}

static double inverse_mass(const struct discs *d, uint32_t i)
{
  return d->motion[i] == DISC_FREE ? 1 / d->mass[i] : 0;
}

static double inverse_inertia(const struct discs *d, uint32_t i)
{
  return d->motion[i] == DISC_FREE ? 1 / d->inertia[i] : 0;
}

/* Discs slide and roll on walls; other sides are smooth. */
static bool is_rough(const struct scene *scene, uint32_t b)
{
  return !contact_is_with_side(b) || scene->domain.side[b - contact_sides].type == SIDE_WALL;
}

void table_fill(struct contact_table *t, const struct scene *scene, const struct discs *d,
                const struct contact_law *law, size_t block)
{
  for (int k = 0; k < table_entries(t, block); k++) {
    const size_t e = table_first(block) + (size_t)k;
    const uint32_t a = t->a[e], b = t->b[e];
    const bool side = contact_is_with_side(b);
    const double radius[2] = {d->radius[a], side ? INFINITY : d->radius[b]};
    const double reduced = 1 / (1 / radius[0] + 1 / radius[1]);
    for (int end = 0; end < 2; end++) t->radius[end][e] = radius[end];
    t->strength[e] = contact_strength(law, radius);
    const double mass = inverse_mass(d, a) + (side ? 0 : inverse_mass(d, b));
    const double turn = inverse_inertia(d, a) + (side ? 0 : inverse_inertia(d, b));
    t->damper[e] = contact_damping(law, mass, 1);
    t->inverse_mass[e] = mass;
    t->slip_compliance[e] = mass + radius[0] * radius[0] * inverse_inertia(d, a) +
                            (side ? 0 : radius[1] * radius[1] * inverse_inertia(d, b));
    t->roll_compliance[e] = turn;
    t->friction[e] = is_rough(scene, b) ? law->friction : 0;
    t->max_moment[e] = is_rough(scene, b) ? law->rolling_friction * reduced : 0;
    t->rolling_damper[e] = 2 * law->damping * t->max_moment[e] * sqrt(3 / turn);
  }
}

double table_depth(const struct contact_table *t, const struct scene *scene, const struct discs *d, size_t e)
{
  const uint32_t a = t->a[e], b = t->b[e];
  const bool side = contact_is_with_side(b);
  const struct shape_kind *kind = d->shape[a].kind;
  struct body_pairs pair = {.count = VECTOR};
  struct body_overlaps overlaps;
  for (int k = 0; k < VECTOR; k++) {
    for (int end = 0; end < 2; end++) pair.radius[end][k] = t->radius[end][e];
    side ? place_side(scene, d->x, d->y, a, b, &pair, k) : place_body(d->x, d->y, a, b, &pair, k);
  }
  if (!side) place_nearest_images(scene, &pair);
  (side ? kind->overlaps_half_plane : kind->overlaps)(&pair, &overlaps);
  return overlaps.depth[0];
}

static void save_entry(const struct contact_table *t, size_t e, struct contact_states *states)
{
  const struct contact_state state = {.stored = t->stored[e],
                                      .impulse = t->impulse[e],
                                      .spring_impulse = t->spring_impulse[e],
                                      .approach_speed = t->approach_speed[e],
                                      .shear = t->shear[e],
                                      .shear_stiffness = t->shear_stiffness[e],
                                      .moment = t->moment[e],
                                      .moment_stiffness = t->moment_stiffness[e]};
  if (t->live[e]) states_add(states, t->a[e], t->b[e], &state);
}

bool table_states(const struct contact_table *t, struct contact_states *states, struct status *status)
{
  if (!states_reserve(states, t->pairs + t->sides, status)) return false;
  states_clear(states);
  for (size_t block = 0; block < t->blocks; block++)
    for (int k = 0; k < table_entries(t, block); k++) save_entry(t, table_first(block) + (size_t)k, states);
  return true;
}
