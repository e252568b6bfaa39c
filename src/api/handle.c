#include "api/handle.h"

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

bool api_enter(struct api_call *call, const struct delbm_simulation *s, struct delbm_status *out)
{
  call->out = out;
  call->locale = c_locale_enter();
  return !(s && s->lost) ||
         status_fail(&call->status, DELBM_USAGE,
                     "the state of this simulation was lost when a call failed: it can only be closed");
}

enum delbm_code api_leave(struct api_call *call, bool good)
{
  c_locale_leave(call->locale);
  return good ? tell(call->out, DELBM_OK, "") : tell(call->out, call->status.code, call->status.message);
}

enum delbm_code api_leave_case(struct api_call *call, bool good, const struct case_errors *errors)
{
  struct delbm_status *out = call->out;
  const enum delbm_code code = api_leave(call, good);
  for (size_t i = 0; out && i < errors->count; i++) {
    const size_t length = strlen(out->message), room = sizeof out->message - length;
    if (strlen(errors->lines[i]) + 2 > room) break;
    snprintf(out->message + length, room, "\n%s", errors->lines[i]);
  }
  return code;
}

int64_t delbm_time(const struct delbm_simulation *s)
{
  return simulation_step(s->simulation);
}

int delbm_size(const struct delbm_simulation *s, int axis)
{
  return s->scene.domain.size[axis != 0];
}
