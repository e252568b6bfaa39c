#include "case/case_file.h"

#include "base/memory.h"
#include "case/case_check.h"
#include "case/case_derive.h"
#include "case/case_keys.h"
#include "case/case_override.h"
#include "case/case_query.h"
#include "case/case_units.h"
#include "case/case_value.h"
#include "case/case_yaml.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char case_file[] = "case.yaml";

/* Path of the part of a case that is being read, for messages; an element of a list is named by its index. */
struct path {
  const struct path *up; /* NULL at the root */
  const char *name;      /* NULL in a list */
  size_t index;
};

/* A section of the table, its path in the case, and the struct of its values. */
struct place {
  const char *section;
  const struct path *path;
  void *owner;
};

enum { SHOWN_PATH = 512 };

static size_t print_path(const struct path *path, char text[SHOWN_PATH])
{
  if (!path) return 0;
  size_t length = print_path(path->up, text);
  const char *dot = length > 0 ? "." : "";
  char name[TREE_TEXT];
  if (path->name)
    tree_show(path->name, name);
  else
    snprintf(name, sizeof name, "%zu", path->index);
  return length + (size_t)snprintf(text + length, SHOWN_PATH - length, "%s%s", dot, name);
}

static bool refuse(const struct draft *draft, const struct path *path, struct tree_node *node, const char *expected)
{
  char where[TREE_PLACE], shown[SHOWN_PATH] = "the case", value[TREE_TEXT];
  tree_place(node, where);
  tree_print(node, value);
  print_path(path, shown);
  case_errors_add(draft->errors, "%s: %s: got %s; expected %s", where, shown, value, expected);
  node->refused = true;
  return false;
}

static bool refuse_unknown(const struct draft *draft, const struct place *place, const struct tree_node *key)
{
  if (case_errors_full(draft->errors)) {
    draft->errors->dropped++;
    return false;
  }
  const struct path path = {place->path, key->text, 0};
  char where[TREE_PLACE], shown[SHOWN_PATH], nearest[KEY_PATH], names[VALUE_TEXT];
  tree_place(key, where);
  print_path(&path, shown);
  if (key_nearest(place->section, key->text, nearest)) {
    case_errors_add(draft->errors, "%s: unknown key %s; did you mean %s?", where, shown, nearest);
    return false;
  }
  key_names(place->section, names, sizeof names);
  case_errors_add(draft->errors, "%s: unknown key %s; expected one of %s", where, shown, names);
  return false;
}

static bool refuse_missing(const struct draft *draft, const struct place *place, const struct tree_node *section,
                           const struct key *key)
{
  const struct path path = {place->path, key_within(key->path, place->section), 0};
  char where[TREE_PLACE], shown[SHOWN_PATH], allowed[VALUE_TEXT];
  tree_place(section, where);
  print_path(&path, shown);
  value_describe(key, allowed);
  case_errors_add(draft->errors, "%s: %s: missing; expected %s", where, shown, allowed);
  return false;
}

/* Adds a note if a number of the node was rounded to a whole one. */
static void note_rounding(struct draft *draft, const struct key *key, const struct path *path,
                          const struct tree_node *node)
{
  const size_t count = node->kind == TREE_LIST ? node->count : 1;
  for (size_t i = 0; i < count; i++) {
    const struct tree_node *number = node->kind == TREE_LIST ? node->entries[i].value : node;
    char words[VALUE_TEXT], where[TREE_PLACE], shown[SHOWN_PATH];
    const double given = value_rounding(key, number, &draft->scene.units, words);
    if (given == 0) continue;
    if (strcmp(key->path, "domain.size") == 0) draft->size_as_given[i] = given;
    if (!draft->errors->notes) continue;
    tree_place(number, where);
    print_path(path, shown);
    case_errors_add(draft->errors->notes, "%s: %s: %s", where, shown, words);
  }
}

