#include "output/table.h"

#include "base/memory.h"
#include "output/file.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* With a separator: the longest "%.17g" is -2.2250738585072014e-308 (24 characters), the longest integer has 20. */
enum { NUMBER_LENGTH = 25, INTEGER_LENGTH = 21 };

struct table {
  const struct table_layout *layout;
  int descriptor;
  char *path;
  off_t size;    /* of the file */
  char *text;    /* the block being formatted */
  size_t length; /* of the text */
  size_t capacity;
  double second;  /* of a step; 0: no SI columns */
  double scale[]; /* [column] in SI; 0: left out */
};

/* Writes the text and empties it. On failure the file is truncated to its old length. */
static bool write_text(struct table *t, struct status *status)
{
  size_t done = 0;
  while (done < t->length) {
    ssize_t written = write(t->descriptor, t->text + done, t->length - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      int error = errno;
      bool whole = done == 0 || ftruncate(t->descriptor, t->size) == 0;
      return status_fail(status, DELBM_IO, "cannot write %s: %s%s", t->path, strerror(error),
                         whole ? "" : "; its last row is cut off");
    }
    done += (size_t)written;
  }
  t->size += (off_t)t->length;
  t->length = 0;
  return true;
}

static bool reserve(struct table *t, size_t bytes, struct status *status)
{
  return memory_grow(&t->text, &t->capacity, t->length + bytes, 1, "rows of a table", status);
}

/* Sets the factors from lattice to SI units. */
static void set_scales(struct table *t, const struct units *units)
{
  t->second = units->dt;
  for (size_t k = 0; k < t->layout->count; k++) {
    struct unit unit;
    const bool known = unit_parse(t->layout->columns[k].unit, units, &unit) && (unit.length || unit.time);
    t->scale[k] = known && units->dt > 0 ? (double)unit.scale : 0;
  }
}

/* Appends to the text, within its capacity. */
__attribute__((format(printf, 2, 3))) static void put(struct table *t, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  t->length += (size_t)vsnprintf(t->text + t->length, t->capacity - t->length, format, arguments);
  va_end(arguments);
}

/* ",t[s],vx[m/s]" and so on. */
static void put_si_header(struct table *t)
{
  if (t->second > 0) put(t, ",t[s]");
  for (size_t k = 0; k < t->layout->count; k++) {
    const struct table_column *column = &t->layout->columns[k];
    struct unit unit;
    char si[UNIT_TEXT];
    if (t->scale[k] == 0 || !unit_parse(column->unit, &(struct units){0}, &unit)) continue;
    unit_si_text(&unit, si);
    put(t, ",%s[%s]", column->name, si);
  }
}

static size_t header_length(const struct table_layout *layout)
{
  size_t length = sizeof ",t[s]\n";
  for (size_t k = 0; k < layout->key_count; k++) length += 1 + strlen(layout->keys[k].name);
  for (size_t k = 0; k < layout->count; k++)
    length += 2 * (1 + strlen(layout->columns[k].name)) + sizeof "[]" + UNIT_TEXT;
  return length;
}

static bool write_header(struct table *t, struct status *status)
{
  const struct table_layout *layout = t->layout;
  if (!reserve(t, header_length(layout), status)) return false;
  for (size_t k = 0; k < layout->key_count; k++) put(t, "%s%s", k > 0 ? "," : "", layout->keys[k].name);
  for (size_t k = 0; k < layout->count; k++) put(t, ",%s", layout->columns[k].name);
  put_si_header(t);
  put(t, "\n");
  return write_text(t, status);
}

/* Opens the file, with its content or, if `anew`, empty. */
static bool open_file(struct table **table, const char *path, const struct table_layout *layout,
                      const struct units *units, bool anew, struct status *status)
{
  struct table *t = *table = memory_allocate(1, sizeof *t + layout->count * sizeof *t->scale, "a table", status);
  if (!t) return false;
  const int flags = O_WRONLY | O_APPEND;
  t->layout = layout;
  t->descriptor = anew ? file_create(path, flags, status) : file_reopen(path, flags, status);
  if (t->descriptor < 0) {
    free(t);
    *table = NULL;
    return false;
  }
  set_scales(t, units);
  t->path = strdup(path);
  return t->path || file_fail(status, "open", path, ENOMEM);
}

