#include "case/case_yaml.h"

#include <stdlib.h>
#include <string.h>
#include <yaml.h>

struct reader {
  struct tree *tree;
  const struct yaml_text *text;
  struct case_errors *errors;
  struct status *status;
};

static void start_parser(yaml_parser_t *parser, const struct yaml_text *text)
{
  yaml_parser_set_input_string(parser, (const unsigned char *)text->bytes, text->size);
}

static void set_place(struct tree_node *node, const struct yaml_text *text, yaml_mark_t mark)
{
  node->origin = text->origin;
  node->line = text->with_lines ? mark.line + 1 : 0;
  node->column = mark.column + 1;
}

static bool refuse_mark(const struct reader *reader, yaml_mark_t mark, const char *what)
{
  struct tree_node node = {0};
  char place[TREE_PLACE];
  set_place(&node, reader->text, mark);
  tree_place(&node, place);
  case_errors_add(reader->errors, "%s: %s", place, what);
  return false;
}

static void refuse_node(const struct reader *reader, struct tree_node *node, const char *expected)
{
  char place[TREE_PLACE], value[TREE_TEXT];
  tree_place(node, place);
  tree_print(node, value);
  case_errors_add(reader->errors, "%s: got %s; expected %s", place, value, expected);
  node->refused = true;
}

static bool refuse_syntax(const struct reader *reader, const yaml_parser_t *parser)
{
  if (parser->error == YAML_MEMORY_ERROR || !parser->problem) /* libyaml may omit the error for lack of memory */
    return status_fail(reader->status, DELBM_FAILED, "out of memory reading YAML");
  char what[256];
  snprintf(what, sizeof what, "not valid YAML: %s%s%s", parser->problem, parser->context ? ", " : "",
           parser->context ? parser->context : "");
  return refuse_mark(reader, parser->problem_mark, what);
}

struct limits {
  int depth;
  int anchors;
  int documents;
};

static void count_anchor(struct limits *limits, const void *anchor)
{
  if (anchor) limits->anchors++;
}

static bool check_event(const struct reader *reader, struct limits *limits, const yaml_event_t *event)
{
  switch (event->type) {
  case YAML_DOCUMENT_START_EVENT:
    if (++limits->documents > 1) return refuse_mark(reader, event->start_mark, "a second document; expected only one");
    break;
  case YAML_SCALAR_EVENT:
    count_anchor(limits, event->data.scalar.anchor);
    break;
  case YAML_SEQUENCE_START_EVENT:
    count_anchor(limits, event->data.sequence_start.anchor);
    limits->depth++;
    break;
  case YAML_MAPPING_START_EVENT:
    count_anchor(limits, event->data.mapping_start.anchor);
    limits->depth++;
    break;
  case YAML_SEQUENCE_END_EVENT:
  case YAML_MAPPING_END_EVENT:
    limits->depth--;
    break;
  default:
    break;
  }
  if (limits->depth > YAML_DEPTH)
    return refuse_mark(reader, event->start_mark, "nested too deep; expected at most 32 levels");
  if (limits->anchors > YAML_ANCHORS)
    return refuse_mark(reader, event->start_mark, "too many anchors; expected at most 256");
  return true;
}

/* Limits depth and number of anchors before libyaml loads the document: its time is quadratic in both. */
static bool check_limits(const struct reader *reader)
{
  yaml_parser_t parser;
  if (!yaml_parser_initialize(&parser)) return status_fail(reader->status, DELBM_FAILED, "out of memory reading YAML");
  start_parser(&parser, reader->text);
  struct limits limits = {0};
  bool more = true, valid = true;
  while (more && valid) {
    yaml_event_t event;
    if (!yaml_parser_parse(&parser, &event)) {
      valid = refuse_syntax(reader, &parser);
      break;
    }
    valid = check_event(reader, &limits, &event);
    more = event.type != YAML_STREAM_END_EVENT;
    yaml_event_delete(&event);
  }
  if (valid && limits.documents == 0) {
    const yaml_mark_t start = {0};
    valid = refuse_mark(reader, start, "empty; expected a YAML document");
  }
  yaml_parser_delete(&parser);
  return valid;
}

static int compare_keys(const void *a, const void *b)
{
  const struct tree_node *left = *(struct tree_node *const *)a, *right = *(struct tree_node *const *)b;
  int order = strcmp(left->text, right->text);
  return order ? order : (left > right) - (left < right);
}

static void refuse_twice(const struct reader *reader, const struct tree_node *first, struct tree_node *second)
{
  second->refused = true;
  char place[TREE_PLACE], name[TREE_TEXT];
  tree_place(second, place);
  tree_show(second->text, name);
  if (second->line)
    case_errors_add(reader->errors, "%s: key %s given twice, in lines %zu and %zu", place, name, first->line,
                    second->line);
  else
    case_errors_add(reader->errors, "%s: key %s given twice", place, name);
}

