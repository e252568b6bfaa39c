#include "api/description.h"
#include "api/handle.h"
#include "base/memory.h"
#include "scene/scene_file.h"
#include "scene/scene_write.h"

#include <stdlib.h>
#include <string.h>

/* Where a case comes from: a file, or a text with the name that messages give it. */
struct source {
  const char *path;
  struct yaml_text text;
};

/* A case needs a length, which has no meaning here. */
static char length_setting[] = "run.steps=0";

static bool read_case(struct scene *scene, const struct source *source, char *const set[], size_t count,
                      struct scene_errors *errors, struct status *status)
{
  if (source->path) return scene_read(scene, source->path, set, count, errors, status);
  return scene_read_text(scene, &source->text, set, count, errors, status);
}

static bool read_with_length(struct scene *scene, const struct source *source, const char *const settings[],
                             size_t count, struct scene_errors *errors, struct status *status)
{
  char **set = memory_allocate(count + 1, sizeof *set, "the settings", status);
  if (!set) return false;
  for (size_t i = 0; i < count; i++) memcpy(&set[i], &settings[i], sizeof set[i]); /* read only, like their array */
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

static enum delbm_code open_source(struct delbm_simulation **simulation, const struct source *source,
                                   const char *const settings[], size_t count, struct delbm_status *out)
{
  struct status status;
  struct scene_errors errors = {0};
  struct delbm_simulation *s = NULL;
  *simulation = NULL;
  const bool good =
      settings_are_pairs(settings, count, &status) && (s = memory_allocate(1, sizeof *s, "a simulation", &status)) &&
      read_with_length(&s->scene, source, settings, count, &errors, &status) &&
      scene_fingerprint(&s->scene, &s->fingerprint, &status) && simulation_create(&s->simulation, &s->scene, &status);
  const enum delbm_code code = api_case_result(good, &status, &errors, out);
  scene_errors_clear(&errors);
  if (good)
    *simulation = s;
  else
    delbm_close(s);
  return code;
}

enum delbm_code delbm_open_file(struct delbm_simulation **simulation, const char *path, const char *const settings[],
                                size_t count, struct delbm_status *out)
{
  return open_source(simulation, &(struct source){.path = path}, settings, count, out);
}

enum delbm_code delbm_open_text(struct delbm_simulation **simulation, const char *yaml, const char *const settings[],
                                size_t count, struct delbm_status *out)
{
  const struct source source = {.text = {"case", true, yaml, strlen(yaml)}};
  return open_source(simulation, &source, settings, count, out);
}

enum delbm_code delbm_open_scene(struct delbm_simulation **simulation, const struct delbm_scene *scene,
                                 const char *const settings[], size_t count, struct delbm_status *out)
{
  struct status status;
  struct source source = {.text = {.origin = "scene"}};
  char *text = description_write(scene, &source.text.size, &status);
  *simulation = NULL;
  if (!text) return api_result(false, &status, out);
  source.text.bytes = text;
  const enum delbm_code code = open_source(simulation, &source, settings, count, out);
  free(text);
  return code;
}