static bool close_unless(bool good, struct table **table)
{
  struct status ignored;
  if (!good) table_close(table, &ignored);
  return good;
}

bool table_open(struct table **table, const char *path, const struct table_layout *layout, const struct units *units,
                struct status *status)
{
  return close_unless(open_file(table, path, layout, units, true, status) && write_header(*table, status), table);
}

/* Truncates the file; fails if it is shorter than `length`. */
static bool cut_back(struct table *t, int64_t length, struct status *status)
{
  if (!file_reaches(t->descriptor, t->path, length, status)) return false;
  t->size = length;
  return ftruncate(t->descriptor, length) == 0 || file_fail(status, "write", t->path, errno);
}

bool table_reopen(struct table **table, const char *path, const struct table_layout *layout, const struct units *units,
                  int64_t length, struct status *status)
{
  return close_unless(open_file(table, path, layout, units, false, status) && cut_back(*table, length, status), table);
}

bool table_sync(struct table *t, int64_t *length, struct status *status)
{
  *length = t->size;
  return file_sync(t->descriptor, t->path, status);
}

bool table_begin(struct table *t, struct status *status)
{
  t->length = 0;
  return file_stays(t->descriptor, t->path, status);
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

/* "step 7, disc 1: omega is nan"; returns false. */
static bool refuse(const struct table_layout *layout, const int64_t *keys, size_t column, double value,
                   struct status *status)
{
  char place[128] = "";
  size_t length = 0;
  for (size_t k = 0; k < layout->key_count && length < sizeof place; k++)
    length += (size_t)snprintf(place + length, sizeof place - length, "%s%s %" PRId64, k > 0 ? ", " : "",
                               layout->keys[k].noun, keys[k]);
  return status_fail(status, DELBM_FAILED, "%s: %s is %g", place, layout->columns[column].name, value);
}

static char *put_si(const struct table *t, int64_t step, const double *values, char *text)
{
  if (t->second == 0) return text;
  *text++ = ',';
  text += format_number(text, (double)step * t->second);
  for (size_t k = 0; k < t->layout->count; k++) {
    if (t->scale[k] == 0) continue;
    *text++ = ',';
    text += format_number(text, values[k] * t->scale[k]);
  }
  return text;
}

bool table_add(struct table *t, const int64_t *keys, const double *values, struct status *status)
{
  const struct table_layout *layout = t->layout;
  /* with SI columns, time and the final zero of snprintf */
  const size_t row_length = layout->key_count * INTEGER_LENGTH + (2 * layout->count + 1) * NUMBER_LENGTH + 2;
  if (!reserve(t, row_length, status)) return false;
  char *text = t->text + t->length;
  for (size_t k = 0; k < layout->key_count; k++)
    text += snprintf(text, INTEGER_LENGTH + 1, k > 0 ? ",%" PRId64 : "%" PRId64, keys[k]);
  for (size_t k = 0; k < layout->count; k++) {
    if (!isfinite(values[k])) return refuse(layout, keys, k, values[k], status);
    *text++ = ',';
    text += format_number(text, values[k]);
  }
  text = put_si(t, keys[0], values, text);
  *text++ = '\n';
  t->length = (size_t)(text - t->text);
  return true;
}

bool table_write(struct table *t, struct status *status)
{
  return write_text(t, status);
}

bool table_close(struct table **table, struct status *status)
{
  struct table *t = *table;
  if (!t) return true;
  bool closed = close(t->descriptor) == 0 || file_fail(status, "close", t->path, errno);
  free(t->text);
  free(t->path);
  free(t);
  *table = NULL;
  return closed;
}
