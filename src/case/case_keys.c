#include "case/case_keys.h"

#include "base/words.h"
#include "case/case_draft.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

_Static_assert(sizeof(enum side_type) == sizeof(int), "a choice is stored as an int");
_Static_assert(SIDE_WALL == 0 && SIDE_SLIP == 4, "order of wall|periodic|inlet|outlet|slip");
_Static_assert(FRAME_DISCS_PLAIN == 0 && FRAME_DISCS_RADIUS == 3, "order of plain|height|speed|radius");
_Static_assert(COLLISION_BGK == 0 && COLLISION_MRT == 2, "order of bgk|trt|mrt");

static const struct key table[] = {
#define KEY(path, kind, owner, field, fallback, allowed, unit, help)                                                   \
  {path, KEY_##kind, offsetof(struct owner, field), fallback, allowed, unit, help},
#include "case/case_keys.def"
#undef KEY
};

static const size_t table_count = sizeof table / sizeof table[0];

const struct key *key_table(size_t *count)
{
  *count = table_count;
  return table;
}

const struct key *key_find(const char *path)
{
  for (size_t i = 0; i < table_count; i++)
    if (strcmp(table[i].path, path) == 0) return &table[i];
  return NULL;
}

const char *key_choice(const struct key *key, int value, int *length)
{
  const char *at = key->allowed;
  for (; value > 0 && *at; value--) {
    at += strcspn(at, "|");
    at += *at == '|';
  }
  *length = value == 0 ? (int)strcspn(at, "|") : 0;
  return at;
}

bool key_is_required(const struct key *key)
{
  return strcmp(key->fallback, "required") == 0;
}

bool key_is_automatic(const struct key *key)
{
  return strcmp(key->fallback, "auto") == 0 || strncmp(key->allowed, key_or_automatic, strlen(key_or_automatic)) == 0;
}

bool key_has_default(const struct key *key)
{
  return !key_is_required(key) && strcmp(key->fallback, "derived") != 0;
}

const char *key_within(const char *path, const char *section)
{
  size_t length = strlen(section);
  if (length == 0) return path;
  return strncmp(path, section, length) == 0 && path[length] == '.' ? path + length + 1 : NULL;
}

enum key_role key_role(const char *section, const char *name, const struct key **key)
{
  size_t length = strlen(name);
  for (size_t i = 0; i < table_count; i++) {
    const char *rest = key_within(table[i].path, section);
    if (!rest || strncmp(rest, name, length) != 0) continue;
    if (rest[length] == '\0') {
      *key = &table[i];
      return ROLE_KEY;
    }
    if (rest[length] == '.') return ROLE_SECTION;
    if (strncmp(rest + length, "[].", 3) == 0) return ROLE_LIST;
  }
  return ROLE_UNKNOWN;
}

void key_names(const char *section, char *text, size_t size)
{
  const char *last = "";
  size_t used = 0, last_length = 0;
  *text = '\0';
  for (size_t i = 0; i < table_count; i++) {
    const char *name = key_within(table[i].path, section);
    if (!name) continue;
    size_t length = strcspn(name, ".[");
    if (length == last_length && strncmp(name, last, length) == 0) continue;
    int added = snprintf(text + used, size - used, "%s%.*s", used ? ", " : "", (int)length, name);
    if (added < 0 || (size_t)added >= size - used) return;
    used += (size_t)added;
    last = name;
    last_length = length;
  }
}

static const char *last_name(const char *path)
{
  const char *dot = strrchr(path, '.');
  return dot ? dot + 1 : path;
}

/* Distance of `name` in `section` to a path of the table; SIZE_MAX: too far for a suggestion. In the same section the
 * names are compared. In other sections whole paths (plus 1) or names (plus 2), so that a slip within the section is
 * preferred. */
static size_t path_distance(const char *section, const char *name, const char *candidate)
{
  const char *rest = key_within(candidate, section);
  if (rest && !strchr(rest, '.')) {
    const size_t distance = edit_distance(name, rest);
    return words_are_near(name, distance) ? distance : SIZE_MAX;
  }
  char full[2 * KEY_PATH];
  snprintf(full, sizeof full, "%.*s%s%.*s", KEY_PATH - 2, section, *section ? "." : "", KEY_PATH - 1, name);
  const size_t whole = edit_distance(full, candidate), last = edit_distance(name, last_name(candidate));
  const size_t by_path = words_are_near(name, whole) ? whole + 1 : SIZE_MAX;
  const size_t by_name = words_are_near(name, last) ? last + 2 : SIZE_MAX;
  return by_path < by_name ? by_path : by_name;
}

struct nearest {
  const char *section;
  const char *name;
  char *path;
  size_t distance;
};

/* Considers the first `length` characters of a path: a key, or a section or list that contains the key. */
static void consider(struct nearest *nearest, const char *path, size_t length)
{
  char candidate[KEY_PATH];
  snprintf(candidate, sizeof candidate, "%.*s", (int)length, path);
  char *brackets = strstr(candidate, "[]");
  if (brackets && brackets[2] == '\0') *brackets = '\0'; /* final brackets: the list itself */
  size_t distance = path_distance(nearest->section, nearest->name, candidate);
  if (distance >= nearest->distance) return;
  nearest->distance = distance;
  snprintf(nearest->path, KEY_PATH, "%s", candidate);
}

bool key_nearest(const char *section, const char *name, char path[KEY_PATH])
{
  struct nearest nearest = {section, name, path, SIZE_MAX};
  for (size_t i = 0; i < table_count; i++) {
    for (const char *end = table[i].path; *end; end += *end == '.') {
      end += strcspn(end, ".");
      consider(&nearest, table[i].path, (size_t)(end - table[i].path));
    }
  }
  return nearest.distance < SIZE_MAX;
}
