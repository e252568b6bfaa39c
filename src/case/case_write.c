#include "case/case_write.h"

#include "case/case_draft.h"
#include "case/case_keys.h"
#include "case/case_value.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* A draft with the values of a scene; texts and discs are not copied. */
static struct draft draft_from_scene(const struct scene *scene)
{
  return (struct draft){.scene = *scene, .title = scene->title ? scene->title : "", .kernel = scene->fluid.kernel};
}

/* True for keys without a meaning in a scene without fluid. */
static bool is_of_fluid(const struct key *key)
{
  static const char *const sections[] = {"fluid", "coupling", "run.plan", "output.fields"};
  for (size_t i = 0; i < sizeof sections / sizeof sections[0]; i++)
    if (key_within(key->path, sections[i])) return true;
  return false;
}

/* True for keys without effect in this scene, or implied by another key. */
static bool is_idle(const struct key *key, const struct scene *scene)
{
  if (strcmp(key->path, "units.viscosity") == 0) return true;
  if (strcmp(key->path, "units.density") == 0) return scene->units.density == 0;
  if (key_within(key->path, "units")) return scene->units.dx == 0;
  if (strcmp(key->path, "fluid.none") == 0) return true;
  if (scene->fluid.none && is_of_fluid(key)) return true;
  if (strcmp(key->path, "fluid.rates.magic") == 0) return true;
  if (strcmp(key->path, "contact.restitution") == 0) return scene->contact.restitution == 0;
  if (strncmp(key->path, "contact.damping", strlen("contact.damping")) == 0) return scene->contact.restitution > 0;
  if (strcmp(key->path, "fluid.magic") == 0) return scene->fluid.magic == 0 || scene->fluid.collision == COLLISION_MRT;
  if (strcmp(key->path, "fluid.rates.q") == 0) return scene->fluid.collision != COLLISION_MRT;
  if (strcmp(key->path, "fluid.rates.e") == 0)
    return scene->fluid.collision != COLLISION_MRT && scene->fluid.collision != COLLISION_ADAPTIVE;
  if (strcmp(key->path, "particles.density") == 0) return true;
  if (key_within(key->path, "particles.fill")) return !scene->particles.fill.present;
  return false;
}

/* True for keys that are not written at their default: keys of discs, and velocities of sides, which some types of side
 * do not allow. */
static bool is_optional(const struct key *key)
{
  return key_within(key->path, "particles.discs[]") || (key_within(key->path, "domain") && key->kind == KEY_VECTOR);
}

/* Reads the code point at *text and advances *text. The text is valid UTF-8, checked by libyaml. */
static unsigned long next_character(const char **text)
{
  const unsigned char *at = (const unsigned char *)*text;
  int more = *at >= 0xF0 ? 3 : *at >= 0xE0 ? 2 : *at >= 0xC0 ? 1 : 0;
  unsigned long character = more ? *at & (0x3Fu >> more) : *at;
  for (at++; more > 0 && *at; more--, at++) character = character << 6 | (*at & 0x3F);
  *text = (const char *)at;
  return character;
}

/* True for characters that YAML refuses between double quotes, or reads as the end of a line. */
static bool needs_escape(unsigned long character)
{
  bool control = character < 0x20 || (character >= 0x7F && character < 0xA0);
  bool separator = character == 0x2028 || character == 0x2029;
  bool special = character == 0xFEFF || character == 0xFFFE || character == 0xFFFF;
  return control || separator || special || character == '"' || character == '\\';
}

static void write_quoted(const char *text, FILE *file)
{
  fputc('"', file);
  while (*text) {
    const char *start = text;
    unsigned long character = next_character(&text);
    if (needs_escape(character))
      fprintf(file, "\\U%08lX", character);
    else
      fwrite(start, 1, (size_t)(text - start), file);
  }
  fputc('"', file);
}

static void write_text(const struct key *key, const void *owner, FILE *file)
{
  const char *text;
  memcpy(&text, (const unsigned char *)owner + key->offset, sizeof text);
  if (text)
    write_quoted(text, file);
  else
    fputs(key->fallback, file);
}

static void write_line(const struct key *key, const char *indent, const char *name, const void *owner, FILE *file)
{
  char value[VALUE_TEXT];
  fprintf(file, "%s%s: ", indent, name);
  if (key->kind == KEY_TEXT) {
    write_text(key, owner, file);
  } else {
    value_format(key, owner, value);
    fputs(value, file);
  }
  fputc('\n', file);
}

/* A section of the table, consecutive keys. */
struct section {
  const struct key *keys;
  size_t count;
  char path[KEY_PATH];
};

