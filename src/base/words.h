/* How alike two words are, to offer what may have been meant by a misspelt one. */
#ifndef DELBM_BASE_WORDS_H
#define DELBM_BASE_WORDS_H

#include <stddef.h>

enum { WORD_LENGTH = 96 };

/* Letters to insert, delete or replace to turn one word into the other (Levenshtein). Only the first WORD_LENGTH
 * letters of each count. */
size_t edit_distance(const char *a, const char *b);

#endif
