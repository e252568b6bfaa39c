/* A YAML document as a tree of nodes that know where they were written. Nodes belong to the tree and go with it.
 * Through aliases a node may hang in several places, even below itself, so nothing here walks a whole tree. */
#ifndef DELBM_CASE_CASE_TREE_H
#define DELBM_CASE_CASE_TREE_H

#include "base/status.h"

#include <stddef.h>

enum {
  TREE_TEXT = 256,  /* room for a printed value */
  TREE_PLACE = 4352 /* room for a place, whose file name may be long */
};

enum tree_kind { TREE_SCALAR, TREE_LIST, TREE_MAPPING };

struct tree_entry {
  struct tree_node *key; /* a scalar; NULL in a list */
  struct tree_node *value;
};

struct tree_node {
  enum tree_kind kind;
  bool plain;         /* a scalar without quotes */
  bool refused;       /* an error has been found in it; a key: it is not the first of its name */
  const char *origin; /* the file, or the override as the user wrote it */
  size_t line;        /* counted from 1; 0 in an override */
  size_t column;
  const char *text;           /* of a scalar */
  size_t count;               /* of a list or mapping */
  struct tree_entry *entries; /* [count] */
};

/* All zero is a tree that holds nothing. */
struct tree {
  struct tree_block *blocks;
};

void tree_clear(struct tree *tree);

/* Zeroed memory that lives as long as the tree, NULL with *status filled when there is none. */
void *tree_allocate(struct tree *tree, size_t count, size_t size, struct status *status);
const char *tree_copy_text(struct tree *tree, const char *text, size_t length, struct status *status);

/* A copy of a collection with room for one more entry; its entries are shared. */
struct tree_node *tree_copy(struct tree *tree, const struct tree_node *node, struct status *status);

/* The entry of a collection with this name (in a list: index), or NULL. */
struct tree_entry *tree_entry(const struct tree_node *node, const char *name);

/* The node at a dotted path ("particles.discs.0.radius"), or NULL. */
struct tree_node *tree_find(struct tree_node *root, const char *path);

/* The node at the path, else the deepest on the way to it. */
struct tree_node *tree_nearest(struct tree_node *root, const char *path, bool *found);

/* "FILE:LINE:COLUMN", or the override. */
void tree_place(const struct tree_node *node, char place[TREE_PLACE]);

/* The node as it may have been written, shortened if long. */
void tree_print(const struct tree_node *node, char text[TREE_TEXT]);

/* Text as it can be shown in a message: on one line, without control characters, shortened if long. */
void tree_show(const char *text, char shown[TREE_TEXT]);

#endif
