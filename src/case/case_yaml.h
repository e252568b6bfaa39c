/* YAML text to a tree, by libyaml. */
#ifndef DELBM_CASE_CASE_YAML_H
#define DELBM_CASE_CASE_YAML_H

#include "case/case_errors.h"
#include "case/case_tree.h"

enum {
  YAML_DEPTH = 32,   /* deepest nesting taken */
  YAML_ANCHORS = 256 /* most anchors taken in one document */
};

struct yaml_text {
  const char *origin; /* of its nodes; must outlive the tree */
  bool with_lines;    /* places carry line and column */
  const char *bytes;
  size_t size;
};

/* Reads one document. NULL if it is not valid YAML or holds what a case cannot, with each reason in `errors`; or for
 * want of memory, with *status filled and `errors` as it was. */
struct tree_node *yaml_read(struct tree *tree, const struct yaml_text *text, struct case_errors *errors,
                            struct status *status);

#endif