static bool read_key(struct draft *draft, const struct key *key, const struct path *path, struct tree_node *node,
                     void *owner)
{
  if (value_read(key, node, &draft->scene.units, owner)) {
    note_rounding(draft, key, path, node);
    return true;
  }
  if (draft_has(draft, "units") && value_lacks_units(key, node, &draft->scene.units)) {
    node->refused = true; /* the cause is the units block, whose own error is reported */
    return false;
  }
  char allowed[VALUE_TEXT];
  value_expect(key, node, &draft->scene.units, allowed);
  return refuse(draft, path, node, allowed);
}

/* True if the section lacks the name; at the root also if the section of the key is absent. */
static bool is_missing(const struct place *place, const struct tree_node *section, const char *name)
{
  const char *dot = strchr(name, '.');
  if (!dot) return !tree_entry(section, name);
  if (*place->section != '\0' || strchr(dot + 1, '.')) return false;
  char top[KEY_PATH];
  snprintf(top, sizeof top, "%.*s", (int)(dot - name), name);
  return !tree_entry(section, top);
}

static bool check_required(const struct draft *draft, const struct place *place, const struct tree_node *section)
{
  bool complete = true;
  size_t count;
  const struct key *keys = key_table(&count);
  for (size_t i = 0; i < count; i++) {
    const char *name = draft_requires(draft, &keys[i]) ? key_within(keys[i].path, place->section) : NULL;
    if (name && is_missing(place, section, name)) complete = refuse_missing(draft, place, section, &keys[i]);
  }
  return complete;
}

static bool read_section(struct draft *draft, const struct place *place, struct tree_node *node);

/* Reads the listed discs into memory that prepare_particles has allocated. The node of a disc with errors is marked as
 * refused. */
static bool read_discs(struct draft *draft, const struct place *place, struct tree_node *list)
{
  if (list->kind != TREE_LIST) return refuse(draft, place->path, list, "a list of discs");
  for (size_t i = 0; i < list->count; i++) {
    const struct path path = {place->path, NULL, i};
    struct disc_draft disc = draft->disc;
    const struct place element = {place->section, &path, &disc};
    struct tree_node *node = list->entries[i].value;
    if (!read_section(draft, &element, node)) node->refused = true;
    if (disc.fixed && disc.driven) refuse(draft, &path, node, "a disc that is fixed or driven, not both");
    disc.spec.motion = disc.fixed ? DISC_FIXED : disc.driven ? DISC_DRIVEN : DISC_FREE;
    draft->scene.particles.discs[i] = disc.spec;
  }
  return true;
}

static void join_path(char section[KEY_PATH], const char *outer, const char *name, const char *brackets)
{
  snprintf(section, KEY_PATH, "%s%s%s%s", outer, *outer ? "." : "", name, brackets);
}

static bool read_entry(struct draft *draft, const struct place *place, const struct tree_entry *entry)
{
  const char *name = entry->key->text;
  const struct path path = {place->path, name, 0};
  struct place inner = {NULL, &path, place->owner};
  char section[KEY_PATH];
  const struct key *key;
  switch (key_role(place->section, name, &key)) {
  case ROLE_KEY:
    return read_key(draft, key, &path, entry->value, place->owner);
  case ROLE_SECTION:
    join_path(section, place->section, name, "");
    inner.section = section;
    return read_section(draft, &inner, entry->value);
  case ROLE_LIST:
    join_path(section, place->section, name, "[]");
    inner.section = section;
    return read_discs(draft, &inner, entry->value);
  default:
    return refuse_unknown(draft, place, entry->key);
  }
}

static bool read_section(struct draft *draft, const struct place *place, struct tree_node *node)
{
  if (node->kind != TREE_MAPPING) {
    char names[VALUE_TEXT], expected[VALUE_TEXT + 48];
    key_names(place->section, names, sizeof names);
    snprintf(expected, sizeof expected, "%sa mapping with the keys %s",
             strcmp(place->section, "fluid") == 0 ? "none, or " : "", names);
    return refuse(draft, place->path, node, expected);
  }
  bool valid = check_required(draft, place, node);
  for (size_t i = 0; i < node->count; i++) {
    if (!node->entries[i].key->refused && !read_entry(draft, place, &node->entries[i])) valid = false;
  }
  return valid;
}

