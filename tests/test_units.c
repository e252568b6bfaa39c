/* Units: conversions, and equality of a case in physical and in lattice units. */
#include "shell.h"

#include "lattice/units.h"

#include <math.h>

TestSuite(unit);
TestSuite(case_in_si, .init = shell_enter, .fini = shell_leave, .timeout = 60 * SLOWNESS);

static const struct units lattice = {.dx = 1e-4, .dt = 5e-4, .density = 1000};

static double converted(double number, const char *from, const char *to)
{
  struct unit a, b;
  cr_assert(unit_parse(from, &lattice, &a), "%s", from);
  cr_assert(unit_parse(to, &lattice, &b), "%s", to);
  cr_assert(unit_same_dimension(&a, &b), "%s, %s", from, to);
  return unit_convert(number, &a, &b);
}

Test(unit, conversions_give_the_number_that_a_person_would)
{
  cr_expect_eq(converted(0.2, "cm", "cells"), 20);
  cr_expect_eq(converted(1e-6, "m^2/s", "cells^2/step"), 0.05);
  cr_expect_eq(converted(-9.81, " m/s^2", "cells/step^2"), -0.024525);
  cr_expect_eq(converted(1010, "kg/m^3", "fluid density"), 1.01);
  cr_expect_eq(converted(1.01, "g/cm^3", "fluid density"), 1.01);
  cr_expect_eq(converted(0.3, "rad/s", "radians/step"), 1.5e-4);
  cr_expect_eq(converted(60, "rpm", "radians/step"), 0.00314159265358979);
  cr_expect_eq(converted(2, "min", "steps"), 240000);
  cr_expect_eq(converted(7, "cells*step^-1", "m/s"), 1.4);
  cr_expect_eq(converted(4e8, "N/m^3", "fluid density*cells/step^2"), 1000);
}

/* Each name with its value in SI base units, by the SI brochure (2019). */
static const struct {
  const char *name;
  double value;
  const char *base;
} in_base_units[] = {
    {"m", 1, "m"},
    {"km", 1000, "m"},
    {"cm", 0.01, "m"},
    {"mm", 0.001, "m"},
    {"um", 0.000001, "m"},
    {"nm", 0.000000001, "m"},
    {"s", 1, "s"},
    {"ms", 0.001, "s"},
    {"us", 0.000001, "s"},
    {"min", 60, "s"},
    {"h", 3600, "s"},
    {"Hz", 1, "1/s"},
    {"kg", 1, "kg"},
    {"g", 0.001, "kg"},
    {"mg", 0.000001, "kg"},
    {"N", 1, "kg*m/s^2"},
    {"mN", 0.001, "kg*m/s^2"},
    {"Pa", 1, "kg/m/s^2"},
    {"rad", 1, ""},
    {"radians", 1, ""},
    {"deg", 3.14159265358979323846 / 180, ""},
    {"rpm", 2 * 3.14159265358979323846 / 60, "1/s"},
    {"1", 1, ""},
};

enum { NAMES = sizeof in_base_units / sizeof in_base_units[0] };

Test(unit, every_name_has_its_value_in_si_base_units_alone_and_to_a_power)
{
  for (int k = 0; k < NAMES; k++) {
    char squared[32], per[64];
    struct unit unit, base, power;
    cr_assert(unit_parse(in_base_units[k].name, &lattice, &unit), "%s", in_base_units[k].name);
    cr_assert(unit_parse(in_base_units[k].base, &lattice, &base));
    cr_expect(unit_same_dimension(&unit, &base) && !unit.lattice, "%s", in_base_units[k].name);
    cr_expect_float_eq((double)(unit.scale / base.scale), in_base_units[k].value, 4e-16 * in_base_units[k].value, "%s",
                       in_base_units[k].name);
    snprintf(squared, sizeof squared, "%s^2", in_base_units[k].name);
    snprintf(per, sizeof per, "%s/%s", squared, in_base_units[k].name);
    const double value = in_base_units[k].value;
    cr_assert(unit_parse(squared, &lattice, &power));
    cr_expect_float_eq((double)power.scale, value * value, 1e-14 * value * value, "%s", squared);
    cr_assert(unit_parse(per, &lattice, &power) && unit_same_dimension(&power, &unit), "%s", per);
    cr_expect_float_eq((double)power.scale, value, 1e-14 * value, "%s", per);
  }
}

