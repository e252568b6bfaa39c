/* Fuzz target: the reader of cases. The input is a case file, and after a zero byte each, settings as of --set. What is
 * read must be written such that it is read again as the same case; what is refused must come with words. */
#include "input.h"

#include "case/case_file.h"
#include "case/case_write.h"

#include <string.h>

enum { SETTINGS = 8 };

/* The settings that follow the file, each ended by a zero byte, in a copy of them. */
static size_t split(char *text, size_t size, char *settings[SETTINGS])
{
  size_t count = 0;
  for (size_t at = 0; at < size && count < SETTINGS; at += strlen(text + at) + 1) settings[count++] = text + at;
  return count;
}

static bool read_bytes(const void *bytes, size_t size, char *const set[], size_t count, struct scene *scene,
                       struct status *status)
{
  char path[INPUT_PATH];
  struct case_errors errors = {0};
  const int descriptor = input_file(bytes, size, path);
  const bool read = case_read(scene, path, set, count, &errors, status);
  if (!read && case_errors_total(&errors) == 0 && strlen(status->message) == 0) abort();
  if (read && case_errors_total(&errors) > 0) abort();
  case_errors_clear(&errors);
  close(descriptor);
  return read;
}

static uint32_t fingerprint(const struct scene *scene)
{
  uint32_t sum;
  struct status status;
  if (!case_fingerprint(scene, &sum, &status)) abort();
  return sum;
}

static void expect_same_again(const struct scene *scene)
{
  char *text = NULL;
  size_t size;
  struct scene again;
  struct status status;
  FILE *stream = open_memstream(&text, &size);
  if (!stream || !case_write(scene, stream) || fclose(stream) != 0) abort();
  if (!read_bytes(text, size, NULL, 0, &again, &status) || fingerprint(scene) != fingerprint(&again)) {
    fprintf(stderr, "not read again as the same case: %s\n%s\n", status.message, text);
    abort();
  }
  scene_clear(&again);
  free(text);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
  const uint8_t *end = memchr(bytes, 0, size);
  const size_t file = end ? (size_t)(end - bytes) : size, rest = end ? size - file - 1 : 0;
  char *text = calloc(rest + 1, 1), *settings[SETTINGS];
  if (!text) abort();
  if (rest > 0) memcpy(text, end + 1, rest);
  struct scene scene;
  struct status status = {0};
  if (read_bytes(bytes, file, settings, split(text, rest, settings), &scene, &status)) {
    expect_same_again(&scene);
    scene_clear(&scene);
  }
  free(text);
  return 0;
}
