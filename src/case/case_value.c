#include "case/case_value.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_COMPONENTS = 4 };

struct range {
  double low, high;
  bool low_open, high_open;
};

static size_t components(enum key_kind kind)
{
  switch (kind) {
  case KEY_BOX:
  case KEY_CELLS:
    return 4;
  case KEY_SIZE:
  case KEY_POINT:
  case KEY_VECTOR:
    return 2;
  default:
    return 1;
  }
}

static bool is_integral(enum key_kind kind)
{
  return kind == KEY_INTEGER || kind == KEY_LONG || kind == KEY_SIZE || kind == KEY_CELLS;
}

/* True if the value is stored as int. */
static bool is_int(enum key_kind kind)
{
  return kind == KEY_INTEGER || kind == KEY_SIZE;
}

static bool is_numeric(enum key_kind kind)
{
  return kind != KEY_TEXT && kind != KEY_FLAG && kind != KEY_CHOICE;
}

/* Reads a range of the table, "[low, high)"; returns the rest of the text. */
static const char *parse_range(const char *text, struct range *range)
{
  char *end;
  if (strncmp(text, key_or_automatic, strlen(key_or_automatic)) == 0) text += strlen(key_or_automatic);
  range->low_open = *text == '(';
  range->low = strtod(text + 1, &end);
  range->high = strtod(end + 1, &end);
  range->high_open = *end == ')';
  return end + 1;
}

static bool in_range(const struct range *range, double x)
{
  bool above = range->low_open ? x > range->low : x >= range->low;
  bool below = range->high_open ? x < range->high : x <= range->high;
  return above && below;
}

/* The end of a decimal number of YAML's core schema, finite and not hexadecimal, at the start of the text; or NULL. */
static const char *decimal_end(const char *text)
{
  const char *at = text + (*text == '+' || *text == '-');
  if (at[0] == '0' && (at[1] == 'x' || at[1] == 'X')) return NULL;
  size_t digits = strspn(at, "0123456789");
  at += digits;
  if (*at == '.') {
    size_t fraction = strspn(at + 1, "0123456789");
    digits += fraction;
    at += 1 + fraction;
  }
  if (digits == 0) return NULL;
  if (*at == 'e' || *at == 'E') {
    at += 1 + (at[1] == '+' || at[1] == '-');
    size_t exponent = strspn(at, "0123456789");
    if (exponent == 0) return NULL;
    at += exponent;
  }
  return at;
}

/* True if a decimal number has no fraction: its last digit other than 0 is not after the decimal point. */
static bool is_whole(const char *text)
{
  size_t mantissa = strcspn(text, "eE");
  size_t point = strcspn(text, ".eE");
  long exponent = text[mantissa] ? strtol(text + mantissa + 1, NULL, 10) : 0;
  for (size_t i = mantissa; i-- > 0;) {
    if (text[i] < '1' || text[i] > '9') continue;
    long place = i < point ? (long)(point - i) - 1 : -(long)(i - point);
    return exponent >= -place;
  }
  return true;
}

/* Faults of a number. */
enum fault {
  FAULT_NONE,
  FAULT_NUMBER,        /* not a number, or not whole */
  FAULT_UNIT,          /* unknown unit */
  FAULT_DIMENSION,     /* unit of another dimension */
  FAULT_WITHOUT_UNIT,  /* no unit where one is required */
  FAULT_WITHOUT_UNITS, /* no units block for its conversion */
  FAULT_NOT_WHOLE      /* after conversion neither whole nor close */
};

/* Largest relative change of a converted number by rounding to a whole one; below 1e-9 it counts as round-off. */
static const double max_rounding = 0.1;

