#include "api/handle.h"
#include "output/checkpoint.h"

enum delbm_code delbm_save(struct delbm_simulation *s, const char *path, struct delbm_status *out)
{
  struct status status;
  const struct run_record none = {0};
  return api_result(checkpoint_write(path, s->fingerprint, s->simulation, &none, &status), &status, out);
}

enum delbm_code delbm_load(struct delbm_simulation *s, const char *path, struct delbm_status *out)
{
  struct status status;
  struct checkpoint_head head;
  struct run_record record;
  const bool loaded = checkpoint_examine(path, s->fingerprint, &head, &status) &&
                      checkpoint_read(path, s->simulation, &record, &status);
  return api_result(loaded, &status, out);
}
