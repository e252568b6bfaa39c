#include "output/reversible.h"

#include "base/memory.h"
#include "output/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A record of the way back: a page as it was. */
enum { PAGE = 4096 };
struct record {
  int64_t page;
  char bytes[PAGE];
};

static int read_at(int descriptor, void *to, size_t size, int64_t at)
{
  for (size_t done = 0; done < size;) {
    const ssize_t got = pread(descriptor, (char *)to + done, size - done, at + (off_t)done);
    if (got < 0 && errno != EINTR) return errno;
    if (got == 0) return EIO;
    if (got > 0) done += (size_t)got;
  }
  return 0;
}

static int write_at(int descriptor, const void *from, size_t size, int64_t at)
{
  for (size_t done = 0; done < size;) {
    const ssize_t put = pwrite(descriptor, (const char *)from + done, size - done, at + (off_t)done);
    if (put < 0 && errno != EINTR) return errno;
    if (put > 0) done += (size_t)put;
  }
  return 0;
}

static bool open_file(struct reversible *f, const char *path, const char *undo_path, bool anew, struct status *status)
{
  *f = (struct reversible){.path = path, .undo_path = undo_path, .descriptor = -1, .undo = -1};
  f->descriptor = anew ? file_create(path, O_RDWR, status) : file_reopen(path, O_RDWR, status);
  return f->descriptor >= 0;
}

static bool open_undo(struct reversible *f, bool anew, struct status *status)
{
  const int flags = O_RDWR | O_DSYNC;
  f->undo = anew ? file_create(f->undo_path, flags, status) : file_reopen(f->undo_path, flags, status);
  return f->undo >= 0;
}

void reversible_close(struct reversible *f)
{
  if (f->descriptor >= 0) close(f->descriptor);
  if (f->undo >= 0) close(f->undo);
  f->descriptor = f->undo = -1;
  free(f->is_kept);
  f->is_kept = NULL;
}

static bool close_unless(bool good, struct reversible *f)
{
  if (!good) reversible_close(f);
  return good;
}

bool reversible_create(struct reversible *f, const char *path, const char *undo_path, struct status *status)
{
  return close_unless(open_file(f, path, undo_path, true, status), f);
}

/* Puts back the pages of whole records from `start` on, the last first: of each page the oldest stays. */
static bool put_back(const struct reversible *f, int64_t start, struct status *status)
{
  const int64_t size = sizeof(struct record), end = file_end(f->undo, f->undo_path, status);
  if (end < 0) return false;
  for (int64_t k = (end - start) / size - 1; k >= 0; k--) {
    struct record record;
    int error = read_at(f->undo, &record, sizeof record, start + k * size);
    if (error) return file_fail(status, "read", f->undo_path, error);
    error = write_at(f->descriptor, record.bytes, PAGE, record.page * PAGE);
    if (error) return file_fail(status, "write", f->path, error);
  }
  return true;
}

/* From now on pages are kept as they are. */
static bool note_mark(struct reversible *f, const struct reversible_mark *mark, struct status *status)
{
  free(f->is_kept);
  f->is_kept = memory_allocate((size_t)(mark->file / PAGE + 1), sizeof *f->is_kept, "the way back", status);
  f->marked = f->is_kept ? mark->file : 0;
  return f->is_kept;
}

static bool take_back(struct reversible *f, const struct reversible_mark *mark, struct status *status)
{
  if (!file_reaches(f->descriptor, f->path, mark->file, status) ||
      !file_reaches(f->undo, f->undo_path, mark->undo, status))
    return false;
  if (!put_back(f, mark->undo, status)) return false;
  const int error = reversible_set_length(f, mark->file);
  if (error) return file_fail(status, "write", f->path, error);
  if (!file_sync(f->descriptor, f->path, status)) return false; /* before the way back is gone */
  f->undo_length = mark->undo;
  if (ftruncate(f->undo, mark->undo) != 0) return file_fail(status, "write", f->undo_path, errno);
  return note_mark(f, mark, status);
}

bool reversible_return(struct reversible *f, const char *path, const char *undo_path,
                       const struct reversible_mark *mark, struct status *status)
{
  const bool taken =
      open_file(f, path, undo_path, false, status) && open_undo(f, false, status) && take_back(f, mark, status);
  return close_unless(taken, f);
}

int reversible_read(const struct reversible *f, void *to, size_t size, int64_t at)
{
  const int64_t there = f->length > at ? f->length - at : 0;
  const size_t held = there < (int64_t)size ? (size_t)there : size;
  memset((char *)to + held, 0, size - held);
  return read_at(f->descriptor, to, held, at);
}

/* Appends a page to the way back, unless it has been since the last mark. */
static int keep(struct reversible *f, int64_t page)
{
  struct record record = {.page = page};
  if (f->is_kept[page]) return 0;
  int error = reversible_read(f, record.bytes, PAGE, page * PAGE);
  if (error == 0) error = write_at(f->undo, &record, sizeof record, f->undo_length);
  if (error) return error;
  f->undo_length += (int64_t)sizeof record;
  f->is_kept[page] = true;
  return 0;
}

/* Keeps what was there at the last mark of the bytes from `at` to `end`, which are about to change. */
static int keep_pages(struct reversible *f, int64_t at, int64_t end)
{
  int error = 0;
  const int64_t last = end < f->marked ? end : f->marked;
  for (int64_t page = at / PAGE; error == 0 && page * PAGE < last; page++) error = keep(f, page);
  return error;
}

int reversible_write(struct reversible *f, const void *from, size_t size, int64_t at)
{
  const int64_t end = at + (int64_t)size;
  int error = keep_pages(f, at, end);
  if (error == 0) error = write_at(f->descriptor, from, size, at);
  if (error == 0 && end > f->length) f->length = end;
  return error;
}

int reversible_set_length(struct reversible *f, int64_t length)
{
  const int error = keep_pages(f, length, f->length);
  if (error) return error;
  if (ftruncate(f->descriptor, length) != 0) return errno;
  f->length = length;
  return 0;
}

bool reversible_set_mark(struct reversible *f, struct reversible_mark *mark, struct status *status)
{
  if (f->undo < 0 && !open_undo(f, true, status)) return false;
  if (!file_sync(f->descriptor, f->path, status)) return false;
  *mark = (struct reversible_mark){f->length, f->undo_length};
  return note_mark(f, mark, status);
}
