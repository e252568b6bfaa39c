/* Overrides of the command line, `--set dotted.key=value`, in the tree of a case. */
#ifndef DELBM_CASE_CASE_OVERRIDE_H
#define DELBM_CASE_CASE_OVERRIDE_H

#include "case/case_errors.h"
#include "case/case_tree.h"

/* Replaces or adds the value at "key=value" below *root; missing sections are created. Sections along the path are
 * copied first, since an alias may refer to them elsewhere. False with a reason in `errors`, or in *status if memory
 * runs out. */
bool override_apply(struct tree *tree, struct tree_node **root, const char *text, struct case_errors *errors,
                    struct status *status);

/* Expands short forms: of a side, `left: wall`, to `left: {type: wall}`, `contact.lubrication: 2` to
 * `{cutoff: 2}`, and `fluid: none` to `fluid: {none: true}`. */
bool override_expand(struct tree *tree, struct tree_node **root, struct status *status);

#endif
