#include "case/case_reference.h"

#include "case/case_keys.h"
#include "case/case_value.h"

static void print_fallback(const struct key *key, FILE *file)
{
  if (key_is_required(key))
    fputs("required", file);
  else
    fprintf(file, "default %s", key_has_default(key) ? key->fallback : "as follows");
}

void case_print_keys(FILE *file)
{
  size_t count;
  const struct key *end = key_table(&count) + count;
  for (const struct key *key = end - count; key < end; key++) {
    char allowed[VALUE_TEXT];
    value_describe(key, allowed);
    fprintf(file, "%s\n    %s", key->path, allowed);
    if (*key->unit) fprintf(file, "; %s", key->unit);
    fputs("; ", file);
    print_fallback(key, file);
    fprintf(file, "\n    %s\n", key->help);
  }
}
