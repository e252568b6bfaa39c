/* A YAML document as a tree of nodes with their places in the file. The tree owns its nodes. Through aliases a node may
 * occur several times, even below itself, so that no function traverses a whole tree. */
#ifndef DELBM_CASE_CASE_TREE_H
#define DELBM_CASE_CASE_TREE_H

#include "base/status.h"

#include <stddef.h>

enum {
  TREE_TEXT = 256,  /* size of a printed value */
  TREE_PLACE = 4352 /* size of a place with a long file name */
};

enum tree_kind { TREE_SCALAR, TREE_LIST, TREE_MAPPING };

struct tree_entry {
  struct tree_node *key; /* a scalar; NULL in a list */
  struct tree_node *value;
};

struct tree_node {
  enum tree_kind kind;
  bool plain;         /* a scalar without quotes */
  bool refused;       /* has an error; a key: repeats an earlier name */
  const char *origin; /* name of the file, or text of the override */
  size_t line;        /* counted from 1; 0 in an override */
  size_t column;
  const char *text;           /* of a scalar */
  size_t count;               /* of a list or mapping */
  struct tree_entry *entries; /* [count] */
};

/* All zero: empty. */
struct tree {
  struct tree_block *blocks;
};

void tree_clear(struct tree *tree);

/* Zeroed memory that is released with the tree; NULL with *status filled on failure. */
void *tree_allocate(struct tree *tree, size_t count, size_t size, struct status *status);
const char *tree_copy_text(struct tree *tree, const char *text, size_t length, struct status *status);

/* A shallow copy of a collection, with room for one more entry. */
struct tree_node *tree_copy(struct tree *tree, const struct tree_node *node, struct status *status);

/* The entry with this name (in a list: index), or NULL. */
struct tree_entry *tree_entry(const struct tree_node *node, const char *name);

/* The node at a dotted path ("particles.discs.0.radius"), or NULL. */
struct tree_node *tree_find(struct tree_node *root, const char *path);

/* The node at the path, else the deepest existing node along the path. */
struct tree_node *tree_nearest(struct tree_node *root, const char *path, bool *found);

/* "FILE:LINE:COLUMN", or the override. */
void tree_place(const struct tree_node *node, char place[TREE_PLACE]);

/* The node as YAML, shortened if long. */
void tree_print(const struct tree_node *node, char text[TREE_TEXT]);

/* Text for a message: on one line, without control characters, shortened if long. */
void tree_show(const char *text, char shown[TREE_TEXT]);

#endif
