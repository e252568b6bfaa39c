/* A strict reader of JSON (RFC 8259), for files that others read: no trailing commas, no NaN, no names without
 * quotes. */
#ifndef DELBM_TESTS_JSON_H
#define DELBM_TESTS_JSON_H

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static inline const char *json_space(const char *at)
{
  return at + strspn(at, " \t\r\n");
}

static const char *json_value(const char *at);

/* Each json_ function returns the end of what it has read, or NULL. */
static inline const char *json_text(const char *at)
{
  if (*at++ != '"') return NULL;
  for (; *at != '"'; at++) {
    if ((unsigned char)*at < 0x20) return NULL;
    if (*at != '\\') continue;
    at++;
    if (*at == 'u') {
      if (strspn(at + 1, "0123456789abcdefABCDEF") < 4) return NULL;
      at += 4;
    } else if (!*at || !strchr("\"\\/bfnrt", *at))
      return NULL;
  }
  return at + 1;
}

static inline const char *json_number(const char *at)
{
  if (*at == '-') at++;
  if (!isdigit((unsigned char)*at) || (*at == '0' && isdigit((unsigned char)at[1]))) return NULL;
  at += strspn(at, "0123456789");
  if (*at == '.') {
    if (!isdigit((unsigned char)*++at)) return NULL;
    at += strspn(at, "0123456789");
  }
  if (*at == 'e' || *at == 'E') {
    at += 1 + (at[1] == '+' || at[1] == '-');
    if (!isdigit((unsigned char)*at)) return NULL;
    at += strspn(at, "0123456789");
  }
  return at;
}

/* An object's members or a list's items. */
static inline const char *json_many(const char *at, char close)
{
  at = json_space(at + 1);
  if (*at == close) return at + 1;
  for (;;) {
    if (close == '}') {
      if (!(at = json_text(at)) || *(at = json_space(at)) != ':') return NULL;
      at = json_space(at + 1);
    }
    if (!(at = json_value(at))) return NULL;
    at = json_space(at);
    if (*at == close) return at + 1;
    if (*at != ',') return NULL;
    at = json_space(at + 1);
  }
}

static const char *json_value(const char *at)
{
  static const char *const words[] = {"true", "false", "null"};
  if (*at == '{') return json_many(at, '}');
  if (*at == '[') return json_many(at, ']');
  if (*at == '"') return json_text(at);
  for (int k = 0; k < 3; k++)
    if (strncmp(at, words[k], strlen(words[k])) == 0) return at + strlen(words[k]);
  return json_number(at);
}

static inline bool json_is_valid(const char *text)
{
  const char *end = json_value(json_space(text));
  return end && *json_space(end) == '\0';
}

/* The value of a member of the outermost object of valid JSON; NULL without such a member. */
static inline const char *json_member(const char *text, const char *name)
{
  const char *at = json_space(text);
  while (*at == '{' || *at == ',') {
    const char *key = json_space(at + 1), *end = json_text(key);
    if (!end) return NULL;
    const char *value = json_space(json_space(end) + 1);
    if ((size_t)(end - key) == strlen(name) + 2 && strncmp(key + 1, name, strlen(name)) == 0) return value;
    at = json_space(json_value(value));
  }
  return NULL;
}

/* A whole file; NULL if it cannot be read. */
static inline char *json_read(const char *path)
{
  FILE *file = fopen(path, "r");
  char *text = NULL;
  size_t size = 0;
  if (!file || getdelim(&text, &size, '\0', file) < 0) {
    free(text);
    text = NULL;
  }
  if (file) fclose(file);
  return text;
}

#endif
