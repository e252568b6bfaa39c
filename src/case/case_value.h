/* The values of keys: read from a tree, checked against the table, written as YAML, described in words. */
#ifndef DELBM_CASE_CASE_VALUE_H
#define DELBM_CASE_CASE_VALUE_H

#include "case/case_keys.h"
#include "case/case_tree.h"
#include "lattice/units.h"

enum { VALUE_TEXT = 256 };

/* Reads a node as the value of the key into `owner` (struct draft or disc_draft). A number with a unit is converted to
 * the unit of the key, and rounded where the key is whole, if this changes it by at most a tenth. False, with nothing
 * stored, if the key does not allow the value. A text is not copied from the tree; `auto` is stored as zero. */
bool value_read(const struct key *key, const struct tree_node *node, const struct units *units, void *owner);

/* Reads a number with a physical unit. */
bool value_quantity(const struct tree_node *node, double *number, struct unit *unit);

/* Formats the value in `owner` as in a case; not for texts. Numbers have the fewest digits that read back equal. */
void value_format(const struct key *key, const void *owner, char text[VALUE_TEXT]);

/* Describes the allowed values: "a number > 0 and <= 10". */
void value_describe(const struct key *key, char text[VALUE_TEXT]);

/* True if a node was refused only because the units block does not determine the size of a cell or a step. */
bool value_lacks_units(const struct key *key, const struct tree_node *node, const struct units *units);

/* The number before value_read rounded it, in the unit of the key, and a text for a note: "1.05 ms is 2.1 steps;
 * rounded to 2, which is 1 ms". 0 if it was not rounded. */
double value_rounding(const struct key *key, const struct tree_node *node, const struct units *units,
                      char text[VALUE_TEXT]);

/* Describes the expected value in place of a node that value_read has refused; a wrong unit first. */
void value_expect(const struct key *key, const struct tree_node *node, const struct units *units,
                  char text[VALUE_TEXT]);

#endif
