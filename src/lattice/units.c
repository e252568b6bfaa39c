#include "lattice/units.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A named unit: its value in SI base units and its powers of length, time and mass. */
struct named {
  const char *name;
  long double scale;
  int length, time, mass;
};

static const struct named physical[] = {
    {"m", 1, 1, 0, 0},
    {"km", 1e3L, 1, 0, 0},
    {"cm", 1e-2L, 1, 0, 0},
    {"mm", 1e-3L, 1, 0, 0},
    {"um", 1e-6L, 1, 0, 0},
    {"nm", 1e-9L, 1, 0, 0},
    {"s", 1, 0, 1, 0},
    {"ms", 1e-3L, 0, 1, 0},
    {"us", 1e-6L, 0, 1, 0},
    {"min", 60, 0, 1, 0},
    {"h", 3600, 0, 1, 0},
    {"Hz", 1, 0, -1, 0},
    {"kg", 1, 0, 0, 1},
    {"g", 1e-3L, 0, 0, 1},
    {"mg", 1e-6L, 0, 0, 1},
    {"N", 1, 1, -2, 1},
    {"mN", 1e-3L, 1, -2, 1},
    {"Pa", 1, -1, -2, 1},
    {"rad", 1, 0, 0, 0},
    {"radians", 1, 0, 0, 0},
    {"deg", 0.01745329251994329577L, 0, 0, 0},
    {"rpm", 0.10471975511965977462L, 0, -1, 0},
    {"1", 1, 0, 0, 0},
};

static bool find_lattice(const char *name, const struct units *units, struct named *found)
{
  const struct named lattice[] = {{"cells", units->dx, 1, 0, 0},
                                  {"step", units->dt, 0, 1, 0},
                                  {"steps", units->dt, 0, 1, 0},
                                  {"fluid density", units->density, -3, 0, 1}};
  for (size_t i = 0; i < sizeof lattice / sizeof lattice[0]; i++)
    if (strcmp(lattice[i].name, name) == 0) {
      *found = lattice[i];
      return true;
    }
  return false;
}

static bool find_physical(const char *name, struct named *found)
{
  for (size_t i = 0; i < sizeof physical / sizeof physical[0]; i++)
    if (strcmp(physical[i].name, name) == 0) {
      *found = physical[i];
      return true;
    }
  return false;
}

const char *unit_name(size_t k)
{
  return k < sizeof physical / sizeof physical[0] ? physical[k].name : NULL;
}

/* Multiplies the unit by a name of `length` characters, spaces around it left out, to a power. */
static bool multiply(struct unit *unit, const char *name, size_t length, int power, const struct units *units)
{
  char word[32];
  struct named named;
  while (length > 0 && isspace((unsigned char)*name)) name++, length--;
  while (length > 0 && isspace((unsigned char)name[length - 1])) length--;
  if (length >= sizeof word) return false;
  snprintf(word, sizeof word, "%.*s", (int)length, name);
  const bool lattice = find_lattice(word, units, &named);
  if (!lattice && !find_physical(word, &named)) return false;
  unit->lattice |= lattice;
  unit->length += power * named.length;
  unit->time += power * named.time;
  unit->mass += power * named.mass;
  unit->scale = named.scale > 0 ? unit->scale * powl(named.scale, power) : 0;
  return true;
}

bool unit_parse(const char *text, const struct units *units, struct unit *unit)
{
  *unit = (struct unit){.scale = 1};
  int sign = 1;
  while (*text) {
    const size_t length = strcspn(text, "*/^");
    const char *name = text;
    int power = 1;
    text += length;
    if (*text == '^') {
      char *end;
      const long given = strtol(text + 1, &end, 10);
      if (end == text + 1 || given < -9 || given > 9) return false;
      power = (int)given;
      text = end + strspn(end, " ");
    }
    if (!multiply(unit, name, length, sign * power, units)) return false;
    if (*text == '\0') return true;
    if ((*text != '*' && *text != '/') || text[1] == '\0') return false;
    sign = *text == '/' ? -1 : 1;
    text++;
  }
  return true;
}

bool unit_same_dimension(const struct unit *a, const struct unit *b)
{
  return a->length == b->length && a->time == b->time && a->mass == b->mass;
}

void unit_si_text(const struct unit *unit, char text[UNIT_TEXT])
{
  const struct {
    const char *name;
    int power;
  } parts[] = {{"kg", unit->mass}, {"m", unit->length}, {"s", unit->time}};
  size_t length = 0;
  *text = '\0';
  for (int sign = 1; sign >= -1; sign -= 2)
    for (size_t k = 0; k < sizeof parts / sizeof parts[0]; k++) {
      const int power = sign * parts[k].power;
      const char *before = sign < 0 ? (length > 0 ? "/" : "1/") : (length > 0 ? "*" : "");
      if (power > 0) length += (size_t)snprintf(text + length, UNIT_TEXT - length, "%s%s", before, parts[k].name);
      if (power > 1) length += (size_t)snprintf(text + length, UNIT_TEXT - length, "^%d", power);
    }
}

double unit_convert(double number, const struct unit *from, const struct unit *to)
{
  char text[48];
  snprintf(text, sizeof text, "%.15Lg", number * from->scale / to->scale);
  return strtod(text, NULL);
}