Test(unit, no_name_is_without_a_value_above)
{
  size_t count = 0;
  for (const char *name; (name = unit_name(count)); count++) {
    bool found = false;
    for (int k = 0; k < NAMES; k++) found |= strcmp(in_base_units[k].name, name) == 0;
    cr_expect(found, "%s", name);
  }
  cr_expect_eq(count, NAMES);
}

Test(unit, of_the_lattice_have_the_values_of_the_units_block)
{
  static const struct {
    const char *name, *base;
    double value;
  } names[] = {{"cells", "m", 1e-4}, {"step", "s", 5e-4}, {"steps", "s", 5e-4}, {"fluid density", "kg/m^3", 1000}};
  for (int k = 0; k < 4; k++) {
    struct unit unit, unknown;
    cr_expect_eq(converted(1, names[k].name, names[k].base), names[k].value, "%s", names[k].name);
    cr_assert(unit_parse(names[k].name, &lattice, &unit) && unit.lattice);
    cr_assert(unit_parse(names[k].name, &(struct units){0}, &unknown));
    cr_expect_eq(unknown.scale, 0, "%s without a units block", names[k].name);
  }
}

Test(unit, dimension_is_told_in_si_base_units)
{
  static const char *const texts[][2] = {{"fluid density*cells^3/step^2", "kg/s^2"},
                                         {"fluid density*cells^4/step^2", "kg*m/s^2"},
                                         {"fluid density*cells/step^2", "kg/m^2/s^2"},
                                         {"cells^2/step", "m^2/s"},
                                         {"radians/step", "1/s"},
                                         {"radians", ""},
                                         {"Pa", "kg/m/s^2"}};
  for (size_t k = 0; k < sizeof texts / sizeof texts[0]; k++) {
    struct unit unit;
    char text[UNIT_TEXT];
    cr_assert(unit_parse(texts[k][0], &lattice, &unit));
    unit_si_text(&unit, text);
    cr_expect_str_eq(text, texts[k][1]);
  }
}

Test(unit, what_is_no_unit_is_refused)
{
  static const char *const wrong[] = {"furlong", "m^", "m^x", "m//s", "m/", "/s", "m s", "m^2^2", "m^99", "(m)", "m*"};
  struct unit unit;
  for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; k++)
    cr_expect_not(unit_parse(wrong[k], &lattice, &unit), "%s", wrong[k]);
}

Test(unit, every_conversion_goes_there_and_back_within_15_digits)
{
  struct unit si, cells;
  unit_parse("m/s", &lattice, &si);
  unit_parse("cells/step", &lattice, &cells);
  for (int k = 1; k < 1000; k++) {
    const double speed = 0.0137 * k, back = unit_convert(unit_convert(speed, &si, &cells), &cells, &si);
    cr_expect_leq(fabs(back / speed - 1), 1e-14, "%d", k);
  }
}

static const char *const in_si = "units: {dx: 0.1 mm, viscosity: 0.05, density: 1000 kg/m^3}\n"
                                 "domain: {size: [1 cm, 20 mm], top: {type: wall, velocity: [2 mm/s, 0]}}\n"
                                 "fluid: {viscosity: 1e-6 m^2/s}\n"
                                 "particles:\n"
                                 "  density: 1.2 g/cm^3\n"
                                 "  gravity: [0, -0.981 m/s^2]\n"
                                 "  discs:\n"
                                 "    - {radius: 0.5 mm, position: [5.01 mm, 18 mm]}\n"
                                 "    - {radius: 0.5 mm, position: [5 mm, 1.6 cm], spin: 0.2 rad/s}\n"
                                 "contact: {stiffness: 1e5 N/m^3}\n"
                                 "run: {steps: 0.2 s}\n"
                                 "output: {every: 50 ms}\n";

