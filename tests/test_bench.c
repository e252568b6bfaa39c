/* The benchmarks from outside: every benchmark of `delbm bench --list`, quick, alone and all together. A benchmark
 * verifies its results and exits with a code other than 0 on failure. */
#include "json.h"
#include "shell.h"

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
