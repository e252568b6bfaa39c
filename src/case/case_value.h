/* The values of keys: read from a tree, checked against the table, written as YAML, described in words. */
#ifndef DELBM_CASE_CASE_VALUE_H
#define DELBM_CASE_CASE_VALUE_H

#include "case/case_keys.h"
#include "case/case_tree.h"
#include "lattice/units.h"

enum { VALUE_TEXT = 256 };

/* Reads a node as the key's value into `owner` (struct draft or disc_draft). A number with a unit is converted to the
 * key's own, and rounded where that must be whole, if that changes it by no more than a tenth. False, with nothing stored, if it is not what the key allows. A text stays in the tree; `auto` is stored as
 * zero. */
bool value_read(const struct key *key, const struct tree_node *node, const struct units *units, void *owner);

/* Reads a number with a physical unit. */
bool value_quantity(const struct tree_node *node, double *number, struct unit *unit);

/* Writes the value in `owner` as it would be written in a case; texts excepted. Numbers are as short
 * as reads back equal. */
void value_format(const struct key *key, const void *owner, char text[VALUE_TEXT]);

/* Says what the key allows: "a number > 0 and <= 10". */
void value_describe(const struct key *key, char text[VALUE_TEXT]);

/* True if a node was refused only because its units cannot be converted: what a cell and a step are is not known. */
bool value_lacks_units(const struct key *key, const struct tree_node *node, const struct units *units);

/* What a number that value_read has rounded was in the key's own unit before, with words on it: "1.05 ms is 2.1 steps;
 * rounded to 2, which is 1 ms". 0 for one that was not rounded. */
double value_rounding(const struct key *key, const struct tree_node *node, const struct units *units,
                      char text[VALUE_TEXT]);

/* Says what is expected in place of a node that value_read has refused, its unit being looked at first. */
void value_expect(const struct key *key, const struct tree_node *node, const struct units *units,
                  char text[VALUE_TEXT]);

#endif