/* Stores the defaults of the table, read as the text of a case. */
static bool read_defaults(struct draft *draft, struct tree *tree, struct status *status)
{
  size_t count;
  const struct key *keys = key_table(&count);
  for (size_t i = 0; i < count; i++) {
    if (!key_has_default(&keys[i])) continue;
    const char *fallback = keys[i].fallback;
    const struct yaml_text text = {keys[i].path, false, fallback, strlen(fallback)};
    const struct tree_node *node = yaml_read(tree, &text, draft->errors, status);
    if (!node) return false;
    bool of_disc = key_within(keys[i].path, "particles.discs[]") != NULL;
    value_read(&keys[i], node, &draft->scene.units, of_disc ? (void *)&draft->disc : (void *)draft);
  }
  return true;
}

/* Reads fluid.none, on which required keys depend. */
static void prepare_fluid(struct draft *draft)
{
  const struct tree_node *node = tree_find(draft->root, "fluid.none");
  if (node) value_read(key_find("fluid.none"), node, &draft->scene.units, draft);
}

/* Allocates the listed discs, and detects particles.fill. */
static bool prepare_particles(struct draft *draft, struct status *status)
{
  const struct tree_node *list = tree_find(draft->root, "particles.discs");
  draft->scene.particles.fill.present = draft_has(draft, "particles.fill");
  if (!list || list->kind != TREE_LIST) return true;
  struct disc_spec *discs = memory_allocate(list->count, sizeof *discs, "the discs", status);
  draft->scene.particles.discs = discs;
  draft->scene.particles.listed = discs ? list->count : 0;
  return discs != NULL;
}

/* The tree of the file with the overrides applied. A wrong override is recorded as an error and ignored. */
static bool read_tree(struct draft *draft, struct tree *tree, const struct yaml_text *text, char *const set[],
                      size_t set_count, struct status *status)
{
  draft->root = yaml_read(tree, text, draft->errors, status);
  if (!draft->root) return false;
  for (size_t i = 0; i < set_count; i++) {
    size_t known = case_errors_total(draft->errors);
    if (!override_apply(tree, &draft->root, set[i], draft->errors, status) && case_errors_total(draft->errors) == known)
      return false;
  }
  return override_expand(tree, &draft->root, status);
}

static char *copy_text(const char *text, struct status *status)
{
  char *copy = strdup(text);
  if (!copy) status_fail(status, DELBM_FAILED, "out of memory: a text of %zu bytes", strlen(text));
  return copy;
}

static bool finish(struct draft *draft, struct status *status)
{
  case_derive(draft);
  struct scene *scene = &draft->scene;
  scene->title = copy_text(draft->title, status);
  if (!scene->title) return false;
  if (draft->kernel && !(scene->fluid.kernel = copy_text(draft->kernel, status))) return false;
  return scene_fill(scene, status) && case_derive_stiffness(draft, status);
}

/* False with errors recorded, or with *status filled if there are none. */
static bool read_draft(struct draft *draft, struct tree *tree, const struct yaml_text *text, char *const set[],
                       size_t set_count, struct status *status)
{
  const struct place root = {"", NULL, draft};
  if (!read_tree(draft, tree, text, set, set_count, status) || !read_defaults(draft, tree, status) ||
      !prepare_particles(draft, status))
    return false;
  prepare_fluid(draft);
  case_units_read(draft);
  read_section(draft, &root, draft->root);
  return case_check(draft, status) && case_errors_total(draft->errors) == 0 && finish(draft, status) &&
         case_check_impacts(draft);
}

/* The case file of a path: the path, or case.yaml in a folder. */
static char *find_file(const char *path, struct status *status)
{
  struct stat about;
  char *file = NULL;
  if (stat(path, &about) != 0 || !S_ISDIR(about.st_mode)) return copy_text(path, status);
  const char *slash = path[strlen(path) - 1] == '/' ? "" : "/";
  if (asprintf(&file, "%s%s%s", path, slash, case_file) >= 0) return file;
  status_fail(status, DELBM_FAILED, "out of memory: the name of the case file");
  return NULL;
}

