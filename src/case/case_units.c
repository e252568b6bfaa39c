#include "case/case_units.h"

#include "case/case_keys.h"
#include "case/case_query.h"
#include "case/case_value.h"

#include <string.h>

static const struct units none;

/* Reads one key of the block if it is present and valid. */
static void read_own(struct draft *draft, const struct tree_node *block, const char *name)
{
  const struct key *key;
  const struct tree_entry *entry = tree_entry(block, name);
  if (entry && key_role("units", name, &key) == ROLE_KEY) value_read(key, entry->value, &none, draft);
}

/* dt at which the physical viscosity becomes units.viscosity on the lattice. */
static double step_from_viscosity(const struct draft *draft)
{
  const struct tree_node *given = tree_find(draft->root, "fluid.viscosity");
  const struct units metres = {.dx = 1, .dt = 1};
  struct unit from, to;
  double viscosity;
  unit_parse("m^2/s", &metres, &to);
  if (!given || !value_quantity(given, &viscosity, &from) || !unit_same_dimension(&from, &to) || viscosity <= 0)
    return 0;
  const double dx = draft->scene.units.dx, dt = draft->lattice_viscosity * dx * dx;
  return unit_convert(dt / unit_convert(viscosity, &from, &to), &to, &to);
}

void case_units_read(struct draft *draft)
{
  static const char *const names[] = {"dx", "dt", "viscosity", "density"};
  const struct tree_node *block = tree_find(draft->root, "units");
  if (!block || block->kind != TREE_MAPPING) return;
  for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) read_own(draft, block, names[i]);
  struct units *units = &draft->scene.units;
  if (units->dt == 0 && draft->lattice_viscosity > 0 && units->dx > 0) units->dt = step_from_viscosity(draft);
}

/* True if the block needs fluid.viscosity to determine dt, and fluid.viscosity is valid but has no physical unit. */
static bool step_is_open(const struct draft *draft)
{
  const struct units *units = &draft->scene.units;
  const struct tree_node *node = tree_find(draft->root, "fluid.viscosity");
  const struct key *key;
  if (units->dx == 0 || units->dt > 0 || draft->lattice_viscosity == 0 || !node) return false;
  return key_role("fluid", "viscosity", &key) == ROLE_KEY && (!node->refused || value_lacks_units(key, node, units));
}

void case_units_check(struct draft *draft)
{
  if (!draft_has(draft, "units") || !draft_knows(draft, "units")) return;
  const bool dt = draft_has(draft, "units.dt"), viscosity = draft_has(draft, "units.viscosity");
  if (!draft_has(draft, "units.dx")) draft_refuse(draft, "units.dx", "the length of a cell, such as 0.1 mm");
  if (dt && viscosity) draft_refuse(draft, "units.viscosity", "dt or viscosity, from which dt follows, not both");
  if (!dt && !viscosity)
    draft_refuse(draft, "units.dt", "the duration of a step, such as 0.5 ms%s",
                 draft->scene.fluid.none ? "" : ", or units.viscosity");
  if (!dt && viscosity && draft->scene.fluid.none)
    draft_refuse(draft, "units.viscosity", "units.dt in its place: fluid: none has no viscosity from which dt follows");
  else if (!dt && viscosity && step_is_open(draft))
    draft_refuse(draft, "fluid.viscosity", "a viscosity > 0 in m^2/s, from which and from units.viscosity dt follows");
}
