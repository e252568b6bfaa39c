/* Similarity of words, for suggestions to misspelt ones. */
#ifndef DELBM_BASE_WORDS_H
#define DELBM_BASE_WORDS_H

#include <stdbool.h>
#include <stddef.h>

enum { WORD_LENGTH = 96 };

/* Optimal string alignment distance: number of insertions, deletions, replacements and swaps of neighbours. Uses the
 * first WORD_LENGTH letters of each word. */
size_t edit_distance(const char *a, const char *b);

/* True if a word at this distance may be intended: at most every third letter of `given` differs. */
bool words_are_near(const char *given, size_t distance);

#endif