/* Converts a number with a unit to the unit of the key. */
static enum fault convert(const struct key *key, const char *text, const struct units *units, double *number)
{
  struct unit from, to;
  if (!unit_parse(text, units, &from)) return FAULT_UNIT;
  if (*key->unit == '\0' || !unit_parse(key->unit, units, &to) || !unit_same_dimension(&from, &to))
    return FAULT_DIMENSION;
  if (from.scale == 0 || to.scale == 0) return FAULT_WITHOUT_UNITS;
  *number = unit_convert(*number, &from, &to);
  if (!is_integral(key->kind)) return FAULT_NONE;
  const double whole = round(*number);
  if (fabs(*number - whole) > max_rounding * fabs(*number)) return FAULT_NOT_WHOLE;
  *number = whole;
  return FAULT_NONE;
}

/* True for keys of the units block, which have physical units. */
static bool needs_unit(const struct key *key)
{
  const struct units none = {0};
  struct unit unit;
  return *key->unit && unit_parse(key->unit, &none, &unit) && !unit.lattice && (unit.length || unit.time || unit.mass);
}

static enum fault read_number(const struct key *key, const struct tree_node *node, const struct units *units,
                              double *number)
{
  const char *end = node->kind == TREE_SCALAR && node->plain ? decimal_end(node->text) : NULL;
  if (!end) return FAULT_NUMBER;
  errno = 0;
  *number = strtod(node->text, NULL);
  if (errno != 0 || !isfinite(*number)) return FAULT_NUMBER;
  if (*end) return convert(key, end, units, number);
  if (needs_unit(key)) return FAULT_WITHOUT_UNIT;
  return is_integral(key->kind) && !is_whole(node->text) ? FAULT_NUMBER : FAULT_NONE;
}

bool value_quantity(const struct tree_node *node, double *number, struct unit *unit)
{
  const struct units none = {0};
  const char *end = node->kind == TREE_SCALAR && node->plain ? decimal_end(node->text) : NULL;
  if (!end || *end == '\0') return false;
  *number = strtod(node->text, NULL);
  return isfinite(*number) && unit_parse(end, &none, unit) && unit->scale > 0;
}

static bool read_numbers(const struct key *key, const struct tree_node *node, const struct units *units,
                         double *numbers)
{
  size_t count = components(key->kind);
  struct range range;
  parse_range(key->allowed, &range);
  if (count == 1) return !read_number(key, node, units, numbers) && in_range(&range, numbers[0]);
  if (node->kind != TREE_LIST || node->count != count) return false;
  for (size_t i = 0; i < count; i++) {
    if (read_number(key, node->entries[i].value, units, &numbers[i])) return false;
    if (key->kind != KEY_VECTOR && !in_range(&range, numbers[i])) return false;
  }
  return key->kind != KEY_VECTOR || in_range(&range, hypot(numbers[0], numbers[1]));
}

/* The ranges of the table ensure that whole numbers fit their types. */
static void store_numbers(const struct key *key, const double *numbers, unsigned char *field)
{
  for (size_t i = 0; i < components(key->kind); i++) {
    if (key->kind == KEY_LONG) {
      int64_t wide = (int64_t)numbers[i];
      memcpy(field + i * sizeof wide, &wide, sizeof wide);
    } else if (is_int(key->kind)) {
      int narrow = (int)numbers[i];
      memcpy(field + i * sizeof narrow, &narrow, sizeof narrow);
    } else {
      memcpy(field + i * sizeof numbers[i], &numbers[i], sizeof numbers[i]);
    }
  }
}

static bool is_null(const struct tree_node *node)
{
  static const char *const words[] = {"", "~", "null", "Null", "NULL"};
  for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
    if (node->plain && strcmp(node->text, words[i]) == 0) return true;
  }
  return false;
}

/* ASCII upper case, independent of the locale. */
static char capital(char letter)
{
  return (char)(letter - 'a' + 'A');
}

/* True if the text is the word in one of the spellings of YAML: lower case, upper case, capitalised. */
static bool is_word(const char *text, const char *word)
{
  if (strcmp(text, word) == 0) return true;
  if (*text != capital(*word)) return false;
  size_t k = 1;
  while (word[k] && text[k] == capital(word[k])) k++;
  return (text[k] == '\0' && word[k] == '\0') || strcmp(text + 1, word + 1) == 0;
}

