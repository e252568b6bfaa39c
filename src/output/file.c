#include "output/file.h"

#include "base/memory.h"

#include <errno.h>
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

bool replacement_commit(struct replacement *file, struct status *status)
{
  errno = 0;
  bool written = !ferror(file->stream) && fflush(file->stream) == 0;
  if (!written) {
    file_fail(status, "write", file->path, errno);
    replacement_abandon(file);
    return false;
  }
  bool moved = fclose(file->stream) == 0 && rename(file->temporary, file->path) == 0;
  if (!moved) {
    file_fail(status, "write", file->path, errno);
    unlink(file->temporary);
  }
  free(file->temporary);
  free(file->path);
  return moved;
}

void replacement_abandon(struct replacement *file)
{
  fclose(file->stream);
  unlink(file->temporary);
  free(file->temporary);
  free(file->path);
}
