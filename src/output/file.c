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

static bool is_device(const struct stat *found)
{
  return S_ISCHR(found->st_mode) || S_ISBLK(found->st_mode);
}

/* Creates a file in an open folder. `path`: for messages. */
static int create_at(int folder, const char *name, const char *path, int flags, struct status *status)
{
  struct stat found;
  const bool exists = fstatat(folder, name, &found, AT_SYMLINK_NOFOLLOW) == 0, device = exists && is_device(&found);
  if (exists && !device && unlinkat(folder, name, 0) != 0 && errno != ENOENT) {
    file_fail(status, "remove", path, errno);
    return -1;
  }
  const int descriptor = openat(folder, name, flags | O_CLOEXEC | (device ? 0 : O_CREAT | O_EXCL), 0666);
  if (descriptor < 0) file_fail(status, "create", path, errno);
  return descriptor;
}

static FILE *create_stream_at(int folder, const char *name, const char *path, struct status *status)
{
  const int descriptor = create_at(folder, name, path, O_WRONLY, status);
  if (descriptor < 0) return NULL;
  FILE *stream = fdopen(descriptor, "wb");
  if (stream) return stream;
  file_fail(status, "create", path, errno);
  close(descriptor);
  unlinkat(folder, name, 0);
  return NULL;
}

int file_create(const char *path, int flags, struct status *status)
{
  return create_at(AT_FDCWD, path, path, flags, status);
}

FILE *file_create_stream(const char *path, struct status *status)
{
  return create_stream_at(AT_FDCWD, path, path, status);
}

/* Fails unless this is a plain file and, without `shared`, has no other hard link. */
static bool check_plain(int descriptor, const char *path, bool shared, struct status *status)
{
  struct stat found;
  if (fstat(descriptor, &found) != 0) return file_fail(status, "open", path, errno);
  if (!S_ISREG(found.st_mode)) return status_fail(status, DELBM_IO, "cannot open %s: it is not a plain file", path);
  if (shared || found.st_nlink <= 1) return true;
  return status_fail(status, DELBM_IO,
                     "cannot go on with %s: the file has %ju names (hard links), and would change under all of them; "
                     "put a copy in its place",
                     path, (uintmax_t)found.st_nlink);
}

/* O_NONBLOCK: without it, open waits for the writer of a FIFO. */
static int open_plain(const char *path, int flags, bool shared, struct status *status)
{
  const int descriptor = open(path, flags | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0 && errno == ELOOP && (flags & O_NOFOLLOW) != 0)
    status_fail(status, DELBM_IO, "cannot go on with %s: it is a symbolic link; put the file itself in its place",
                path);
  else if (descriptor < 0)
    file_fail(status, "open", path, errno);
  if (descriptor < 0 || check_plain(descriptor, path, shared, status)) return descriptor;
  close(descriptor);
  return -1;
}

int file_reopen(const char *path, int flags, struct status *status)
{
  return open_plain(path, flags | O_NOFOLLOW, false, status);
}

FILE *file_open_stream(const char *path, struct status *status)
{
  const int descriptor = open_plain(path, O_RDONLY, true, status);
  if (descriptor < 0) return NULL;
  FILE *stream = fdopen(descriptor, "rb");
  if (stream) return stream;
  file_fail(status, "open", path, errno);
  close(descriptor);
  return NULL;
}

bool file_stays(int descriptor, const char *path, struct status *status)
{
  struct stat opened, found;
  if (fstat(descriptor, &opened) != 0) return file_fail(status, "write", path, errno);
  if (stat(path, &found) == 0 && found.st_dev == opened.st_dev && found.st_ino == opened.st_ino) return true;
  return status_fail(status, DELBM_IO,
                     "cannot go on in %s: it was removed, moved or replaced while the run wrote there", path);
}

/* Refuses devices, also through links: /dev/null, /dev/stdout must not be replaced. */
static bool check_replaceable(const char *path, struct status *status)
{
  struct stat found;
  return stat(path, &found) != 0 || !is_device(&found) ||
         status_fail(status, DELBM_IO, "cannot write %s: it is a device, not a file", path);
}

static const char *last_part(const char *path)
{
  const char *slash = strrchr(path, '/');
  return slash ? slash + 1 : path;
}

static int open_parent(const char *path, struct status *status)
{
  char *folder = concatenate(path, "", "", status);
  if (!folder) return -1;
  folder[last_part(path) - path] = '\0';
  const int descriptor = open(*folder ? folder : ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) file_fail(status, "create", path, errno);
  free(folder);
  return descriptor;
}

static void release(struct replacement *file)
{
  if (file->folder >= 0) close(file->folder);
  free(file->temporary);
  free(file->path);
}

bool replacement_begin(struct replacement *file, const char *path, struct status *status)
{
  *file = (struct replacement){.folder = -1};
  if (!check_replaceable(path, status)) return false;
  if ((file->path = concatenate(path, "", "", status)) && (file->temporary = concatenate(path, ".tmp", "", status)) &&
      (file->folder = open_parent(file->temporary, status)) >= 0 &&
      (file->stream = create_stream_at(file->folder, last_part(file->temporary), file->temporary, status)))
    return true;
  release(file);
  return false;
}

bool file_sync(int descriptor, const char *path, struct status *status)
{
  while (fsync(descriptor) != 0) /* EINVAL: a pipe or a device, which cannot be synchronised */
    if (errno != EINTR) return errno == EINVAL || file_fail(status, "write", path, errno);
  return true;
}

/* Closes and removes the temporary file; returns false. */
static bool discard(struct replacement *file)
{
  fclose(file->stream);
  unlinkat(file->folder, last_part(file->temporary), 0);
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
  const char *temporary = last_part(file->temporary);
  const bool moved =
      fclose(file->stream) == 0 && renameat(file->folder, temporary, file->folder, last_part(file->path)) == 0;
  if (!moved) {
    file_fail(status, "write", file->path, errno);
    unlinkat(file->folder, temporary, 0);
  }
  return moved;
}

bool replacement_commit(struct replacement *file, struct status *status)
{
  const bool moved = commit(file, false, status);
  release(file);
  return moved;
}

bool replacement_commit_durably(struct replacement *file, struct status *status)
{
  const bool moved = commit(file, true, status) && file_sync(file->folder, file->path, status);
  release(file);
  return moved;
}

void replacement_abandon(struct replacement *file)
{
  discard(file);
  release(file);
}