/* Writes the section as a flow mapping after `before`; writes nothing if no key is to be written. */
static void write_flow(const struct section *section, const struct scene *scene, const void *owner, const char *before,
                       FILE *file)
{
  bool any = false;
  for (size_t i = 0; i < section->count; i++) {
    const struct key *key = &section->keys[i];
    char value[VALUE_TEXT];
    value_format(key, owner, value);
    if (is_idle(key, scene) || (is_optional(key) && strcmp(value, key->fallback) == 0)) continue;
    fprintf(file, "%s%s: %s", any ? ", " : before, key_within(key->path, section->path), value);
    any = true;
  }
  if (any) fputs("}\n", file);
}

static void write_discs(const struct section *section, const struct scene *scene, FILE *file)
{
  if (scene->particles.listed > 0) fputs("  discs:\n", file);
  for (size_t i = 0; i < scene->particles.listed; i++) {
    const struct disc_spec *spec = &scene->particles.discs[i];
    const struct disc_draft disc = {*spec, spec->motion == DISC_FIXED, spec->motion == DISC_DRIVEN};
    write_flow(section, scene, &disc, "    - {", file);
  }
}

/* The section that starts with the key `first`. */
static struct section section_of(const struct key *first, const struct key *end)
{
  struct section section = {.keys = first};
  snprintf(section.path, sizeof section.path, "%.*s", (int)(strrchr(first->path, '.') - first->path), first->path);
  for (const struct key *key = first; key < end && key_within(key->path, section.path); key++) section.count++;
  return section;
}

/* Writes the key, or the inner section that starts with it; returns the number of rows of the table. */
static size_t write_rows(const struct draft *draft, const struct key *key, const struct key *end, FILE *file)
{
  const char *dot = strchr(key->path, '.');
  if (!dot || !strchr(dot + 1, '.')) {
    if (!is_idle(key, &draft->scene)) write_line(key, dot ? "  " : "", dot ? dot + 1 : key->path, draft, file);
    return 1;
  }
  const struct section section = section_of(key, end);
  if (strstr(section.path, "[]")) {
    write_discs(&section, &draft->scene, file);
  } else {
    char before[KEY_PATH + 8];
    snprintf(before, sizeof before, "  %s: {", strchr(section.path, '.') + 1);
    write_flow(&section, &draft->scene, draft, before, file);
  }
  return section.count;
}

/* True for sections in the fingerprint. */
static bool is_compared(const struct key *key)
{
  static const char *const sections[] = {"domain", "fluid", "units", "coupling", "particles", "contact"};
  for (size_t i = 0; i < sizeof sections / sizeof sections[0]; i++)
    if (key_within(key->path, sections[i])) return true;
  return false;
}

/* Writes the first line of the section of a key; "fluid: none", and nothing for a section without keys. */
static void write_heading(const struct key *key, const struct scene *scene, FILE *file)
{
  const int top = (int)strcspn(key->path, ".");
  if (key_within(key->path, "units") && scene->units.dx == 0) return;
  if (key_within(key->path, "coupling") && scene->fluid.none) return;
  fprintf(file, "%.*s:%s\n", top, key->path, key_within(key->path, "fluid") && scene->fluid.none ? " none" : "");
}

/* Writes all sections, or the sections of the fingerprint. */
static void write_case(const struct scene *scene, bool compared_alone, FILE *file)
{
  const struct draft draft = draft_from_scene(scene);
  size_t count;
  const struct key *keys = key_table(&count);
  for (size_t i = 0; i < count;) {
    if (compared_alone && !is_compared(&keys[i])) {
      i++;
      continue;
    }
    size_t top = strcspn(keys[i].path, ".");
    bool opens = i == 0 || strncmp(keys[i].path, keys[i - 1].path, top + 1) != 0;
    if (keys[i].path[top] == '.' && opens) write_heading(&keys[i], scene, file);
    i += write_rows(&draft, &keys[i], keys + count, file);
  }
}

bool case_write(const struct scene *scene, FILE *file)
{
  fprintf(file, "# written by delbm %s\n", DELBM_VERSION);
  write_case(scene, false, file);
  return fflush(file) == 0 && !ferror(file);
}

static ssize_t add_to_sum(void *cookie, const char *bytes, size_t count)
{
  uint32_t *sum = cookie;
  *sum = (uint32_t)crc32_z(*sum, (const void *)bytes, count);
  return (ssize_t)count;
}

bool case_fingerprint(const struct scene *scene, uint32_t *fingerprint, struct status *status)
{
  *fingerprint = 0;
  /* not open_memstream, which loses output without an error when memory runs out */
  FILE *stream = fopencookie(fingerprint, "w", (cookie_io_functions_t){.write = add_to_sum});
  if (stream) write_case(scene, true, stream);
  const bool failed = !stream || ferror(stream);
  return (stream && fclose(stream) == 0 && !failed) ||
         status_fail(status, DELBM_FAILED, "out of memory: the fingerprint of the case");
}