static const char *const in_cells = "domain: {size: [100, 200], top: {type: wall, velocity: [0.01, 0]}}\n"
                                    "fluid: {viscosity: 0.05}\n"
                                    "particles:\n"
                                    "  density: 1.2\n"
                                    "  gravity: [0, -0.0024525]\n"
                                    "  discs:\n"
                                    "    - {radius: 5, position: [50.1, 180]}\n"
                                    "    - {radius: 5, position: [50, 160], spin: 1e-4}\n"
                                    "contact: {stiffness: 0.25}\n"
                                    "run: {steps: 400}\n"
                                    "output: {every: 100}\n";

Test(case_in_si, has_the_bits_of_the_same_case_in_lattice_units)
{
  shell_write("si.yaml", in_si);
  shell_write("cells.yaml", in_cells);
  cr_assert_eq(shell("$DELBM run si.yaml --quiet --out si >log && $DELBM run cells.yaml --quiet --out cells >log"), 0);
  cr_expect_eq(shell("cut -d, -f1-14 si/particles.csv | cmp - cells/particles.csv"), 0);
  cr_expect_eq(shell("sed '/^units:/,/^coupling:/{/^coupling:/!d}' si/case.yaml | cmp - cells/case.yaml"), 0);
}

Test(case_in_si, as_run_repeats_the_run_bit_by_bit)
{
  shell_write("si.yaml", in_si);
  cr_assert_eq(shell("$DELBM run si.yaml --quiet --out a --set 'units.viscosity=0.0531' --set 'run.steps=60' "
                     "--set 'output.every=20' --set 'particles.gravity=[0, -1.1 m/s^2]' >log && "
                     "$DELBM run a/case.yaml --quiet --out b >log"),
               0);
  cr_expect_eq(shell("cmp a/particles.csv b/particles.csv && cmp a/case.yaml b/case.yaml"), 0);
}

Test(case_in_si, leaves_tables_in_both_units_and_says_what_they_are)
{
  shell_write("si.yaml", in_si);
  cr_assert_eq(shell("$DELBM run si.yaml --quiet --out o >log"), 0);
  cr_expect_eq(shell("head -1 o/particles.csv | grep -qF 'contact_torque,t[s],x[m],y[m],vx[m/s],vy[m/s],omega[1/s],"
                     "fx[kg/s^2],'"),
               0);
  cr_expect_eq(shell("awk -F, 'function far(a, b) {return (a - b)^2 > 1e-24 * b * b} NR > 1 && (far($15, $1 * 5e-4) || "
                     "far($16, $3 * 1e-4) || far($19, $6 * 0.2) || far($22, $10 * 1000 * 1e-12 / 25e-8)) {bad = 1} "
                     "END {exit bad || NR != 11}' o/particles.csv"),
               0);
  cr_expect_eq(shell("grep -A3 '\"units\": {' o/run.json | tr -d ' \\n' | "
                     "grep -qF '\"dx_m\":0.0001,\"dt_s\":0.0005'"),
               0);
  cr_expect_eq(shell("$DELBM analyse o >figures && grep -q draft figures"), 0);
}

Test(case_in_si, resumed_ends_with_the_same_table)
{
  shell_write("si.yaml", in_si);
  cr_assert_eq(shell("$DELBM run si.yaml --quiet --out a >log && "
                     "$DELBM run si.yaml --quiet --out b --set run.steps=250 --set output.checkpoint.every=250 >log && "
                     "$DELBM resume b --quiet --steps '0.2 s' >log"),
               0);
  cr_expect_eq(shell("grep -v ^250 b/particles.csv | cmp - a/particles.csv"), 0);
}

