/* fields.h in a build without HDF5. */
#include "output/fields.h"

static bool refuse(struct status *status)
{
  return status_fail(status, DELBM_INVALID, "this build has no HDF5, and so no fields");
}

bool fields_open(struct fields **fields, const struct scene *scene, const char *directory,
                 const struct fields_mark *mark, struct status *status)
{
  (void)scene, (void)directory, (void)mark;
  *fields = NULL;
  return refuse(status);
}

bool fields_write(struct fields *fields, struct simulation *simulation, struct status *status)
{
  (void)fields, (void)simulation;
  return refuse(status);
}

int64_t fields_count(const struct fields *fields)
{
  (void)fields;
  return 0;
}

bool fields_join(struct fields *fields, struct status *status)
{
  (void)fields;
  return refuse(status);
}

bool fields_close(struct fields **fields, struct status *status)
{
  (void)status;
  *fields = NULL;
  return true;
}
