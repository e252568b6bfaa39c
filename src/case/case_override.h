/* Overrides from the command line, `--set dotted.key=value`, put into the tree of a case. */
#ifndef DELBM_CASE_CASE_OVERRIDE_H
#define DELBM_CASE_CASE_OVERRIDE_H

#include "case/case_errors.h"
#include "case/case_tree.h"

/* Puts "key=value" in place of what *root has there, making the sections that are missing. Sections on the way are
 * copied first, because an alias may share them. False with a reason in `errors` or, for want of memory, in *status. */
bool override_apply(struct tree *tree, struct tree_node **root, const char *text, struct case_errors *errors,
                    struct status *status);

/* Writes a side given by its type alone, `left: wall`, as the mapping it is short for, `left: {type: wall}`. */
bool override_expand_sides(struct tree *tree, struct tree_node **root, struct status *status);

#endif
