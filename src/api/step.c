#include "api/drive.h"

static bool step(struct delbm_simulation *s, int64_t steps, struct api_call *call)
{
  if (steps < 0) return status_fail(&call->status, DELBM_USAGE, "%lld steps", (long long)steps);
  if (s->drive_count == 0) return simulation_advance(s->simulation, steps, &call->status);
  for (int64_t k = 0; k < steps; k++) {
    if (!api_drive_begin(s, call) || !simulation_advance(s->simulation, 1, &call->status)) return false;
    api_drive_end(s);
  }
  return true;
}

enum delbm_code delbm_step(struct delbm_simulation *s, int64_t steps, struct delbm_status *out)
{
  struct api_call call;
  const bool good = api_enter(&call, s, out) && step(s, steps, &call);
  return api_leave(&call, good);
}
