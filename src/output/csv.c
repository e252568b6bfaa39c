#include "output/csv.h"

#include <stddef.h>
#include <string.h>

static const struct table_key keys[] = {{"step", "step"}, {"id", "disc"}};

static const struct table_column columns[] = {
    {"x", offsetof(struct discs, x), "cells"},
    {"y", offsetof(struct discs, y), "cells"},
    {"vx", offsetof(struct discs, vx), "cells/step"},
    {"vy", offsetof(struct discs, vy), "cells/step"},
    {"omega", offsetof(struct discs, omega), "radians/step"},
    {"angle", offsetof(struct discs, angle), "radians"},
    {"fx", offsetof(struct discs, fx), "fluid density*cells^3/step^2"},
    {"fy", offsetof(struct discs, fy), "fluid density*cells^3/step^2"},
    {"torque", offsetof(struct discs, torque), "fluid density*cells^4/step^2"},
    {"contact_fx", offsetof(struct discs, contact_fx), "fluid density*cells^3/step^2"},
    {"contact_fy", offsetof(struct discs, contact_fy), "fluid density*cells^3/step^2"},
    {"contact_torque", offsetof(struct discs, contact_torque), "fluid density*cells^4/step^2"},
};

enum { KEY_COUNT = sizeof keys / sizeof keys[0], COLUMN_COUNT = sizeof columns / sizeof columns[0] };

const struct table_layout csv_layout = {keys, KEY_COUNT, columns, COLUMN_COUNT};

static double column_value(const struct table_column *column, const struct discs *discs, size_t disc)
{
  const double *values;
  memcpy(&values, (const char *)discs + column->member, sizeof values);
  return values[disc];
}

bool csv_write(struct table *table, int64_t step, const struct discs *discs, struct status *status)
{
  if (!table_begin(table, status)) return false;
  for (size_t disc = 0; disc < discs->count; disc++) {
    double values[COLUMN_COUNT];
    for (size_t k = 0; k < COLUMN_COUNT; k++) values[k] = column_value(&columns[k], discs, disc);
    if (!table_add(table, (const int64_t[KEY_COUNT]){step, (int64_t)disc}, values, status)) return false;
  }
  return table_write(table, status);
}
