#include "api/handle.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

const char *delbm_version(void)
{
  return DELBM_VERSION;
}

void delbm_close(struct delbm_simulation *s)
{
  if (!s) return;
  simulation_destroy(s->simulation);
  scene_clear(&s->scene);
  free(s->drives);
  free(s);
}

static enum delbm_code tell(struct delbm_status *out, enum delbm_code code, const char *message)
{
  if (out) {
    out->code = code;
    snprintf(out->message, sizeof out->message, "%s", message);
  }
  return code;
}

enum delbm_code api_success(struct delbm_status *out)
{
  return tell(out, DELBM_OK, "");
}

enum delbm_code api_result(bool good, const struct status *status, struct delbm_status *out)
{
  return good ? api_success(out) : tell(out, status->code, status->message);
}

enum delbm_code api_case_result(bool good, const struct status *status, const struct scene_errors *errors,
                                struct delbm_status *out)
{
  const enum delbm_code code = api_result(good, status, out);
  for (size_t i = 0; out && i < errors->count; i++) {
    const size_t length = strlen(out->message), room = sizeof out->message - length;
    if (strlen(errors->lines[i]) + 2 > room) break;
    snprintf(out->message + length, room, "\n%s", errors->lines[i]);
  }
  return code;
}

enum delbm_code delbm_step(struct delbm_simulation *s, int64_t steps, struct delbm_status *out)
{
  struct status status;
  if (steps < 0) return api_result(status_fail(&status, DELBM_USAGE, "%lld steps", (long long)steps), &status, out);
  if (s->drive_count == 0) return api_result(simulation_advance(s->simulation, steps, &status), &status, out);
  for (int64_t k = 0; k < steps; k++) {
    if (!api_drive_begin(s, &status) || !simulation_advance(s->simulation, 1, &status))
      return api_result(false, &status, out);
    api_drive_end(s);
  }
  return api_success(out);
}

int64_t delbm_time(const struct delbm_simulation *s)
{
  return simulation_step(s->simulation);
}

int delbm_size(const struct delbm_simulation *s, int axis)
{
  return s->scene.domain.size[axis != 0];
}
