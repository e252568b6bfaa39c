#include "base/words.h"

#include <string.h>

static size_t smallest(size_t a, size_t b, size_t c)
{
  size_t min = a < b ? a : b;
  return min < c ? min : c;
}

size_t edit_distance(const char *a, const char *b)
{
  const size_t length = strnlen(b, WORD_LENGTH);
  size_t rows[3]
             [WORD_LENGTH + 1]; /* distances of the first i - 2, i - 1 and i letters of a to the first j letters of b */
  size_t *before = rows[0], *last = rows[1], *row = rows[2];
  for (size_t j = 0; j <= length; j++) last[j] = j;
  for (size_t i = 1; i <= WORD_LENGTH && a[i - 1]; i++) {
    row[0] = i;
    for (size_t j = 1; j <= length; j++) {
      row[j] = smallest(last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1]));
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped && before[j - 2] + 1 < row[j]) row[j] = before[j - 2] + 1;
    }
    size_t *spare = before;
    before = last;
    last = row;
    row = spare;
  }
  return last[length];
}

bool words_are_near(const char *given, size_t distance)
{
  return distance <= strnlen(given, WORD_LENGTH) / 3;
}
