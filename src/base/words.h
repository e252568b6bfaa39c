/* How alike two words are, to offer what may have been meant by a misspelt one. */
#ifndef DELBM_BASE_WORDS_H
#define DELBM_BASE_WORDS_H

#include <stdbool.h>
#include <stddef.h>

enum { WORD_LENGTH = 96 };

/* Letters to insert, delete or replace, or neighbours to swap, to turn one word into the other (optimal string
 * alignment, a Levenshtein distance with swaps). Only the first WORD_LENGTH letters of each count. */
size_t edit_distance(const char *a, const char *b);

/* True if another word at this distance may be meant by the one given: at most every third letter differs. */
bool words_are_near(const char *given, size_t distance);

#endif