/* Truth values of YAML 1.1. */
static bool read_flag(const struct tree_node *node, unsigned char *field)
{
  static const char *const words[][2] = {{"false", "true"}, {"no", "yes"}, {"off", "on"}};
  for (size_t i = 0; node->plain && i < sizeof words / sizeof words[0]; i++) {
    const bool flag = is_word(node->text, words[i][1]);
    if (!flag && !is_word(node->text, words[i][0])) continue;
    memcpy(field, &flag, sizeof flag);
    return true;
  }
  return false;
}

static bool read_choice(const char *choices, const char *text, unsigned char *field)
{
  int index = 0;
  for (const char *at = choices; *at; at += *at == '|') {
    size_t length = strcspn(at, "|");
    if (strlen(text) == length && strncmp(at, text, length) == 0) {
      memcpy(field, &index, sizeof index);
      return true;
    }
    at += length;
    index++;
  }
  return false;
}

bool value_read(const struct key *key, const struct tree_node *node, const struct units *units, void *owner)
{
  unsigned char *field = (unsigned char *)owner + key->offset;
  bool automatic = key_is_automatic(key) && node->kind == TREE_SCALAR && strcmp(node->text, "auto") == 0;
  if (is_numeric(key->kind)) {
    double numbers[MOST_COMPONENTS] = {0};
    if (!automatic && !read_numbers(key, node, units, numbers)) return false;
    store_numbers(key, numbers, field);
    return true;
  }
  if (node->kind != TREE_SCALAR) return false;
  if (key->kind == KEY_FLAG) return read_flag(node, field);
  if (key->kind == KEY_CHOICE) return read_choice(key->allowed, node->text, field);
  if (is_null(node)) return false;
  const char *text = automatic ? NULL : node->text;
  memcpy(field, &text, sizeof text);
  return true;
}

/* The least of 15, 16 or 17 digits that reads back equal. */
static void format_number(double number, char text[32])
{
  for (int digits = 15; digits <= 17; digits++) {
    snprintf(text, 32, "%.*g", digits, number);
    if (strtod(text, NULL) == number) return;
  }
}

static void format_component(const struct key *key, const unsigned char *field, size_t i, char text[32])
{
  if (key->kind == KEY_LONG) {
    int64_t wide;
    memcpy(&wide, field + i * sizeof wide, sizeof wide);
    snprintf(text, 32, "%lld", (long long)wide);
  } else if (is_int(key->kind)) {
    int narrow;
    memcpy(&narrow, field + i * sizeof narrow, sizeof narrow);
    snprintf(text, 32, "%d", narrow);
  } else {
    double number;
    memcpy(&number, field + i * sizeof number, sizeof number);
    format_number(number, text);
  }
}

/* True for keys at which a stored zero is `auto`: the number 0 is not allowed. */
static bool is_auto_if_zero(const struct key *key)
{
  struct range range;
  parse_range(key->allowed, &range);
  return key_is_automatic(key) && !in_range(&range, 0);
}

static void format_numbers(const struct key *key, const unsigned char *field, char text[VALUE_TEXT])
{
  size_t count = components(key->kind), length = 0;
  for (size_t i = 0; i < count; i++) {
    char number[32];
    format_component(key, field, i, number);
    const char *before = i > 0 ? ", " : count > 1 ? "[" : "";
    length += (size_t)snprintf(text + length, VALUE_TEXT - length, "%s%s", before, number);
  }
  if (count > 1) snprintf(text + length, VALUE_TEXT - length, "]");
  if (needs_unit(key)) snprintf(text + length, VALUE_TEXT - length, " %s", key->unit);
  if (is_auto_if_zero(key) && strcmp(text, "0") == 0) snprintf(text, VALUE_TEXT, "auto");
}