/* Cells of 0.15 mm and, by the viscosity, steps of 1.125 ms. */
static const char *const not_whole =
    "units: {dx: 0.15 mm, viscosity: 0.05, density: 1000 kg/m^3}\n"
    "domain: {size: [2 cm, 4 cm]}\n"
    "fluid: {viscosity: 1e-6 m^2/s}\n"
    "particles: {density: 1.05, gravity: [0, -0.981 m/s^2], discs: [{radius: 1 mm, position: [1 cm, 3.5 cm]}]}\n"
    "run: {steps: 0.2 s}\n"
    "output: {every: 10 ms, checkpoint: {every: 0.1 s}, fields: {every: 0, region: [0, 0, 1 cm, 1 cm]}}\n";

Test(case_in_si, of_lengths_and_times_that_are_not_whole_is_rounded_with_a_note_and_written_as_run)
{
  static const char *const lines[] = {
      "si.yaml:2:17: domain.size: 2 cm is 133.333 cells; rounded to 133, which is 1.995 cm",
      "si.yaml:2:23: domain.size: 4 cm is 266.667 cells; rounded to 267, which is 4.005 cm",
      "si.yaml:5:14: run.steps: 0.2 s is 177.778 steps; rounded to 178, which is 0.20025 s",
      "si.yaml:6:17: output.every: 10 ms is 8.88889 steps; rounded to 9, which is 10.125 ms",
      "si.yaml:6:44: output.checkpoint.every: 0.1 s is 88.8889 steps; rounded to 89, which is 0.100125 s",
      "si.yaml:6:86: output.fields.region: 1 cm is 66.6667 cells; rounded to 67, which is 1.005 cm"};
  shell_write("si.yaml", not_whole);
  cr_assert_eq(shell("$DELBM run si.yaml --out o 2>err >out && $DELBM info si.yaml >i"), 0);
  for (size_t k = 0; k < sizeof lines / sizeof lines[0]; k++) {
    cr_expect_eq(shell("grep -qxF 'delbm: note: %s' err", lines[k]), 0, "%s", lines[k]);
    cr_expect_eq(shell("grep -qxF '  note: %s' i", lines[k]), 0, "%s", lines[k]);
  }
  cr_expect_eq(shell("test $(grep -c rounded err) = 7 && test $(grep -c rounded i) = 7"), 0);
  cr_expect_eq(shell("grep -qxF '  size: [133, 267]' o/case.yaml && grep -qxF '  steps: 178' o/case.yaml && "
                     "grep -q 'every: 9$' o/case.yaml && grep -qF 'region: [0, 0, 67, 67]' o/case.yaml"),
               0);
  cr_expect_eq(shell("$DELBM run o/case.yaml --out again 2>err >out && ! grep rounded err && "
                     "cmp o/particles.csv again/particles.csv"),
               0);
  cr_expect_eq(shell("$DELBM run si.yaml --quiet --out o 2>err >out && ! grep rounded err"), 0);
}

Test(case_in_si, is_rounded_by_a_tenth_at_most_and_never_to_zero)
{
  static const struct {
    const char *setting, *words;
  } refused[] = {
      {"run.steps=2.7 ms", "it is 2.4 steps; nearest: 2.25 ms or 3.375 ms"},
      {"run.steps=0.1 ms", "it is 0.08888888889 steps; nearest: 1.125 ms"},
      {"output.every=500 us", "it is 0.4444444444 steps; nearest: 1125 us"},
      {"domain.size=[0.2 mm, 4 cm]", "it is 1.333333333 cells; nearest: 0.15 mm or 0.3 mm"},
      {"run.check=114 ms", "expected a whole number >= 1 and <= 100; it is 101 steps"},
      {"output.fields.stride=0.68 mm", "it is 4.533333333 cells; nearest: 0.6 mm or 0.75 mm"},
      {"run.steps=-2.02 s", "it is -1796 steps"},
      {"run.steps=2.4", "expected a whole number >= 0 and <= 1000000000000"},
  };
  static const char *const taken[] = {"run.steps=12.4 ms", "run.steps=10.1 ms", "domain.size=[1.58 mm, 1.67 mm]",
                                      "run.steps=0 s", "output.every=1.2 ms"};
  shell_write("si.yaml", not_whole);
  for (size_t k = 0; k < sizeof refused / sizeof refused[0]; k++) {
    cr_expect_eq(shell("$DELBM info si.yaml --set particles={} --set output={} --set '%s' >i 2>err; test $? = 3 && "
                       "grep -qF '%s' err",
                       refused[k].setting, refused[k].words),
                 0, "%s", refused[k].setting);
  }
  for (size_t k = 0; k < sizeof taken / sizeof taken[0]; k++)
    cr_expect_eq(shell("$DELBM info si.yaml --set particles={} --set output={} --set '%s' >i", taken[k]), 0, "%s",
                 taken[k]);
}

