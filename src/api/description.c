#include "api/description.h"

#include "base/memory.h"
#include "case/case_keys.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void write_pair(const char *key, const double pair[2], FILE *text)
{
  fprintf(text, "%s: [%.17g, %.17g]", key, pair[0], pair[1]);
}

static void write_side(const char *name, const struct delbm_side *side, FILE *text)
{
  int length;
  const char *type = key_choice(key_find("domain.left.type"), (int)side->type, &length);
  fprintf(text, "  %s: {type: ", name);
  if (length > 0)
    fprintf(text, "%.*s", length, type);
  else
    fprintf(text, "%u", (unsigned)side->type); /* invalid; refused by case_read_text */
  if (side->velocity[0] != 0 || side->velocity[1] != 0) write_pair(", velocity", side->velocity, text);
  fputs("}\n", text);
}

static void write_disc(const struct delbm_disc *disc, FILE *text)
{
  static const char *const flags[] = {"", ", fixed: true", ", driven: true"};
  fprintf(text, "    - {radius: %.17g, angle: %.17g, spin: %.17g, ", disc->radius, disc->angle, disc->spin);
  write_pair("position", disc->position, text);
  write_pair(", velocity", disc->velocity, text);
  if (disc->density != 0) fprintf(text, ", density: %.17g", disc->density);
  if ((unsigned)disc->motion < sizeof flags / sizeof flags[0])
    fputs(flags[disc->motion], text);
  else
    fprintf(text, ", driven: %u", (unsigned)disc->motion);
  fputs("}\n", text);
}

static void write_scene(const struct delbm_scene *scene, FILE *text)
{
  fprintf(text, "domain:\n  size: [%d, %d]\n", scene->size[0], scene->size[1]);
  write_side("left", &scene->left, text);
  write_side("right", &scene->right, text);
  write_side("bottom", &scene->bottom, text);
  write_side("top", &scene->top, text);
  fprintf(text, "fluid:\n  viscosity: %.17g\n", scene->viscosity);
  write_pair("  force", scene->force, text);
  fputs("\nparticles:\n", text);
  write_pair("  gravity", scene->gravity, text);
  fputs(scene->disc_count > 0 ? "\n  discs:\n" : "\n", text);
  for (size_t i = 0; i < scene->disc_count; i++) write_disc(&scene->discs[i], text);
}

/* A growing text; not open_memstream, which loses output without an error when memory runs out. */
struct growing {
  char *bytes;
  size_t length, capacity;
  struct status *status;
};

static ssize_t append(void *cookie, const char *bytes, size_t count)
{
  struct growing *text = cookie;
  if (!memory_grow(&text->bytes, &text->capacity, text->length + count, 1, "the description of the scene",
                   text->status))
    return 0;
  memcpy(text->bytes + text->length, bytes, count);
  text->length += count;
  return (ssize_t)count;
}

char *description_write(const struct delbm_scene *scene, size_t *size, struct status *status)
{
  struct growing text = {.status = status};
  status_fail(status, DELBM_FAILED, "out of memory: the description of the scene");
  FILE *stream = fopencookie(&text, "w", (cookie_io_functions_t){.write = append});
  if (stream) write_scene(scene, stream);
  const bool failed = !stream || ferror(stream);
  if (stream && fclose(stream) == 0 && !failed) {
    *size = text.length;
    return text.bytes;
  }
  free(text.bytes);
  return NULL;
}
