#include "case/case_override.h"

#include "case/case_yaml.h"

#include <stdio.h>
#include <string.h>

struct override {
  struct tree *tree;
  struct case_errors *errors;
  struct status *status;
  const char *origin;      /* origin of new nodes */
  struct tree_node *value; /* value of the override */
};

static bool refuse(const struct override *override, const char *what)
{
  case_errors_add(override->errors, "%s: %s", override->origin, what);
  return false;
}

static struct tree_node *make_node(const struct override *override, enum tree_kind kind, const char *text)
{
  struct tree_node *node = tree_allocate(override->tree, 1, sizeof *node, override->status);
  if (node) *node = (struct tree_node){.kind = kind, .plain = true, .origin = override->origin, .text = text};
  return node;
}

/* The entry with this name in a collection with room for one more; a new entry is an empty mapping. */
static struct tree_entry *make_entry(const struct override *override, struct tree_node *node, const char *name)
{
  struct tree_entry *entry = tree_entry(node, name);
  if (entry) return entry;
  if (node->kind == TREE_LIST) {
    char what[TREE_TEXT + 64];
    char shown[TREE_TEXT];
    tree_show(name, shown);
    snprintf(what, sizeof what, "no entry %s in the list, which has %zu, from 0", shown, node->count);
    refuse(override, what);
    return NULL;
  }
  entry = &node->entries[node->count];
  entry->key = make_node(override, TREE_SCALAR, name);
  entry->value = make_node(override, TREE_MAPPING, NULL);
  if (!entry->key || !entry->value) return NULL;
  node->count++;
  return entry;
}

/* Puts the value at the path below *at. */
static bool put(const struct override *override, struct tree_node **at, const char *path)
{
  for (bool last = false; !last;) {
    size_t length = strcspn(path, ".");
    last = path[length] == '\0';
    if (length == 0) return refuse(override, "an empty name in the key; expected dotted.key=value");
    const char *name = tree_copy_text(override->tree, path, length, override->status);
    if (!name) return false;
    if ((*at)->kind == TREE_SCALAR) return refuse(override, "the key leads into a single value");
    struct tree_node *copy = tree_copy(override->tree, *at, override->status);
    struct tree_entry *entry = copy ? make_entry(override, copy, name) : NULL;
    if (!entry) return false;
    *at = copy;
    at = &entry->value;
    path += length + 1;
  }
  *at = override->value;
  return true;
}

/* "--set TEXT", for messages. */
static const char *make_origin(struct tree *tree, const char *text, struct status *status)
{
  char shown[TREE_TEXT], origin[TREE_TEXT + 8];
  tree_show(text, shown);
  int length = snprintf(origin, sizeof origin, "--set %s", shown);
  return tree_copy_text(tree, origin, (size_t)length, status);
}

bool override_apply(struct tree *tree, struct tree_node **root, const char *text, struct case_errors *errors,
                    struct status *status)
{
  struct override override = {tree, errors, status, make_origin(tree, text, status), NULL};
  if (!override.origin) return false;
  const char *equals = strchr(text, '=');
  if (!equals || equals == text || equals[1] == '\0') return refuse(&override, "expected dotted.key=value");
  const char *key = tree_copy_text(tree, text, (size_t)(equals - text), status);
  if (!key) return false;
  const struct yaml_text value = {override.origin, false, equals + 1, strlen(equals + 1)};
  override.value = yaml_read(tree, &value, errors, status);
  return override.value && override_expand(tree, root, status) && put(&override, root, key);
}

/* Puts {key: value} in place of `short_form`, at the path. */
static bool expand(const struct override *override, struct tree_node **root, const char *path,
                   const struct tree_node *short_form, const char *key)
{
  struct override whole = *override;
  struct tree_node *mapping = make_node(override, TREE_MAPPING, NULL);
  struct tree_node *name = make_node(override, TREE_SCALAR, key);
  struct tree_entry *entry = tree_allocate(override->tree, 1, sizeof *entry, override->status);
  if (!mapping || !name || !entry) return false;
  *entry = (struct tree_entry){name, override->value};
  mapping->line = short_form->line;
  mapping->column = short_form->column;
  mapping->entries = entry;
  mapping->count = 1;
  whole.value = mapping;
  return put(&whole, root, path);
}

/* Replaces a scalar at the path by {key: scalar}. */
static bool expand_scalar(struct tree *tree, struct tree_node **root, const char *path, const char *key,
                          struct status *status)
{
  struct tree_node *scalar = tree_find(*root, path);
  if (!scalar || scalar->kind != TREE_SCALAR) return true;
  const struct override override = {.tree = tree, .status = status, .origin = scalar->origin, .value = scalar};
  return expand(&override, root, path, scalar, key);
}

static bool expand_fluid(struct tree *tree, struct tree_node **root, struct status *status)
{
  struct tree_node *fluid = tree_find(*root, "fluid"), *flag;
  if (!fluid || fluid->kind != TREE_SCALAR || strcmp(fluid->text, "none") != 0) return true;
  struct override override = {.tree = tree, .status = status, .origin = fluid->origin};
  if (!(flag = tree_copy(tree, fluid, status))) return false;
  flag->text = "true";
  override.value = flag;
  return expand(&override, root, "fluid", fluid, "none");
}

bool override_expand(struct tree *tree, struct tree_node **root, struct status *status)
{
  static const char *const sides[] = {"domain.left", "domain.right", "domain.bottom", "domain.top"};
  for (size_t i = 0; i < sizeof sides / sizeof sides[0]; i++)
    if (!expand_scalar(tree, root, sides[i], "type", status)) return false;
  return expand_scalar(tree, root, "contact.lubrication", "cutoff", status) && expand_fluid(tree, root, status);
}
