#include "output/csv.h"

#include "base/memory.h"
#include "output/file.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* With a separator: the longest "%.17g" is -2.2250738585072014e-308 (24 characters), the longest integer has 20. */
enum { NUMBER_LENGTH = 25, INTEGER_LENGTH = 21 };

struct column {
  const char *name;
  size_t member;    /* offset of the array in struct discs */
  const char *unit; /* of the lattice */
};

static const struct column columns[] = {
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

enum {
  COLUMN_COUNT = sizeof columns / sizeof columns[0],
  /* with SI columns, time and the final zero of snprintf */
  ROW_LENGTH = 2 * INTEGER_LENGTH + (2 * COLUMN_COUNT + 1) * NUMBER_LENGTH + 1
};

struct csv {
  int descriptor;
  char *path;
  off_t size;    /* of the file */
  char *text;    /* the snapshot being formatted */
  size_t length; /* of the text */
  size_t capacity;
  double second;              /* of a step; 0: no SI columns */
  double scale[COLUMN_COUNT]; /* of each column in SI; 0: left out */
};

static double column_value(const struct column *column, const struct discs *discs, size_t disc)
{
  const double *values;
  memcpy(&values, (const char *)discs + column->member, sizeof values);
  return values[disc];
}

/* Writes the text and empties it. On failure the file is truncated to its old length: a snapshot is complete or
 * absent. */
static bool write_text(struct csv *csv, struct status *status)
{
  size_t done = 0;
  while (done < csv->length) {
    ssize_t written = write(csv->descriptor, csv->text + done, csv->length - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      int error = errno;
      bool whole = done == 0 || ftruncate(csv->descriptor, csv->size) == 0;
      return status_fail(status, DELBM_IO, "cannot write %s: %s%s", csv->path, strerror(error),
                         whole ? "" : "; its last row is cut off");
    }
    done += (size_t)written;
  }
  csv->size += (off_t)csv->length;
  csv->length = 0;
  return true;
}

static bool reserve_row(struct csv *csv, struct status *status)
{
  return memory_grow(&csv->text, &csv->capacity, csv->length + ROW_LENGTH, 1, "a snapshot of the discs", status);
}

/* Sets the factors from lattice to SI units. */
static void set_scales(struct csv *csv, const struct units *units)
{
  csv->second = units->dt;
  for (size_t k = 0; k < COLUMN_COUNT; k++) {
    struct unit unit;
    const bool known = unit_parse(columns[k].unit, units, &unit) && (unit.length || unit.time);
    csv->scale[k] = known && units->dt > 0 ? (double)unit.scale : 0;
  }
}

/* ",vx[m/s]" and so on. */
static size_t put_si_header(const struct csv *csv, char *text, size_t size)
{
  size_t length = csv->second > 0 ? (size_t)snprintf(text, size, ",t[s]") : 0;
  for (size_t k = 0; k < COLUMN_COUNT; k++) {
    struct unit unit;
    char si[UNIT_TEXT];
    if (csv->scale[k] == 0 || !unit_parse(columns[k].unit, &(struct units){0}, &unit)) continue;
    unit_si_text(&unit, si);
    length += (size_t)snprintf(text + length, size - length, ",%s[%s]", columns[k].name, si);
  }
  return length;
}

static bool write_header(struct csv *csv, struct status *status)
{
  if (!reserve_row(csv, status)) return false;
  csv->length = (size_t)snprintf(csv->text, ROW_LENGTH, "step,id");
  for (const struct column *column = columns; column < columns + COLUMN_COUNT; column++)
    csv->length += (size_t)snprintf(csv->text + csv->length, ROW_LENGTH - csv->length, ",%s", column->name);
  csv->length += put_si_header(csv, csv->text + csv->length, ROW_LENGTH - csv->length);
  csv->text[csv->length++] = '\n';
  return write_text(csv, status);
}

/* Opens the file, with its content or, if `anew`, empty. */
static bool open_file(struct csv **csv, const char *path, const struct units *units, bool anew, struct status *status)
{
  *csv = memory_allocate(1, sizeof **csv, "the table of discs", status);
  if (!*csv) return false;
  const int flags = O_WRONLY | O_APPEND;
  (*csv)->descriptor = anew ? file_create(path, flags, status) : file_reopen(path, flags, status);
  if ((*csv)->descriptor < 0) {
    free(*csv);
    *csv = NULL;
    return false;
  }
  set_scales(*csv, units);
  (*csv)->path = strdup(path);
  return (*csv)->path || file_fail(status, "open", path, ENOMEM);
}

static bool close_unless(bool good, struct csv **csv)
{
  struct status ignored;
  if (!good) csv_close(csv, &ignored);
  return good;
}

bool csv_open(struct csv **csv, const char *path, const struct units *units, struct status *status)
{
  return close_unless(open_file(csv, path, units, true, status) && write_header(*csv, status), csv);
}

/* Truncates the file; fails if it is shorter than `length`. */
static bool cut_back(struct csv *csv, int64_t length, struct status *status)
{
  if (!file_reaches(csv->descriptor, csv->path, length, status)) return false;
  csv->size = length;
  return ftruncate(csv->descriptor, length) == 0 || file_fail(status, "write", csv->path, errno);
}

bool csv_reopen(struct csv **csv, const char *path, const struct units *units, int64_t length, struct status *status)
{
  return close_unless(open_file(csv, path, units, false, status) && cut_back(*csv, length, status), csv);
}

bool csv_sync(struct csv *csv, int64_t *length, struct status *status)
{
  *length = csv->size;
  return file_sync(csv->descriptor, csv->path, status);
}

/* Fast path for 0, by far the most frequent number: most discs have no contact. */
static size_t format_number(char *text, double value)
{
  if (value == 0 && !signbit(value)) {
    memcpy(text, "0", 2);
    return 1;
  }
  return (size_t)snprintf(text, NUMBER_LENGTH, "%.17g", value);
}

static char *put_si(const struct csv *csv, int64_t step, const struct discs *discs, size_t disc, char *text)
{
  if (csv->second == 0) return text;
  *text++ = ',';
  text += format_number(text, (double)step * csv->second);
  for (size_t k = 0; k < COLUMN_COUNT; k++) {
    if (csv->scale[k] == 0) continue;
    *text++ = ',';
    text += format_number(text, column_value(&columns[k], discs, disc) * csv->scale[k]);
  }
  return text;
}

static bool append_row(struct csv *csv, int64_t step, const struct discs *discs, size_t disc, struct status *status)
{
  char *text = csv->text + csv->length;
  text += snprintf(text, 2 * INTEGER_LENGTH, "%" PRId64 ",%zu", step, disc);
  for (const struct column *column = columns; column < columns + COLUMN_COUNT; column++) {
    double value = column_value(column, discs, disc);
    if (!isfinite(value))
      return status_fail(status, DELBM_FAILED, "step %" PRId64 ", disc %zu: %s is %g", step, disc, column->name, value);
    *text++ = ',';
    text += format_number(text, value);
  }
  text = put_si(csv, step, discs, disc, text);
  *text++ = '\n';
  csv->length = (size_t)(text - csv->text);
  return true;
}

bool csv_write(struct csv *csv, int64_t step, const struct discs *discs, struct status *status)
{
  if (!file_stays(csv->descriptor, csv->path, status)) return false;
  csv->length = 0;
  for (size_t disc = 0; disc < discs->count; disc++) {
    if (!reserve_row(csv, status)) return false;
    if (!append_row(csv, step, discs, disc, status)) return false;
  }
  return write_text(csv, status);
}

bool csv_close(struct csv **csv, struct status *status)
{
  if (!*csv) return true;
  bool closed = close((*csv)->descriptor) == 0 || file_fail(status, "close", (*csv)->path, errno);
  free((*csv)->text);
  free((*csv)->path);
  free(*csv);
  *csv = NULL;
  return closed;
}
