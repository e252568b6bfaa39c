#include "output/json.h"

#include <stdbool.h>
#include <stddef.h>

/* Length of the UTF-8 sequence at `text`; 0 if it is not UTF-8. */
static size_t utf8_length(const unsigned char *text)
{
  if (text[0] < 0x80) return 1;
  size_t length = text[0] >= 0xf0 ? 4 : text[0] >= 0xe0 ? 3 : 2;
  if (text[0] < 0xc2 || text[0] > 0xf4) return 0;
  for (size_t k = 1; k < length; k++)
    if ((text[k] & 0xc0) != 0x80) return 0;
  bool overlong = (text[0] == 0xe0 && text[1] < 0xa0) || (text[0] == 0xf0 && text[1] < 0x90);
  bool surrogate = text[0] == 0xed && text[1] >= 0xa0;
  bool beyond = text[0] == 0xf4 && text[1] >= 0x90;
  return overlong || surrogate || beyond ? 0 : length;
}

void json_text(const char *text, FILE *stream)
{
  fputc('"', stream);
  for (const unsigned char *c = (const unsigned char *)text; *c;) {
    size_t length = utf8_length(c);
    if (length == 0)
      fputs("\\ufffd", stream);
    else if (*c < 0x20 || *c == 0x7f)
      fprintf(stream, "\\u%04x", *c);
    else {
      if (*c == '"' || *c == '\\') fputc('\\', stream);
      fwrite(c, 1, length, stream);
    }
    c += length ? length : 1;
  }
  fputc('"', stream);
}
