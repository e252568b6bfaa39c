/* Units: texts such as "cm^2/s" or "cells/step" as a scale and powers of length, time and mass.
 *
 * Cell, step and the density of the fluid at rest are units beside metre and second, so that a conversion is one
 * division in either direction. The result is rounded to 15 digits: 0.2 cm are 20 cells of 0.1 mm, not
 * 20.000000000000004, and a case in physical units has the same bits as in lattice units. */
#ifndef DELBM_LATTICE_UNITS_H
#define DELBM_LATTICE_UNITS_H

#include <stdbool.h>
#include <stddef.h>

/* The lattice in SI units. All zero: unknown. A density of 0: unknown. */
struct units {
  double dx;      /* length of a cell, m */
  double dt;      /* duration of a step, s */
  double density; /* of the fluid at rest, kg/m^3 */
};

struct unit {
  long double scale; /* in SI; 0 where it depends on a number that `units` lacks */
  int length, time, mass;
  bool lattice; /* made of cells, steps and the fluid's density */
};

/* Reads names joined by * and /, each with a whole power: "kg*m/s^2". False for an unknown unit; "" is the number 1. */
bool unit_parse(const char *text, const struct units *units, struct unit *unit);

/* The names of physical units, one by one; NULL past the last. */
const char *unit_name(size_t k);

bool unit_same_dimension(const struct unit *a, const struct unit *b);

/* The SI unit of this dimension: "m^2/s". */
enum { UNIT_TEXT = 48 };
void unit_si_text(const struct unit *unit, char text[UNIT_TEXT]);

/* The number in another unit of the same dimension; both scales known. */
double unit_convert(double number, const struct unit *from, const struct unit *to);

#endif
