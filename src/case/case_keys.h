/* The keys of a case file: the table case_keys.def as data, and its queries. */
#ifndef DELBM_CASE_CASE_KEYS_H
#define DELBM_CASE_CASE_KEYS_H

#include <stdbool.h>
#include <stddef.h>

enum { KEY_PATH = 96 }; /* maximum length of a path in the table */

enum key_kind {
  KEY_TEXT,    /* const char * */
  KEY_FLAG,    /* bool */
  KEY_CHOICE,  /* an enumeration */
  KEY_INTEGER, /* int */
  KEY_LONG,    /* int64_t */
  KEY_SIZE,    /* int[2] */
  KEY_NUMBER,  /* double */
  KEY_POINT,   /* double[2] */
  KEY_VECTOR,  /* double[2]; the range is of its length */
  KEY_BOX,     /* double[4] */
  KEY_CELLS    /* double[4], whole numbers */
};

struct key {
  const char *path;
  enum key_kind kind;
  size_t offset; /* of the value in struct draft or, for the keys of a listed disc, in struct disc_draft */
  const char *fallback;
  const char *allowed;
  const char *unit;
  const char *help;
};

/* Prefix of `allowed` for keys with a default value that also allow the word auto. */
static const char key_or_automatic[] = "auto or ";

/* Role of a name in a section of the table. */
enum key_role { ROLE_UNKNOWN, ROLE_KEY, ROLE_SECTION, ROLE_LIST };

const struct key *key_table(size_t *count);

/* The key with this path, or NULL. */
const struct key *key_find(const char *path);

/* Name of a value of the key's enumeration, not terminated, and its length; 0 if there is no such value. */
const char *key_choice(const struct key *key, int value, int *length);

bool key_is_required(const struct key *key);
bool key_is_automatic(const struct key *key);
/* True if the fallback is a value, not "required", "auto" or "derived". */
bool key_has_default(const struct key *key);

/* The part of `path` after the section ("" is the root); NULL if the path is not in the section. */
const char *key_within(const char *path, const char *section);

/* The role of `name` in a section; sets *key if it is a key. */
enum key_role key_role(const char *section, const char *name, const struct key **key);

/* The names in a section, as text separated by commas. */
void key_names(const char *section, char *text, size_t size);

/* The path of the key, section or list most similar to `name` in a section. False if none is similar enough. */
bool key_nearest(const char *section, const char *name, char path[KEY_PATH]);

#endif
