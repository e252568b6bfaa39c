#include "base/words.h"

#include <string.h>

static size_t smallest(size_t a, size_t b, size_t c)
{
  size_t least = a < b ? a : b;
  return least < c ? least : c;
}

size_t edit_distance(const char *a, const char *b)
{
  size_t length = strnlen(b, WORD_LENGTH);
  size_t row[WORD_LENGTH + 1]; /* distances of a's first i letters to each beginning of b */
  for (size_t j = 0; j <= length; j++) row[j] = j;
  for (size_t i = 0; i < WORD_LENGTH && a[i]; i++) {
    size_t diagonal = row[0];
    row[0] = i + 1;
    for (size_t j = 0; j < length; j++) {
      size_t above = row[j + 1];
      row[j + 1] = smallest(above + 1, row[j] + 1, diagonal + (a[i] != b[j]));
      diagonal = above;
    }
  }
  return row[length];
}
