#include "output/series.h"

#include <stddef.h>
#include <string.h>

static const struct table_key keys[] = {{"step", "step"}};

/* Scripts rely on the order: a new column is the last. */
static const struct table_column columns[] = {
    {"kinetic_fluid", offsetof(struct instant, kinetic_fluid), "fluid density*cells^4/step^2"},
    {"kinetic_discs", offsetof(struct instant, kinetic_discs), "fluid density*cells^4/step^2"},
    {"mean_ux", offsetof(struct instant, mean_velocity[0]), "cells/step"},
    {"mean_uy", offsetof(struct instant, mean_velocity[1]), "cells/step"},
    {"excess_mass", offsetof(struct instant, excess_mass), "fluid density*cells^2"},
    {"max_mach", offsetof(struct instant, max_mach), ""},
    {"contacts", offsetof(struct instant, contacts), ""},
    {"max_overlap", offsetof(struct instant, max_overlap), ""},
};

enum { KEY_COUNT = sizeof keys / sizeof keys[0], COLUMN_COUNT = sizeof columns / sizeof columns[0] };

const struct table_layout series_layout = {keys, KEY_COUNT, columns, COLUMN_COUNT};

bool series_write(struct table *table, int64_t step, const struct instant *instant, struct status *status)
{
  double values[COLUMN_COUNT];
  for (size_t k = 0; k < COLUMN_COUNT; k++)
    memcpy(&values[k], (const char *)instant + columns[k].member, sizeof values[k]);
  return table_begin(table, status) && table_add(table, &step, values, status) && table_write(table, status);
}
