/* The cases from outside: every case of cases/, its `runs`, the figures, and the case and benchmarks in README.md. */
#include "shell.h"

static void enter(void)
{
  shell_enter();
  setenv("SOURCE", TEST_DIR "/..", 1);
}

TestSuite(cases, .init = enter, .fini = shell_leave, .timeout = 300 * SLOWNESS);
TestSuite(readme, .init = enter, .fini = shell_leave, .timeout = 300 * SLOWNESS);

static bool has(const char *program)
{
  return shell("command -v %s >/dev/null", program) == 0;
}

/* Each case takes a few steps, so that there are rows to analyse and to plot. */
Test(cases, each_is_described_run_analysed_and_plotted)
{
  const bool plots = has("gnuplot");
  cr_expect_eq(
      shell("for c in $SOURCE/cases/*/*.yaml; do\n"
            "  n=$(echo \"${c#$SOURCE/cases/}\" | tr / -)\n"
            "  $DELBM info \"$c\" >info || { echo \"info $n\"; exit 1; }\n"
            "  $DELBM run \"$c\" --quiet --out out/$n --set run.steps=20 --set output.every=2 "
            "--set output.frames.every=0 >line || { echo \"run $n\"; exit 1; }\n"
            "  $DELBM analyse out/$n --tables --json out/$n/a.json >figures || { echo \"analyse $n\"; exit 1; }\n"
            "  %s $DELBM plot out/$n >pictures || { echo \"plot $n\"; exit 1; }\n"
            "done >log 2>&1; s=$?; test $s = 0 || cat log >&2; ls out/dkt-case.yaml >/dev/null && exit $s",
            plots ? "" : "true"),
      0);
}

Test(cases, every_line_of_their_runs_is_a_valid_case)
{
  cr_expect_eq(shell("for r in $SOURCE/cases/*/runs; do\n"
                     "  grep -v '^#' \"$r\" | grep . | while read -r label file settings; do\n"
                     "    set --; for s in $settings; do set -- \"$@\" --set \"$s\"; done\n"
                     "    echo \"$r $label\" >>lines\n"
                     "    $DELBM info \"${r%%runs}$file\" \"$@\" >info || { echo \"$r: $label\"; exit 1; }\n"
                     "  done || exit 1\n"
                     "done >log 2>&1 || { cat log >&2; exit 1; }; test $(wc -l <lines) -gt 20"),
               0);
}

/* On a copy of cases/, since the figures are written beside it. */
Test(cases, figures_of_the_paper_are_reproduced_where_a_benchmark_has_them)
{
  if (!has("gnuplot")) cr_skip_test("gnuplot is not installed");
  cr_expect_eq(shell("cp -r $SOURCE/cases . && cases/reproduce overlap >log 2>&1 || { cat log >&2; exit 1; }"), 0);
  cr_expect_eq(
      shell("ls reproduce/overlap/*.png >/dev/null && grep -q within reproduce/overlap/checks.tsv && "
            "! grep -qE 'BEYOND|missing' reproduce/overlap/checks.tsv && grep -q '</html>' reproduce/index.html"),
      0);
}

/* Short runs, whose numbers differ from the paper's: tests only that tables, pictures and the page are written. */
Test(cases, figures_of_the_paper_are_drawn_from_short_runs_and_a_quick_benchmark)
{
  if (!has("gnuplot")) cr_skip_test("gnuplot is not installed");
  cr_assert_eq(shell("cp -r $SOURCE/cases . && grep -v '^#' cases/spin/runs | sed 's/$/ run.steps=100 output.every=10 "
                     "output.frames.every=0/' >r && mv r cases/spin/runs"),
               0);
  shell_write("quick", "#!/bin/sh\n[ \"$1\" = bench ] && set -- \"$@\" --quick\nexec \"$PROGRAM\" \"$@\"\n");
  cr_expect_eq(
      shell("chmod +x quick; PROGRAM=$DELBM DELBM=$PWD/quick cases/reproduce spin contact >log 2>&1\n"
            "for c in spin contact; do\n"
            "  ls reproduce/$c/*.png >/dev/null && test -s reproduce/$c/checks.tsv || { cat log >&2; exit 1; }\n"
            "done; ! grep -q missing reproduce/*/checks.tsv && grep -q '</html>' reproduce/index.html"),
      0);
}

Test(cases, reports_of_benchmarks_are_plotted_by_their_scripts)
{
  if (!has("gnuplot")) cr_skip_test("gnuplot is not installed");
  cr_expect_eq(
      shell("for n in accuracy stability; do\n"
            "  for r in $SOURCE/bench/results/*-$n.json; do\n"
            "    gnuplot -c $SOURCE/bench/$n.gp \"$r\" $n.png >log 2>&1 && ! test -s log || { cat log >&2; exit 1; }\n"
            "    test \"$(head -c 4 $n.png | tail -c 3)\" = PNG || exit 1\n"
            "  done\n"
            "done"),
      0);
}

/* Writes the block of README.md after the line with this text, without its fences. */
static int readme_block(const char *after, const char *path)
{
  return shell("awk -v after='%s' 'index($0, after) {on = 1} /^```/ {if (inside) exit; inside = on; next} inside' "
               "$SOURCE/README.md >%s; test -s %s",
               after, path, path);
}

Test(readme, its_case_runs_with_the_settings_that_it_shows)
{
  cr_assert_eq(readme_block("`mycase.yaml`:", "mycase.yaml"), 0);
  cr_expect_eq(shell("grep -q '^title:' mycase.yaml && $DELBM info mycase.yaml >/dev/null"), 0);
  cr_expect_eq(shell("grep -E '^delbm run mycase.yaml --out' $SOURCE/README.md | sed 's/^delbm run/$DELBM run --quiet "
                     "--set run.steps=10/' >lines; test -s lines && sh -e lines >log 2>&1"),
               0);
}

Test(readme, its_block_of_units_is_a_case)
{
  cr_assert_eq(readme_block("too long or the cells too coarse", "units.yaml"), 0);
  cr_expect_eq(shell("grep -q '^units:' units.yaml && $DELBM info units.yaml >/dev/null"), 0);
}

Test(readme, benchmarks_that_it_names_are_in_the_list)
{
  cr_expect_eq(shell("$DELBM bench --list | awk '/^benchmarks/ {on = 1; next} /^[^ ]/ {on = 0} on {print $1}' >names; "
                     "cat $SOURCE/README.md $SOURCE/bench/*.md $SOURCE/cases/*/README.md | grep -oE 'delbm bench "
                     "[a-z]+' | awk '{print $3}' | sort -u >named; test $(wc -l <named) -gt 3 && "
                     "while read n; do grep -qx $n names || { echo $n >&2; exit 1; }; done <named"),
               0);
}
