#include "case/case_query.h"

#include <stdarg.h>
#include <string.h>

bool draft_has(const struct draft *draft, const char *path)
{
  return tree_find(draft->root, path) != NULL;
}

bool draft_requires(const struct draft *draft, const struct key *key)
{
  return key_is_required(key) && !(draft->scene.fluid.none && key_within(key->path, "fluid"));
}

static bool is_required(const char *path)
{
  const struct key *key = key_find(path);
  return key && key_is_required(key);
}

bool draft_knows(const struct draft *draft, const char *path)
{
  bool found;
  const struct tree_node *node = tree_nearest(draft->root, path, &found);
  return !node->refused && (found || !is_required(path));
}

bool draft_is_auto(const struct draft *draft, const char *path)
{
  const struct tree_node *node = tree_find(draft->root, path);
  return node ? node->kind == TREE_SCALAR && strcmp(node->text, "auto") == 0
              : strcmp(key_find(path)->fallback, "auto") == 0;
}

enum collision draft_collision(const struct draft *draft)
{
  if (!draft_has(draft, "fluid.collision") && draft_has(draft, "fluid.rates.q")) return COLLISION_MRT;
  return draft->scene.fluid.collision;
}

void draft_refuse(struct draft *draft, const char *path, const char *expected, ...)
{
  char words[512];
  va_list arguments;
  va_start(arguments, expected);
  vsnprintf(words, sizeof words, expected, arguments);
  va_end(arguments);

  bool found;
  const struct tree_node *node = tree_nearest(draft->root, path, &found);
  char place[TREE_PLACE], value[TREE_TEXT];
  tree_place(node, place);
  tree_print(node, value);
  if (found)
    case_errors_add(draft->errors, "%s: %s: got %s; expected %s", place, path, value, words);
  else
    case_errors_add(draft->errors, "%s: %s: missing; expected %s", place, path, words);
}

void draft_fill_region(const struct draft *draft, double region[4])
{
  const int *size = draft->scene.domain.size;
  const double box[4] = {0, 0, size[0], size[1]};
  bool given = draft_has(draft, "particles.fill.region");
  memcpy(region, given ? draft->scene.particles.fill.region : box, sizeof box);
}