Test(case_in_si, with_a_region_of_the_whole_box_is_valid_also_where_the_box_is_rounded_down)
{
  shell_write("si.yaml", not_whole);
  const char *const fill = "--set 'particles={density: 2, fill: {radius: 0.5 mm, spacing: 1.5 mm, region: [0, 0, %s, 4 "
                           "cm]}}' --set output={}";
  char command[512];
  snprintf(command, sizeof command, fill, "2 cm");
  cr_expect_eq(shell("$DELBM run si.yaml %s --set run.steps=0 --quiet --out o >out && "
                     "grep -qF 'region: [0, 0, 133, 266.666' o/case.yaml",
                     command),
               0);
  snprintf(command, sizeof command, fill, "2.01 cm");
  cr_expect_eq(shell("$DELBM info si.yaml %s >i 2>err; test $? = 3 && grep -q 'x1 <= 133 ' err", command), 0);
}

Test(case_in_si, info_says_what_a_cell_and_a_step_are_and_what_to_change)
{
  shell_write("si.yaml", in_si);
  cr_expect_eq(shell("$DELBM info si.yaml >i && grep -q 'cell 0.0001 m, step 0.0005 s: 1 cell/step is 0.2 m/s' i && "
                     "grep -q 'box 0.01 m x 0.02 m, viscosity 1e-06 m^2/s' i && ! grep -q note: i"),
               0);
  cr_expect_eq(shell("$DELBM info si.yaml --set 'units={dx: 0.1 mm, dt: 5 us}' --set particles.density=1.2 "
                     "--set contact.stiffness=0.25 --set particles.discs.1.spin=0 --set run.steps=9 "
                     "--set output.every=1 >i && "
                     "grep 'tau below 0.503' i | grep -q 'units.dt >= 1e-05 s (units.viscosity >= 0.001) or units.dx "
                     "<= 7.07e-05 m'"),
               0);
  cr_expect_eq(shell("$DELBM info si.yaml --set 'particles.gravity=[0, -9.81 m/s^2]' --set particles.density=5 >i && "
                     "grep 'Mach above 0.17' i | grep -q 'particles.gravity <= .* m/s^2), or units.dt <= '"),
               0);
  cr_expect_eq(shell("$DELBM info si.yaml --set 'units.viscosity=0.004' --set 'particles.gravity=[0, -0.0024525]' "
                     "--set output.every=1 --set run.steps=9 >i && "
                     "grep 'grid Reynolds number' i | grep -q 'fluid.viscosity >= .*, by units.dx <= '"),
               0);
}

Test(unit, dimensions_differ_where_length_time_or_mass_does)
{
  static const char *const texts[] = {"1", "m", "s", "kg", "kg/m", "kg*s", "m/s", "kg*m/s^2"};
  const struct units none = {0};
  for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++)
    for (size_t k = 0; k < sizeof texts / sizeof texts[0]; k++) {
      struct unit a, b;
      cr_assert(unit_parse(texts[i], &none, &a) && unit_parse(texts[k], &none, &b));
      cr_expect_eq(unit_same_dimension(&a, &b), i == k, "%s and %s", texts[i], texts[k]);
    }
}
