#include "analysis/history.h"

#include "base/memory.h"
#include "output/file.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static const char *const header = "step,id,x,y,vx,vy,omega,angle,fx,fy,torque,contact_fx,contact_fy,contact_torque";

enum { LINE_LENGTH = 1024 };

/* A table being read. Rows are in order, so that the position of a row is its number. */
struct reader {
  FILE *stream;
  const char *path;
  int64_t line;
  bool more; /* columns, in SI, which are skipped */
  struct history *history;
  size_t rows;
  size_t step_capacity, value_capacity;
};

static bool refuse(const struct reader *r, const char *what, struct status *status)
{
  return status_fail(status, DELBM_INVALID, "%s:%" PRId64 ": %s", r->path, r->line, what);
}

static bool reserve_row(struct reader *r, struct status *status)
{
  struct history *h = r->history;
  return memory_grow(&h->step, &r->step_capacity, r->rows / h->discs + 1, sizeof *h->step, "the history", status) &&
         memory_grow(&h->values, &r->value_capacity, (r->rows + 1) * HISTORY_COLUMNS, sizeof *h->values, "the history",
                     status);
}

static bool parse_row(struct reader *r, const char *text, struct status *status)
{
  struct history *h = r->history;
  const size_t snapshot = r->rows / h->discs, disc = r->rows % h->discs;
  char *end;
  const long long step = strtoll(text, &end, 10);
  if (end == text || *end != ',') return refuse(r, "no step", status);
  text = end + 1;
  const unsigned long long id = strtoull(text, &end, 10);
  if (end == text || id != disc) return refuse(r, "another disc than the case has here", status);
  if (!reserve_row(r, status)) return false;
  if (disc == 0) h->step[snapshot] = step;
  if (h->step[snapshot] != step) return refuse(r, "another step in the midst of a snapshot", status);
  for (int c = 0; c < HISTORY_COLUMNS; c++) {
    if (*end != ',') return refuse(r, "too few columns", status);
    text = end + 1;
    h->values[r->rows * HISTORY_COLUMNS + (size_t)c] = strtod(text, &end);
    if (end == text) return refuse(r, "not a number", status);
  }
  r->rows++;
  return *end == (r->more ? ',' : '\n') || refuse(r, "another number of columns than in the header", status);
}

static bool read_rows(struct reader *r, struct status *status)
{
  char text[LINE_LENGTH];
  r->line = 1;
  const size_t length = strlen(header);
  if (!fgets(text, sizeof text, r->stream) || strncmp(text, header, length) != 0 ||
      (text[length] != '\n' && text[length] != ','))
    return ferror(r->stream) ? file_fail(status, "read", r->path, errno) : refuse(r, "not a table of discs", status);
  r->more = text[length] == ',';
  while (fgets(text, sizeof text, r->stream)) {
    r->line++;
    if (!strchr(text, '\n')) break; /* the last row of a run that was cut off */
    if (!parse_row(r, text, status)) return false;
  }
  if (ferror(r->stream)) return file_fail(status, "read", r->path, errno);
  r->history->snapshots = r->rows / r->history->discs;
  return r->history->snapshots > 0 || refuse(r, "no snapshot", status);
}

bool history_read(struct history *history, const char *path, size_t discs, struct status *status)
{
  *history = (struct history){.discs = discs};
  if (discs == 0) return status_fail(status, DELBM_INVALID, "%s: the case has no discs to analyse", path);
  struct reader reader = {.stream = fopen(path, "r"), .path = path, .history = history};
  if (!reader.stream) return file_fail(status, "open", path, errno);
  errno = 0;
  const bool read = read_rows(&reader, status);
  fclose(reader.stream);
  if (!read) history_clear(history);
  return read;
}

void history_clear(struct history *history)
{
  free(history->step);
  free(history->values);
  *history = (struct history){0};
}
