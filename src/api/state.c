#include "api/handle.h"
#include "output/checkpoint.h"

enum delbm_code delbm_save(struct delbm_simulation *s, const char *path, struct delbm_status *out)
{
  struct api_call call;
  const struct run_record none = {0};
  const bool good =
      api_enter(&call, s, out) && checkpoint_write(path, s->fingerprint, s->simulation, &none, &call.status);
  return api_leave(&call, good);
}

enum delbm_code delbm_load(struct delbm_simulation *s, const char *path, struct delbm_status *out)
{
  struct api_call call;
  const bool good =
      api_enter(&call, s, out) && checkpoint_load(path, s->fingerprint, s->simulation, &s->lost, &call.status);
  return api_leave(&call, good);
}