/* The name of a case: the name of the folder of a case.yaml, else the name of the file without extension. */
static char *name_case(const char *file, struct status *status)
{
  char *resolved = realpath(file, NULL);
  if (!resolved) return copy_text("case", status);
  char *name = strrchr(resolved, '/');
  if (name && strcmp(name + 1, case_file) == 0) {
    *name = '\0';
    name = strrchr(resolved, '/');
  } else if (name) {
    char *extension = strrchr(name + 1, '.');
    if (extension && extension > name + 1) *extension = '\0';
  }
  char *copy = copy_text(name && name[1] ? name + 1 : "case", status);
  free(resolved);
  return copy;
}

/* Reads to the end of the stream, but at most one byte more than the allowed size. */
static bool read_stream(FILE *stream, char **bytes, size_t *size, struct status *status)
{
  const size_t max_size = ((size_t)SCENE_FILE_MIB << 20) + 1;
  size_t capacity = 0, read = 1;
  for (*size = 0; *size < max_size && read > 0; *size += read) {
    size_t room = *size + (1 << 16) < max_size ? *size + (1 << 16) : max_size;
    if (!memory_grow(bytes, &capacity, room, 1, "the case file", status)) return false;
    read = fread(*bytes + *size, 1, room - *size, stream);
  }
  return true;
}

static bool read_bytes(const char *file, char **bytes, size_t *size, struct status *status)
{
  FILE *stream = fopen(file, "rb");
  if (!stream) return status_fail(status, DELBM_IO, "cannot open %s: %s", file, strerror(errno));
  bool read = read_stream(stream, bytes, size, status);
  if (read && ferror(stream)) read = status_fail(status, DELBM_IO, "cannot read %s: %s", file, strerror(errno));
  fclose(stream);
  return read;
}

static bool read_text(struct draft *draft, const struct yaml_text *text, char *const set[], size_t set_count,
                      struct status *status)
{
  struct tree tree = {0};
  const bool read = read_draft(draft, &tree, text, set, set_count, status);
  tree_clear(&tree);
  return read;
}

static bool read_file(struct draft *draft, const char *file, char *const set[], size_t set_count, struct status *status)
{
  char *bytes = NULL;
  size_t size = 0;
  bool read = read_bytes(file, &bytes, &size, status);
  if (read && size > (size_t)SCENE_FILE_MIB << 20) {
    case_errors_add(draft->errors, "%s: the file is too large; expected at most %d MiB", file, SCENE_FILE_MIB);
    read = false;
  }
  const struct yaml_text text = {file, true, bytes, size};
  read = read && read_text(draft, &text, set, set_count, status);
  free(bytes);
  return read;
}

/* Moves the scene to the caller if there are no errors, else releases it and sets *status. */
static bool conclude(struct scene *scene, struct draft *draft, bool read, const char *origin, struct status *status)
{
  const size_t wrong = case_errors_total(draft->errors);
  if (wrong > 0) read = status_fail(status, DELBM_INVALID, "%zu error%s in %s", wrong, wrong == 1 ? "" : "s", origin);
  if (read)
    *scene = draft->scene;
  else
    scene_clear(&draft->scene);
  return read;
}

bool case_read(struct scene *scene, const char *path, char *const set[], size_t set_count, struct case_errors *errors,
               struct status *status)
{
  *scene = (struct scene){0};
  char *file = find_file(path, status);
  if (!file) return false;
  struct draft draft = {.errors = errors};
  draft.scene.name = name_case(file, status);
  const bool read = draft.scene.name && read_file(&draft, file, set, set_count, status);
  const bool good = conclude(scene, &draft, read, file, status);
  free(file);
  return good;
}

bool case_read_text(struct scene *scene, const struct yaml_text *text, char *const set[], size_t set_count,
                    struct case_errors *errors, struct status *status)
{
  *scene = (struct scene){0};
  struct draft draft = {.errors = errors};
  draft.scene.name = copy_text("case", status);
  const bool read = draft.scene.name && read_text(&draft, text, set, set_count, status);
  return conclude(scene, &draft, read, text->origin, status);
}
