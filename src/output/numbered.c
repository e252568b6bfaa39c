#include "output/numbered.h"

#include "output/file.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

char *numbered_path(const char *folder, int64_t step, const char *extension, struct status *status)
{
  char name[64];
  snprintf(name, sizeof name, "%08" PRId64 ".%s", step, extension);
  return file_join(folder, name, status);
}

/* True for files of the extension from step `from` on, and for temporary files of any step. */
static bool is_removable(const char *name, int64_t from, const char *extension)
{
  size_t digits = 0;
  while (isdigit((unsigned char)name[digits])) digits++;
  const char *end = name + digits;
  const size_t length = strlen(extension);
  if (digits < 8 || *end != '.' || strncmp(end + 1, extension, length) != 0) return false;
  end += 1 + length;
  return (*end == '\0' && strtoll(name, NULL, 10) >= from) || strcmp(end, ".tmp") == 0;
}

bool numbered_remove(const char *folder, int64_t from, const char *extension, struct status *status)
{
  DIR *listing = opendir(folder);
  if (!listing) return errno == ENOENT || file_fail(status, "read folder", folder, errno);
  bool removed = true;
  for (struct dirent *entry; removed && (entry = readdir(listing));) {
    if (!is_removable(entry->d_name, from, extension)) continue;
    char *path = file_join(folder, entry->d_name, status);
    removed = path && file_remove(path, status);
    free(path);
  }
  closedir(listing);
  return removed;
}

bool numbered_remove_folder(const char *folder, const char *extension, struct status *status)
{
  return numbered_remove(folder, 0, extension, status) &&
         (rmdir(folder) == 0 || errno == ENOENT || errno == ENOTEMPTY || errno == EEXIST ||
          file_fail(status, "remove folder", folder, errno));
}
