#include "output/file.h"

#include "base/memory.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char *concatenate(const char *first, const char *between, const char *last, struct status *status)
{
  size_t length = strlen(first) + strlen(between) + strlen(last) + 1;
  char *text = memory_allocate(length, 1, "a path", status);
  if (text) snprintf(text, length, "%s%s%s", first, between, last);
  return text;
}

bool file_fail(struct status *status, const char *verb, const char *path, int error)
{
  return status_fail(status, DELBM_IO, "cannot %s %s: %s", verb, path, strerror(error ? error : EIO));
}

char *file_join(const char *directory, const char *name, struct status *status)
{
  return concatenate(directory, "/", name, status);
}

static bool make_one_directory(const char *path, struct status *status)
{
  if (mkdir(path, 0777) == 0) return true;
  if (errno != EEXIST) return file_fail(status, "make folder", path, errno);
  struct stat found;
  if (stat(path, &found) == 0 && S_ISDIR(found.st_mode)) return true;
  return file_fail(status, "make folder", path, ENOTDIR);
}

bool file_make_directory(const char *path, struct status *status)
{
  char *part = concatenate(path, "", "", status);
  if (!part) return false;
  bool made = true;
  for (char *slash = strchr(part + (*part == '/'), '/'); made && slash; slash = strchr(slash + 1, '/')) {
    *slash = '\0';
    made = make_one_directory(part, status);
    *slash = '/';
  }
  free(part);
  return made && make_one_directory(path, status);
}

int64_t file_end(int descriptor, const char *path, struct status *status)
{
  const off_t end = lseek(descriptor, 0, SEEK_END);
  if (end < 0) file_fail(status, "read", path, errno);
  return end;
}

bool file_reaches(int descriptor, const char *path, int64_t length, struct status *status)
{
  const int64_t end = file_end(descriptor, path, status);
  if (end < 0) return false;
  return end >= length ||
         status_fail(status, DELBM_IO, "%s has %lld bytes, fewer than the %lld at the checkpoint: it was changed", path,
                     (long long)end, (long long)length);
}

bool file_remove(const char *path, struct status *status)
{
  return unlink(path) == 0 || errno == ENOENT || file_fail(status, "remove", path, errno);
}

bool replacement_begin(struct replacement *file, const char *path, struct status *status)
{
  *file = (struct replacement){.path = concatenate(path, "", "", status)};
  if (file->path) file->temporary = concatenate(path, ".tmp", "", status);
  if (file->temporary) {
    file->stream = fopen(file->temporary, "wb");
    if (!file->stream) file_fail(status, "create", file->temporary, errno);
  }
  if (file->stream) return true;
  free(file->temporary);
  free(file->path);
  return false;
}

bool file_sync(int descriptor, const char *path, struct status *status)
{
  /* EINVAL: what cannot be synchronised (a pipe, a device) has nothing to lose */
  return fsync(descriptor) == 0 || errno == EINVAL || file_fail(status, "write", path, errno);
}

static bool sync_directory(const char *path, struct status *status)
{
  const int descriptor = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return file_fail(status, "open folder", path, errno);
  const bool synced = file_sync(descriptor, path, status);
  close(descriptor);
  return synced;
}

/* Releases the paths of a replacement that has ended. */
static void release(struct replacement *file)
{
  free(file->temporary);
  free(file->path);
}

/* Closes and removes the file as far as it was written; returns false. */
static bool discard(struct replacement *file)
{
  fclose(file->stream);
  unlink(file->temporary);
  return false;
}

static bool commit(struct replacement *file, bool durably, struct status *status)
{
  errno = 0;
  if (ferror(file->stream) || fflush(file->stream) != 0) {
    file_fail(status, "write", file->path, errno);
    return discard(file);
  }
  if (durably && !file_sync(fileno(file->stream), file->path, status)) return discard(file);
  const bool moved = fclose(file->stream) == 0 && rename(file->temporary, file->path) == 0;
  if (!moved) {
    file_fail(status, "write", file->path, errno);
    unlink(file->temporary);
  }
  return moved;
}

bool replacement_commit(struct replacement *file, struct status *status)
{
  const bool moved = commit(file, false, status);
  release(file);
  return moved;
}

/* The folder that a path lies in. */
static bool sync_parent(char *path, struct status *status)
{
  char *slash = strrchr(path, '/');
  if (!slash) return sync_directory(".", status);
  if (slash == path) return sync_directory("/", status);
  *slash = '\0';
  const bool synced = sync_directory(path, status);
  *slash = '/';
  return synced;
}

bool replacement_commit_durably(struct replacement *file, struct status *status)
{
  const bool moved = commit(file, true, status) && sync_parent(file->path, status);
  release(file);
  return moved;
}

void replacement_abandon(struct replacement *file)
{
  discard(file);
  release(file);
}
