#include "case/case_tree.h"

#include "base/memory.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
  BLOCK_BYTES = 1 << 16,
  ALIGNMENT = 16,
  PRINTED_BYTES = 72 /* of a value in a message */
};

struct tree_block {
  struct tree_block *next;
  size_t used;
  size_t size;
  _Alignas(ALIGNMENT) unsigned char bytes[];
};

void tree_clear(struct tree *tree)
{
  while (tree->blocks) {
    struct tree_block *block = tree->blocks;
    tree->blocks = block->next;
    free(block);
  }
}

void *tree_allocate(struct tree *tree, size_t count, size_t size, struct status *status)
{
  size_t bytes;
  if (__builtin_mul_overflow(count, size, &bytes) || bytes > SIZE_MAX / 4) bytes = SIZE_MAX / 4;
  bytes = (bytes + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
  struct tree_block *block = tree->blocks;
  if (!block || block->size - block->used < bytes) {
    size_t room = bytes > BLOCK_BYTES ? bytes : BLOCK_BYTES;
    block = memory_allocate(1, sizeof *block + room, "the case file", status);
    if (!block) return NULL;
    block->size = room;
    block->next = tree->blocks;
    tree->blocks = block;
  }
  void *pointer = block->bytes + block->used;
  block->used += bytes;
  return pointer;
}

const char *tree_copy_text(struct tree *tree, const char *text, size_t length, struct status *status)
{
  char *copy = tree_allocate(tree, length + 1, 1, status);
  return copy ? memcpy(copy, text, length) : NULL;
}

struct tree_node *tree_copy(struct tree *tree, const struct tree_node *node, struct status *status)
{
  struct tree_node *copy = tree_allocate(tree, 1, sizeof *copy, status);
  struct tree_entry *entries = tree_allocate(tree, node->count + 1, sizeof *entries, status);
  if (!copy || !entries) return NULL;
  *copy = *node;
  if (node->count) memcpy(entries, node->entries, node->count * sizeof *entries);
  copy->entries = entries;
  return copy;
}

static struct tree_entry *list_entry(const struct tree_node *list, const char *name)
{
  char *end;
  if (*name < '0' || *name > '9') return NULL;
  unsigned long long index = strtoull(name, &end, 10);
  return *end == '\0' && index < list->count ? &list->entries[index] : NULL;
}

struct tree_entry *tree_entry(const struct tree_node *node, const char *name)
{
  if (node->kind == TREE_LIST) return list_entry(node, name);
  if (node->kind != TREE_MAPPING) return NULL;
  for (size_t i = 0; i < node->count; i++) {
    if (strcmp(node->entries[i].key->text, name) == 0) return &node->entries[i];
  }
  return NULL;
}

struct tree_node *tree_nearest(struct tree_node *root, const char *path, bool *found)
{
  struct tree_node *node = root;
  const char *at = path;
  *found = false;
  while (*at) {
    size_t length = strcspn(at, ".");
    char name[TREE_TEXT];
    if (length >= sizeof name) return node;
    snprintf(name, sizeof name, "%.*s", (int)length, at);
    const struct tree_entry *entry = tree_entry(node, name);
    if (!entry) return node;
    node = entry->value;
    at += length + (at[length] == '.');
  }
  *found = true;
  return node;
}

struct tree_node *tree_find(struct tree_node *root, const char *path)
{
  bool found;
  struct tree_node *node = tree_nearest(root, path, &found);
  return found ? node : NULL;
}

/* Text of at most `limit` bytes under construction. */
struct excerpt {
  char *text;
  size_t length;
  size_t limit;
  bool cut;
};

static void line_byte(struct excerpt *line, char byte)
{
  if (line->length >= line->limit) {
    line->cut = true;
    return;
  }
  bool control = (unsigned char)byte < ' ' || byte == 127;
  line->text[line->length++] = control ? ' ' : byte;
}

static void line_text(struct excerpt *line, const char *text)
{
  for (; *text && !line->cut; text++) line_byte(line, *text);
}

/* Ends the text; marks a cut with "..." at the start of a UTF-8 character. */
static void line_end(struct excerpt *line)
{
  size_t end = line->length;
  if (line->cut) {
    while (end > 0 && ((unsigned char)line->text[end - 1] & 0xC0) == 0x80) end--;
    if (end > 0 && (unsigned char)line->text[end - 1] >= 0xC0) end--;
  }
  memcpy(line->text + end, line->cut ? "..." : "", line->cut ? sizeof "..." : 1);
}

static void line_node(struct excerpt *line, const struct tree_node *node)
{
  if (node->kind == TREE_SCALAR) {
    if (!node->plain) line_byte(line, '"');
    line_text(line, node->text);
    if (!node->plain) line_byte(line, '"');
    return;
  }
  bool list = node->kind == TREE_LIST;
  line_byte(line, list ? '[' : '{');
  for (size_t i = 0; i < node->count && !line->cut; i++) {
    if (i > 0) line_text(line, ", ");
    if (!list) {
      line_node(line, node->entries[i].key);
      line_text(line, ": ");
    }
    line_node(line, node->entries[i].value);
  }
  line_byte(line, list ? ']' : '}');
}

void tree_print(const struct tree_node *node, char text[TREE_TEXT])
{
  struct excerpt line = {.text = text, .limit = PRINTED_BYTES};
  line_node(&line, node);
  line_end(&line);
  if (*text == '\0') snprintf(text, TREE_TEXT, "nothing");
}

void tree_show(const char *text, char shown[TREE_TEXT])
{
  struct excerpt line = {.text = shown, .limit = PRINTED_BYTES};
  line_text(&line, text);
  line_end(&line);
}

void tree_place(const struct tree_node *node, char place[TREE_PLACE])
{
  struct excerpt line = {.text = place, .limit = TREE_PLACE - 64};
  line_text(&line, node->origin);
  line_end(&line);
  size_t length = strlen(place);
  if (node->line) snprintf(place + length, TREE_PLACE - length, ":%zu:%zu", node->line, node->column);
}