/* Refuses repeated keys. False if a key is not a scalar, or memory runs out. */
static bool check_mapping(const struct reader *reader, const struct tree_node *mapping)
{
  struct tree_node **keys = tree_allocate(reader->tree, mapping->count, sizeof *keys, reader->status);
  if (!keys) return false;
  bool usable = true;
  for (size_t i = 0; i < mapping->count; i++) {
    keys[i] = mapping->entries[i].key;
    if (keys[i]->kind == TREE_SCALAR) continue;
    refuse_node(reader, keys[i], "a word as the key");
    usable = false;
  }
  if (!usable) return false;
  qsort(keys, mapping->count, sizeof *keys, compare_keys);
  for (size_t i = 1; i < mapping->count; i++) {
    if (strcmp(keys[i - 1]->text, keys[i]->text) == 0) refuse_twice(reader, keys[i - 1], keys[i]);
  }
  return true;
}

static bool read_scalar(const struct reader *reader, struct tree_node *node, const yaml_node_t *source)
{
  const char *text = (const char *)source->data.scalar.value;
  node->kind = TREE_SCALAR;
  node->plain = source->data.scalar.style == YAML_PLAIN_SCALAR_STYLE;
  node->text = tree_copy_text(reader->tree, text, source->data.scalar.length, reader->status);
  if (!node->text) return false;
  if (strlen(text) != source->data.scalar.length) refuse_node(reader, node, "text without a NUL character");
  return true;
}

static bool read_list(const struct reader *reader, struct tree_node *node, const yaml_node_t *source,
                      struct tree_node *all)
{
  const yaml_node_item_t *items = source->data.sequence.items.start;
  node->kind = TREE_LIST;
  node->count = (size_t)(source->data.sequence.items.top - items);
  node->entries = tree_allocate(reader->tree, node->count, sizeof *node->entries, reader->status);
  if (!node->entries) return false;
  for (size_t i = 0; i < node->count; i++) node->entries[i].value = &all[items[i] - 1];
  return true;
}

static bool read_mapping(const struct reader *reader, struct tree_node *node, const yaml_node_t *source,
                         struct tree_node *all)
{
  const yaml_node_pair_t *pairs = source->data.mapping.pairs.start;
  node->kind = TREE_MAPPING;
  node->count = (size_t)(source->data.mapping.pairs.top - pairs);
  node->entries = tree_allocate(reader->tree, node->count, sizeof *node->entries, reader->status);
  if (!node->entries) return false;
  for (size_t i = 0; i < node->count; i++)
    node->entries[i] = (struct tree_entry){&all[pairs[i].key - 1], &all[pairs[i].value - 1]};
  return true;
}

static bool has_tag(const yaml_node_t *node)
{
  const char *tag = (const char *)node->tag;
  return strcmp(tag, YAML_STR_TAG) != 0 && strcmp(tag, YAML_SEQ_TAG) != 0 && strcmp(tag, YAML_MAP_TAG) != 0;
}

/* False if memory runs out. */
static bool read_node(const struct reader *reader, struct tree_node *node, const yaml_node_t *source,
                      struct tree_node *all)
{
  set_place(node, reader->text, source->start_mark);
  if (source->type == YAML_SCALAR_NODE) return read_scalar(reader, node, source);
  if (source->type == YAML_SEQUENCE_NODE) return read_list(reader, node, source, all);
  return read_mapping(reader, node, source, all);
}

/* One node of the tree for each node of the document, so that aliases and cycles are preserved. Nodes, and hence
 * errors, are in the order of the document. */
static struct tree_node *read_document(const struct reader *reader, const yaml_document_t *document)
{
  const yaml_node_t *source = document->nodes.start;
  size_t count = (size_t)(document->nodes.top - source);
  struct tree_node *all = tree_allocate(reader->tree, count, sizeof *all, reader->status);
  if (!all) return NULL;
  for (size_t i = 0; i < count; i++) {
    if (!read_node(reader, &all[i], &source[i], all)) return NULL;
  }
  bool usable = true;
  for (size_t i = 0; i < count; i++) {
    if (has_tag(&source[i])) refuse_node(reader, &all[i], "no tag before it");
    if (all[i].kind == TREE_MAPPING && !check_mapping(reader, &all[i])) usable = false;
  }
  return usable ? &all[0] : NULL;
}

struct tree_node *yaml_read(struct tree *tree, const struct yaml_text *text, struct case_errors *errors,
                            struct status *status)
{
  const struct reader reader = {tree, text, errors, status};
  if (!check_limits(&reader)) return NULL;
  yaml_parser_t parser;
  if (!yaml_parser_initialize(&parser)) {
    status_fail(status, DELBM_FAILED, "out of memory reading YAML");
    return NULL;
  }
  start_parser(&parser, text);
  yaml_document_t document;
  struct tree_node *root = NULL;
  if (yaml_parser_load(&parser, &document)) {
    root = read_document(&reader, &document);
    yaml_document_delete(&document);
  } else {
    refuse_syntax(&reader, &parser);
  }
  yaml_parser_delete(&parser);
  return root;
}
