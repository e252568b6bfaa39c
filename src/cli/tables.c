#include "cli/tables.h"

#include "output/file.h"

#include <stdlib.h>

static bool write_table(const struct settling *settling, const char *directory, const char *name,
                        void (*write)(const struct settling *, FILE *), struct status *status)
{
  char *path = file_join(directory, name, status);
  struct replacement file;
  bool written = path && replacement_begin(&file, path, status);
  if (written) {
    write(settling, file.stream);
    written = replacement_commit(&file, status);
  }
  free(path);
  return written;
}

bool tables_write(const struct settling *settling, const char *directory, struct status *status)
{
  return write_table(settling, directory, "settling.csv", analysis_settling_csv, status) &&
         write_table(settling, directory, "profile.csv", analysis_profile_csv, status);
}
