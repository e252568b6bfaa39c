/* The benchmarks from outside: every benchmark of `delbm bench --list`, quick, alone and all together. A benchmark
 * verifies its results and exits with a code other than 0 on failure. */
#include "json.h"
#include "shell.h"

#include <math.h>

TestSuite(bench, .init = shell_enter, .fini = shell_leave, .timeout = 900 * SLOWNESS);

enum { NAMES = 64 };

/* Names of all benchmarks. */
static int list_names(char names[NAMES][32])
{
  char line[256];
  int count = 0;
  cr_assert_eq(shell("$DELBM bench --list | awk '/^benchmarks/ {on = 1; next} /^[^ ]/ {on = 0} on {print $1}' >names"),
               0);
  FILE *file = fopen("names", "r");
  cr_assert(file);
  while (count < NAMES && fgets(line, sizeof line, file)) count += sscanf(line, "%31s", names[count]) == 1;
  fclose(file);
  cr_assert_gt(count, 0, "the list names no benchmark");
  return count;
}

/* Expects JSON with figures of the benchmarks named. */
static void check_report(const char *path, char names[NAMES][32], int count)
{
  char *text = json_read(path);
  cr_assert(text && json_is_valid(text), "%s is not JSON: %.200s", path, text ? text : "");
  for (int k = 0; k < count; k++) {
    const char *figures = json_member(text, names[k]);
    cr_expect(figures && *figures == '{' && json_space(figures + 1)[0] == '"', "%s has no figures of %s", path,
              names[k]);
    cr_expect(!figures || !json_member(figures, "failed"), "%s: %s failed", path, names[k]);
  }
  free(text);
}

Test(bench, every_one_that_the_list_names_runs_quickly_and_verifies_what_it_measures)
{
  char names[NAMES][32];
  const int count = list_names(names);
  for (int k = 0; k < count; k++) {
    cr_expect_eq(shell("$DELBM bench %s --quick --json one.json >out 2>&1 || { cat out >&2; exit 1; }", names[k]), 0,
                 "%s fails", names[k]);
    check_report("one.json", &names[k], 1);
  }
}

Test(bench, all_at_once_leave_one_report_with_the_figures_of_each)
{
  char names[NAMES][32];
  const int count = list_names(names);
  cr_expect_eq(shell("$DELBM bench --quick --json all.json >out 2>&1 || { cat out >&2; exit 1; }"), 0);
  check_report("all.json", names, count);
}

/* A failed allocation ends the first benchmark; within libgomp it would end the program. */
Test(bench, one_that_fails_is_named_in_a_valid_report_and_the_others_still_run)
{
  int failures = 0;
  for (int call = 1; call <= 20; call++) {
    shell("DELBM_FAIL='memory %d' %s bench run overlap --quick --json f.json >out 2>err; echo $? >code", call,
          DELBM_FAULTY);
    if (shell("grep -q '^delbm: ' err && ! grep -q 'cannot write f.json' err") != 0) continue;
    failures++;
    cr_expect_eq(shell("grep -qE '^[14]$' code"), 0, "call %d", call);
    char *text = json_read("f.json");
    cr_assert(text && json_is_valid(text), "call %d: not JSON: %.200s", call, text ? text : "");
    const char *run = json_member(text, "run"), *overlap = json_member(text, "overlap");
    cr_expect(run && json_member(run, "failed"), "call %d", call);
    cr_expect(overlap && json_member(overlap, "ratios") && !json_member(overlap, "failed"), "call %d", call);
    free(text);
  }
  cr_expect_gt(failures, 3, "%d failures", failures);
}

Test(bench, names_that_are_none_run_nothing)
{
  cr_expect_eq(shell("$DELBM bench overlap swep --quick >out 2>err"), 2);
  cr_expect_eq(shell("! test -s out && grep -q \"unknown benchmark 'swep'\" err"), 0);
}

static bool has_python(void)
{
  return shell("python3 -c '' >/dev/null 2>&1") == 0;
}

Test(bench, the_comparison_with_lammps_is_skipped_with_words_where_there_is_none)
{
  if (!has_python()) cr_skip("no python3");
  cr_expect_eq(
      shell("PATH=/none \"$(python3 -c 'import sys; print(sys.executable)')\" %s --program $DELBM >out 2>err", COMPARE),
      77);
  cr_expect_eq(shell("grep -q '^skipped: no lmp and no mpirun' out && ! test -s err"), 0);
}

/* The number that an awk program prints for a file. */
static double number(const char *file, const char *program)
{
  double value = NAN;
  cr_assert_eq(shell("awk -F '[ ,]' '%s' %s >number", program, file), 0);
  FILE *answer = fopen("number", "r");
  cr_assert(answer && fscanf(answer, "%lf", &value) == 1, "%s: %s prints no number", file, program);
  fclose(answer);
  return value;
}

/* Impulse of spring and damper over half a step, with the damper at the mean speed (contact_block.c). */
static double half_step(double spring, double damper, double inverse_mass, double overlap, double speed)
{
  return 0.5 * (spring * overlap + damper * speed) / (1 + 0.25 * damper * inverse_mass);
}

/* Two discs, and a disc and a side, that overlap by 0.1 cells and approach at 0.02 cells a step. The first impulse of a run
 * lasts half a step. */
Test(bench, lammps_gets_every_disc_and_the_spring_and_damper_of_the_law)
{
  if (!has_python()) cr_skip("no python3");
  const double mass = 1.01 * M_PI * 25, overlap = 0.1, speed = 0.02;
  cr_assert_eq(shell("python3 %s --write in --program $DELBM", COMPARE), 0);
  cr_expect_eq(number("in/start.data", "/^Velocities/ {exit} NF == 7 {n++} END {print n}"), 400);
  shell_write("case.yaml", "domain: {size: [100, 100]}\nfluid: none\n"
                           "particles:\n  density: 1.01\n  discs:\n"
                           "    - {radius: 5, position: [40, 50], velocity: [0.02, 0]}\n"
                           "    - {radius: 5, position: [49.9, 50]}\n"
                           "    - {radius: 5, position: [95.1, 20], velocity: [0.02, 0]}\n"
                           "contact: {law: linear, stiffness: 25, alpha: 0.3, damping: 0.34, substeps: 1}\n"
                           "run: {steps: 1}\noutput: {every: 1}\n");
  cr_assert_eq(shell("$DELBM run case.yaml --out out --quiet >log 2>&1"), 0);
  const double pair = number("out/particles.csv", "$1 == 1 && $2 == 1 {print $12}");
  const double side = -number("out/particles.csv", "$1 == 1 && $2 == 2 {print $12}");
  const double pair_law =
      half_step(number("in/in.lammps", "/^pair_style/ {print $3}"),
                number("in/in.lammps", "/^pair_style/ {print $5}") * mass / 2, 2 / mass, overlap, speed);
  const double side_law = half_step(number("in/in.lammps", "/xplane/ {print $6}"),
                                    number("in/in.lammps", "/xplane/ {print $8}") * mass, 1 / mass, overlap, speed);
  cr_expect_lt(fabs(pair / pair_law - 1), 1e-6, "pair: %.9g, for LAMMPS %.9g", pair, pair_law);
  cr_expect_lt(fabs(side / side_law - 1), 1e-6, "side: %.9g, for LAMMPS %.9g", side, side_law);
}
