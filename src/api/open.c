#include "api/description.h"
#include "api/handle.h"
#include "base/memory.h"
#include "case/case_file.h"
#include "case/case_write.h"

#include <stdlib.h>
#include <string.h>

/* Source of a case: a file, or a text with a name for messages. */
struct source {
  const char *path;
  struct yaml_text text;
};

/* The required run.steps has no meaning in the library. */
static char length_setting[] = "run.steps=0";

static bool read_case(struct scene *scene, const struct source *source, char *const set[], size_t count,
                      struct case_errors *errors, struct status *status)
{
  if (source->path) return case_read(scene, source->path, set, count, errors, status);
  return case_read_text(scene, &source->text, set, count, errors, status);
}

static bool read_with_length(struct scene *scene, const struct source *source, const char *const settings[],
                             size_t count, struct case_errors *errors, struct status *status)
{
  char **set = memory_allocate(count + 1, sizeof *set, "the settings", status);
  if (!set) return false;
  for (size_t i = 0; i < count; i++)
    memcpy(&set[i], &settings[i], sizeof set[i]); /* char *: not modified, as their array */
  set[count] = length_setting;
  const bool read = read_case(scene, source, set, count + 1, errors, status);
  free(set);
  return read;
}

static bool settings_are_pairs(const char *const settings[], size_t count, struct status *status)
{
  for (size_t i = 0; i < count; i++)
    if (!strchr(settings[i], '=') || *settings[i] == '=')
      return status_fail(status, DELBM_USAGE, "the setting '%s' is not key=value", settings[i]);
  return true;
}

static bool open_source(struct delbm_simulation *s, const struct source *source, const char *const settings[],
                        size_t count, struct case_errors *errors, struct status *status)
{
  return settings_are_pairs(settings, count, status) &&
         read_with_length(&s->scene, source, settings, count, errors, status) &&
         case_fingerprint(&s->scene, &s->fingerprint, status) && simulation_create(&s->simulation, &s->scene, status);
}

/* Sets *simulation to the opened simulation, or NULL. */
static enum delbm_code open_and_leave(struct api_call *call, struct delbm_simulation **simulation,
                                      const struct source *source, const char *const settings[], size_t count)
{
  struct case_errors errors = {0};
  struct delbm_simulation *s = memory_allocate(1, sizeof *s, "a simulation", &call->status);
  const bool good = s && open_source(s, source, settings, count, &errors, &call->status);
  if (!good) delbm_close(s);
  *simulation = good ? s : NULL;
  const enum delbm_code code = api_leave_case(call, good, &errors);
  case_errors_clear(&errors);
  return code;
}

enum delbm_code delbm_open_file(struct delbm_simulation **simulation, const char *path, const char *const settings[],
                                size_t count, struct delbm_status *out)
{
  struct api_call call;
  api_enter(&call, NULL, out);
  return open_and_leave(&call, simulation, &(struct source){.path = path}, settings, count);
}

enum delbm_code delbm_open_text(struct delbm_simulation **simulation, const char *yaml, const char *const settings[],
                                size_t count, struct delbm_status *out)
{
  struct api_call call;
  const struct source source = {.text = {"case", true, yaml, strlen(yaml)}};
  api_enter(&call, NULL, out);
  return open_and_leave(&call, simulation, &source, settings, count);
}

enum delbm_code delbm_open_scene(struct delbm_simulation **simulation, const struct delbm_scene *scene,
                                 const char *const settings[], size_t count, struct delbm_status *out)
{
  struct api_call call;
  struct source source = {.text = {.origin = "scene"}};
  api_enter(&call, NULL, out);
  *simulation = NULL;
  char *text = description_write(scene, &source.text.size, &call.status);
  if (!text) return api_leave(&call, false);
  source.text.bytes = text;
  const enum delbm_code code = open_and_leave(&call, simulation, &source, settings, count);
  free(text);
  return code;
}
