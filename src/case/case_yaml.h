/* Parsing of YAML text to a tree, by libyaml. */
#ifndef DELBM_CASE_CASE_YAML_H
#define DELBM_CASE_CASE_YAML_H

#include "case/case_errors.h"
#include "case/case_tree.h"

enum {
  YAML_DEPTH = 32,   /* maximum depth of nesting */
  YAML_ANCHORS = 256 /* maximum number of anchors */
};

struct yaml_text {
  const char *origin; /* origin of the nodes; must outlive the tree */
  bool with_lines;    /* record line and column of nodes */
  const char *bytes;
  size_t size;
};

/* Parses one document. NULL with reasons in `errors` if it is not valid YAML, or contains what no case may contain;
 * NULL with *status filled and `errors` unchanged if memory runs out. */
struct tree_node *yaml_read(struct tree *tree, const struct yaml_text *text, struct case_errors *errors,
                            struct status *status);

#endif