void value_format(const struct key *key, const void *owner, char text[VALUE_TEXT])
{
  const unsigned char *field = (const unsigned char *)owner + key->offset;
  if (is_numeric(key->kind)) {
    format_numbers(key, field, text);
  } else if (key->kind == KEY_CHOICE) {
    int value, length;
    memcpy(&value, field, sizeof value);
    const char *name = key_choice(key, value, &length);
    snprintf(text, VALUE_TEXT, "%.*s", length, name);
  } else {
    bool flag;
    memcpy(&flag, field, sizeof flag);
    snprintf(text, VALUE_TEXT, "%s", flag ? "true" : "false");
  }
}

/* Text under construction in a buffer of VALUE_TEXT bytes. */
struct phrase {
  char *text;
  size_t length;
};

static void say(struct phrase *phrase, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void say(struct phrase *phrase, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  int length = vsnprintf(phrase->text + phrase->length, VALUE_TEXT - phrase->length, format, arguments);
  va_end(arguments);
  if (length > 0) phrase->length += (size_t)length;
  if (phrase->length >= VALUE_TEXT) phrase->length = VALUE_TEXT - 1;
}

static void describe_choices(struct phrase *phrase, const char *choices)
{
  for (const char *at = choices; *at; at += *at == '|') {
    int length = (int)strcspn(at, "|");
    const char *before = at == choices ? "" : at[length] ? ", " : " or ";
    say(phrase, "%s%.*s", before, length, at);
    at += length;
  }
}

static void describe_range(struct phrase *phrase, const struct key *key)
{
  struct range range;
  const char *reason = parse_range(key->allowed, &range);
  bool low = isfinite(range.low) && key->kind != KEY_VECTOR, high = isfinite(range.high);
  if (low) say(phrase, " %s %.13g", range.low_open ? ">" : ">=", range.low);
  if (low && high) say(phrase, " and");
  if (high) say(phrase, " %s %.13g", range.high_open ? "<" : "<=", range.high);
  if (*reason) say(phrase, " (%s)", reason + strspn(reason, "; "));
}

void value_describe(const struct key *key, char text[VALUE_TEXT])
{
  static const char *const nouns[] = {
      [KEY_TEXT] = "text",
      [KEY_FLAG] = "true or false",
      [KEY_CHOICE] = "",
      [KEY_INTEGER] = "a whole number",
      [KEY_LONG] = "a whole number",
      [KEY_SIZE] = "[x, y], whole numbers",
      [KEY_NUMBER] = "a number",
      [KEY_POINT] = "[x, y]",
      [KEY_VECTOR] = "[x, y] of length",
      [KEY_BOX] = "[x0, y0, x1, y1], numbers",
      [KEY_CELLS] = "[x0, y0, x1, y1], whole numbers",
  };
  struct phrase phrase = {text, 0};
  say(&phrase, "%s%s", key_is_automatic(key) ? "auto or " : "", nouns[key->kind]);
  if (key->kind == KEY_CHOICE) describe_choices(&phrase, key->allowed);
  if (is_numeric(key->kind)) describe_range(&phrase, key);
}

/* Value (in the unit of the key) and unit (as written) of the first number of the node with a fault; without a fault,
 * of the last number with a unit. */
static enum fault find_fault(const struct key *key, const struct tree_node *node, const struct units *units,
                             double *number, const char **unit)
{
  const size_t count = node->kind == TREE_LIST ? node->count : 1;
  enum fault fault = FAULT_NONE;
  *unit = "";
  for (size_t i = 0; i < count && !fault; i++) {
    const struct tree_node *at = node->kind == TREE_LIST ? node->entries[i].value : node;
    const char *end = at->kind == TREE_SCALAR && at->plain ? decimal_end(at->text) : NULL;
    double found = 0;
    fault = end ? read_number(key, at, units, &found) : FAULT_NONE;
    if (!end || (*end == '\0' && !fault)) continue;
    *number = found;
    *unit = end;
  }
  return fault;
}

/* Converts a number from the unit of the key to a unit as written, such as " ms". */
static double in_unit(const struct key *key, double number, const char *unit, const struct units *units)
{
  struct unit from, to;
  const bool known = unit_parse(key->unit, units, &from) && unit_parse(unit, units, &to);
  return known ? unit_convert(number, &from, &to) : NAN;
}

/* The nearest whole numbers, converted to the unit of the value; not 0, which has a special meaning. */
static void say_nearest(struct phrase *phrase, const struct key *key, double number, const char *unit,
                        const struct units *units)
{
  const double whole[] = {floor(number), ceil(number)};
  const char *before = "; nearest: ";
  struct range range;
  parse_range(key->allowed, &range);
  for (int k = 0; k < 2; k++) {
    if (whole[k] == 0 || !in_range(&range, whole[k])) continue;
    say(phrase, "%s%.10g %s", before, in_unit(key, whole[k], unit, units), unit + strspn(unit, " "));
    before = " or ";
  }
}

double value_rounding(const struct key *key, const struct tree_node *node, const struct units *units,
                      char text[VALUE_TEXT])
{
  const char *end = node->kind == TREE_SCALAR && node->plain ? decimal_end(node->text) : NULL;
  struct unit from, to;
  struct phrase phrase = {text, 0};
  if (!is_integral(key->kind) || !end || *end == '\0') return 0;
  if (!unit_parse(end, units, &from) || !unit_parse(key->unit, units, &to)) return 0;
  const double number = unit_convert(strtod(node->text, NULL), &from, &to), whole = round(number);
  if (fabs(number - whole) <= 1e-9 * fabs(whole)) return 0;
  say(&phrase, "%s is %.6g %s; rounded to %.15g, which is %.6g %s", node->text, number, key->unit, whole,
      in_unit(key, whole, end, units), end + strspn(end, " "));
  return number;
}

/* The allowed units: "cells/step or m/s". */
static void say_units(struct phrase *phrase, const struct key *key)
{
  const struct units none = {0};
  struct unit unit;
  char si[UNIT_TEXT];
  if (*key->unit == '\0' || !unit_parse(key->unit, &none, &unit)) {
    say(phrase, "a number without unit");
    return;
  }
  unit_si_text(&unit, si);
  if (unit.lattice && *si)
    say(phrase, "a value in %s, as a plain number, or in %s", key->unit, si);
  else
    say(phrase, "a value in %s", key->unit);
}

bool value_lacks_units(const struct key *key, const struct tree_node *node, const struct units *units)
{
  double number;
  const char *unit;
  return is_numeric(key->kind) && (units->dx == 0 || units->dt == 0) &&
         find_fault(key, node, units, &number, &unit) == FAULT_WITHOUT_UNITS;
}

void value_expect(const struct key *key, const struct tree_node *node, const struct units *units, char text[VALUE_TEXT])
{
  struct phrase phrase = {text, 0};
  double number = 0;
  const char *unit = "";
  const enum fault fault = is_numeric(key->kind) ? find_fault(key, node, units, &number, &unit) : FAULT_NUMBER;
  if (fault == FAULT_UNIT || fault == FAULT_DIMENSION) {
    say_units(&phrase, key);
  } else if (fault == FAULT_WITHOUT_UNITS && units->dx > 0 && units->dt > 0) {
    say(&phrase, "units.density beside it, the density of the fluid in kg/m^3");
  } else if (fault == FAULT_WITHOUT_UNITS) {
    say(&phrase,
        "a plain number, in %s; with units, a units block must say what a cell and a step are: units: {dx: 0.1 mm, dt: "
        "0.5 ms}",
        key->unit);
  } else {
    value_describe(key, text);
    phrase.length = strlen(text);
    if (fault == FAULT_WITHOUT_UNIT) say(&phrase, " with its unit, such as 1 %s", key->unit);
    if (fault == FAULT_NOT_WHOLE || (fault == FAULT_NONE && *unit)) say(&phrase, "; it is %.10g %s", number, key->unit);
    if (fault == FAULT_NOT_WHOLE) say_nearest(&phrase, key, number, unit, units);
  }
}
