/* The program from outside: command line, exit codes and files. DELBM is the path of the program. */
#include "maps.h"
#include "shell.h"

#include <math.h>

TestSuite(program, .init = shell_enter, .fini = shell_leave, .timeout = 60 * SLOWNESS);

static char *read_file(const char *path)
{
  FILE *file = fopen(path, "r");
  cr_assert(file, "%s exists", path);
  char *text = calloc(1, 1 << 22);
  const size_t size = fread(text, 1, (1 << 22) - 1, file);
  cr_assert(size < (1 << 22) - 1 && !ferror(file));
  fclose(file);
  return text;
}

static bool contains(const char *path, const char *text)
{
  char *all = read_file(path);
  const bool found = strstr(all, text) != NULL;
  free(all);
  return found;
}

/* Discs that fall and collide with each other and the walls, within a second. */
static const char *const crowd = "title: crowd\n"
                                 "domain: {size: [200, 180]}\n"
                                 "fluid: {viscosity: 0.03}\n"
                                 "particles:\n"
                                 "  density: 1.3\n"
                                 "  gravity: [1e-5, -4e-4]\n"
                                 "  fill: {pattern: jittered-grid, spacing: 20, radius: 9.2, jitter: 1, seed: 5}\n"
                                 "run: {steps: 300}\n"
                                 "output: {every: 50}\n";

Test(program, has_its_stages_as_functions_that_a_profiler_names)
{
  static const char *const stages[] = {"occupation", "contact", "exchange", "motion", "sweep", "sweep_blocked"};
  if (shell("command -v nm >/dev/null") != 0) cr_skip_test("nm is not installed");
  for (size_t k = 0; k < sizeof stages / sizeof stages[0]; k++)
    cr_expect_eq(shell("nm $DELBM | grep -qi ' t stage_%s$'", stages[k]), 0, "%s", stages[k]);
}

Test(program, says_how_threads_are_bound)
{
  shell_write("box.yaml", "domain: {size: [80, 80]}\nfluid: {viscosity: 0.05}\nrun: {steps: 4}\n");
  cr_expect_eq(
      shell("OMP_NUM_THREADS=1 OMP_PLACES=cores OMP_PROC_BIND=close %s run box.yaml --out b 2>err >/dev/null", DELBM),
      0);
  cr_expect(contains("b/run.json", "\"binding\": \"close over "));
  cr_expect(contains("err", "1 threads, close over "));
  cr_expect_eq(shell("OMP_PROC_BIND=false %s info box.yaml >info.txt", DELBM), 0);
  cr_expect(contains("info.txt", "(unbound)"));
}

Test(program, particles_csv_has_the_same_bits_for_any_number_of_threads)
{
  static const int threads[] = {1, 2, 3, 4, 7};
  shell_write("crowd.yaml", crowd);
  for (size_t k = 0; k < sizeof threads / sizeof threads[0]; k++)
    cr_assert_eq(
        shell("OMP_NUM_THREADS=%d %s run crowd.yaml --quiet --out t%d >/dev/null", threads[k], DELBM, threads[k]), 0);
  for (size_t k = 1; k < sizeof threads / sizeof threads[0]; k++)
    cr_expect_eq(shell("cmp t1/particles.csv t%d/particles.csv", threads[k]), 0, "%d threads", threads[k]);
  cr_expect(contains("t7/run.json", "\"threads\": 7"), "seven threads really ran");
  cr_expect_eq(shell("awk -F, '$12 != 0 {met = 1} END {exit !met}' t1/particles.csv"), 0, "discs touch");
}

Test(program, a_run_leaves_the_files_that_scripts_rely_on)
{
#ifdef DELBM_PNG
  const char *frames = "--set output.frames.every=20";
#else
  const char *frames = "";
#endif
  shell_write("crowd.yaml", crowd);
  cr_assert_eq(shell("%s run crowd.yaml --set run.steps=40 %s --out o >out 2>err", DELBM, frames), 0);
  cr_expect(contains("o/particles.csv",
                     "step,id,x,y,vx,vy,omega,angle,fx,fy,torque,contact_fx,contact_fy,contact_torque\n0,0,"));
#ifdef DELBM_PNG
  cr_expect_eq(shell("test -s o/frames/00000000.png -a -s o/frames/00000020.png -a -s o/frames/00000040.png"), 0);
#endif
  static const char *const keys[] = {"status", "steps",      "seconds",        "mlups",    "threads",      "kernel",
                                     "stages", "mass_drift", "momentum_drift", "max_mach", "peak_rss_mib", "precision"};
  for (size_t k = 0; k < sizeof keys / sizeof keys[0]; k++) {
    char quoted[40];
    snprintf(quoted, sizeof quoted, "\"%s\":", keys[k]);
    cr_expect(contains("o/run.json", quoted), "%s", keys[k]);
  }
  cr_expect_eq(shell("test $(wc -l <out) = 1 && grep -q '^delbm: status=done steps=40 ' out"), 0);
  /* the written case is valid and equal to the case */
  cr_assert_eq(shell("%s run o/case.yaml --quiet --out again >/dev/null", DELBM), 0);
  cr_expect_eq(shell("cmp o/particles.csv again/particles.csv && cmp o/case.yaml again/case.yaml"), 0);
#ifdef DELBM_PNG
  cr_expect_eq(shell("cmp o/frames/00000040.png again/frames/00000040.png"), 0);
#endif
}

Test(program, a_diverging_run_stops_says_so_and_keeps_what_it_wrote)
{
  shell_write("light.yaml", "domain: {size: [64, 64]}\n"
                            "fluid: {viscosity: 0.05}\n"
                            "coupling: {solve: explicit-averaged}\n"
                            "particles: {density: 0.3, gravity: [0, -1e-3], discs: [{radius: 8, position: [32, 32]}]}\n"
                            "run: {steps: 5000}\n"
                            "output: {every: 1, series: {every: 1}}\n");
  cr_assert_eq(shell("%s run light.yaml --out o >out 2>err", DELBM), 1);
  cr_expect(contains("out", "status=diverged"));
  cr_expect(contains("err", "diverged at step"));
  cr_expect(contains("o/run.json", "\"status\": \"diverged\""));
  cr_expect_eq(shell("grep -q '\"reason\": \"diverged at step .* disc 0 ' o/run.json"), 0);
  cr_expect_eq(shell("test $(wc -l <o/particles.csv) -gt 3 && test $(wc -l <o/series.csv) -gt 3 && "
                     "! grep -qiE 'nan|inf' o/particles.csv o/series.csv o/run.json"),
               0);
}

Test(program, a_run_whose_discs_overlap_by_more_than_a_tenth_of_their_radius_ends_with_a_warning)
{
  shell_write("soft.yaml", "domain: {size: [40, 40]}\nfluid: {viscosity: 0.1}\n"
                           "particles: {density: 3, gravity: [0, -0.002], discs: [{radius: 8, position: [20, 8]}]}\n"
                           "run: {steps: 1500}\n");
  cr_expect_eq(
      shell("$DELBM run soft.yaml --quiet --out o >out 2>err && ! grep warning err && ! grep warning o/run.json"), 0);
  cr_expect_eq(
      shell(
          "$DELBM run soft.yaml --quiet --out o --set contact.stiffness=0.25 >out 2>err && "
          "grep -q '^delbm: warning: discs overlapped by up to [1-9][0-9] %% of the smaller radius, more than 10 %%' "
          "err && "
          "grep -q '\"warning\": \"discs overlapped by up to' o/run.json && "
          "$DELBM info soft.yaml --set contact.stiffness=0.25 | grep -q 'note: at rest discs and the side .*or auto'"),
      0);
  cr_expect_eq(shell("$DELBM run soft.yaml --quiet --out o --set contact.stiffness=0 --set run.steps=100 >out 2>err && "
                     "! grep warning err"),
               0, "without contacts");
}

Test(program, a_run_faster_than_advised_ends_with_a_warning_that_run_json_has_too)
{
  shell_write("lid.yaml", "domain: {size: [32, 32], top: {type: wall, velocity: [0.09, 0]}}\nfluid: {viscosity: 0.1}\n"
                          "run: {steps: 400}\n");
  cr_expect_eq(
      shell("$DELBM run lid.yaml --quiet --out o >out 2>err && ! grep warning err && ! grep warning o/run.json && "
            "grep -q '\"reason\": \"all of run.steps are done\"' o/run.json && "
            "! $DELBM info lid.yaml | grep Mach.above"),
      0);
  cr_expect_eq(
      shell("$DELBM run lid.yaml --quiet --out o --set domain.top.velocity=[0.13,0] >out 2>err && "
            "grep -q '^delbm: warning: fluid moved at up to Mach 0.2[0-2], above 0.17 (0.1 cells/step)' err && "
            "grep -q '\"warning\": \"fluid moved at up to Mach 0.2' o/run.json && "
            "$DELBM info lid.yaml --set domain.top.velocity=[0.13,0] | "
            "grep -q 'Mach above 0.17 .*better: domain.top.velocity <= 0.1 cells/step'"),
      0);
}

Test(program, info_foresees_the_speed_that_a_force_drives_fluid_to)
{
  shell_write("channel.yaml", "units: {dx: 0.1 mm, viscosity: 0.1, density: 1000 kg/m^3}\n"
                              "domain: {size: [40 mm, 12 mm], left: periodic, right: periodic}\n"
                              "fluid: {viscosity: 1e-6 m^2/s, force: [0.5 m/s^2, 0]}\n"
                              "run: {steps: 5 s}\n");
  cr_expect_eq(shell("$DELBM info channel.yaml >i && grep -q '^force .*drives the fluid to about 25 cells a step' i && "
                     "grep -qF 'better: fluid.force <= 2e-05 cells/step^2 (0.002 m/s^2), or units.dt <= 4e-06 s' i"),
               0);
  cr_expect_eq(shell("$DELBM info channel.yaml --set 'fluid.force=[0.00199 m/s^2, 0]' >i && ! grep 'Mach above' i"), 0);
  cr_expect_eq(shell("$DELBM run channel.yaml --quiet --out o 2>err >out; test $? = 1 && "
                     "grep -q 'fluid.force leads to speeds of about 25 cells/step (Mach 43); better: fluid.force <= "
                     "2e-05 cells/step^2' err && grep -q '\"max_mach\": 0.8' o/run.json"),
               0);
}

/* The cases in README.md must not cause warnings. */
Test(program, the_cases_of_the_readme_get_no_note_and_stay_below_the_advised_speed)
{
  cr_assert_eq(shell("awk '/^```yaml/ {n++; on = 1; next} /^```/ {on = 0} on {print > (\"readme\" n \".yaml\")}' "
                     "%s/../README.md && test -s readme1.yaml -a -s readme2.yaml",
                     TEST_DIR),
               0);
  for (int k = 1; k <= 2; k++)
    cr_expect_eq(shell("$DELBM info readme%d.yaml >i && ! grep note: i >&2", k), 0, "case %d", k);
  cr_expect_eq(shell("$DELBM run readme2.yaml --quiet --out o --set output={} --set run.steps=1500 >out 2>err && "
                     "! grep . err >&2 && awk '/max_mach/ {exit !($2 + 0 > 0.08)}' o/run.json"),
               0);
}

Test(program, exit_codes_tell_what_went_wrong)
{
  shell_write("good.yaml", "domain: {size: [32, 32]}\nfluid: {viscosity: 0.1}\nrun: {steps: 3}\n");
  shell_write("bad.yaml", "domain: {size: [32, 32]}\nfluid: {viscosty: 0.1}\nrun: {steps: 3}\n");
  cr_expect_eq(shell("%s run good.yaml --quiet >/dev/null", DELBM), 0);
  cr_expect_eq(shell("test -f out/good/run.json"), 0, "the default folder is out/NAME");
  cr_expect_eq(shell("%s run 2>err", DELBM), 2);
  cr_expect_eq(shell("%s rum good.yaml 2>err", DELBM), 2);
  cr_expect_eq(shell("%s run good.yaml --quite 2>err", DELBM), 2);
  cr_expect_eq(shell("%s run good.yaml bad.yaml 2>err", DELBM), 2);
  cr_expect_eq(shell("%s --version good.yaml 2>err", DELBM), 2);
  cr_expect_eq(shell("%s run bad.yaml 2>err", DELBM), 3);
  cr_expect(contains("err", "bad.yaml:2:9: unknown key fluid.viscosty; did you mean fluid.viscosity?"));
  cr_expect_eq(shell("%s info bad.yaml >/dev/null 2>&1", DELBM), 3);
  cr_expect_eq(shell("%s run absent.yaml 2>err", DELBM), 4);
  cr_expect_eq(shell("%s run good.yaml --quiet --out good.yaml/x 2>err >/dev/null", DELBM), 4);
  cr_expect_eq(shell("%s info good.yaml >/dev/full 2>err", DELBM), 4);
  cr_expect_eq(shell("%s bench nosuch 2>err", DELBM), 2);
  cr_expect_eq(shell("mkdir own && cp good.yaml own/case.yaml && %s run own --out own 2>err", DELBM), 2);
  cr_expect(contains("err", "would overwrite its own case"));
}

Test(program, suggests_near_spellings_and_nothing_far)
{
  static const struct {
    const char *line, *near;
  } cases[] = {
      {"rnu x", "run"},         {"resum x", "resume"},   {"analyze x", "analyse"}, {"run --quite x", "--quiet"},
      {"bench swepe", "sweep"}, {"bench dragg", "drag"}, {"make x", NULL},         {"rm x", NULL},
      {"start x", NULL},        {"--where", NULL},       {"run --force x", NULL},  {"bench everything", NULL},
      {"simulate case", NULL}};
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
    cr_expect_eq(shell("%s %s 2>err >out", DELBM, cases[k].line), 2, "%s", cases[k].line);
    char suggestion[64];
    snprintf(suggestion, sizeof suggestion, "did you mean '%s'?", cases[k].near ? cases[k].near : "");
    cr_expect_eq(contains("err", cases[k].near ? suggestion : "did you mean"), cases[k].near != NULL, "%s",
                 cases[k].line);
  }
}

Test(program, help_and_version_are_everywhere)
{
  cr_expect_eq(shell("%s --version | grep -q '^delbm [0-9]'", DELBM), 0);
  static const char *const commands[] = {"", "run", "info", "analyse", "bench"};
  for (size_t k = 0; k < 5; k++)
    cr_expect_eq(shell("%s %s --help | grep -q '^usage: delbm'", DELBM, commands[k]), 0, "%s", commands[k]);
  cr_expect_eq(shell("%s bench --list | grep -q baseline-double", DELBM), 0);
  cr_expect_eq(shell("%s run --help-keys | grep -q fluid.viscosity", DELBM), 0);
}

Test(program, info_names_the_stages_that_run_and_the_stages_left_out)
{
  shell_write("crowd.yaml", crowd);
  shell_write("empty.yaml",
              "domain: {size: [64, 64], left: periodic, right: periodic}\nfluid: {viscosity: 0.1}\nrun: {steps: 3}\n");
  cr_assert_eq(shell("%s info crowd.yaml >crowd.txt && %s info empty.yaml >empty.txt", DELBM, DELBM), 0);
  cr_expect_eq(shell("grep -q 'occupation every step' crowd.txt && grep -q 'pairs and sides' crowd.txt"), 0);
  cr_expect_eq(shell("grep -q 'occupation left out' empty.txt && grep -q 'exchange   left out' empty.txt"), 0);
  cr_expect_eq(shell("grep -q 'Reynolds' crowd.txt && grep -q 'Mach' crowd.txt && grep -q 'MiB' crowd.txt"), 0);
}

Test(program, analyse_reports_a_run_and_refuses_what_is_none)
{
  shell_write("crowd.yaml", crowd);
  cr_assert_eq(shell("%s run crowd.yaml --set particles.gravity=[0,-4e-4] --quiet --out o >/dev/null", DELBM), 0);
  cr_assert_eq(shell("%s analyse o --json o/analysis.json --tables >out 2>err", DELBM), 0);
  cr_expect(contains("out", "settling.interface_speed") && !contains("out", "body.") && !contains("out", "pair."));
  cr_expect(contains("o/analysis.json", "\"interface_speed\": ") && contains("o/analysis.json", "\"mixing\": ["));
  cr_expect_eq(shell("test $(wc -l <o/settling.csv) = 8 && grep -q '^step,height,concentration,lambda$' o/profile.csv"),
               0);
  cr_expect_eq(shell("%s analyse absent 2>err", DELBM), 4);
  cr_expect_eq(shell("%s analyse 2>err", DELBM), 2);
  cr_expect_eq(shell("echo nonsense >o/particles.csv; %s analyse o 2>err", DELBM), 3);
  cr_expect(contains("err", "o/particles.csv:1: not a table of discs"));
}

/* Fluid that a force drives through a square array of solid fraction 0.2: K = F/(rho nu U) is 51.53 (Sangani & Acrivos
 * 1982), U being the mean velocity over all of the cell. */
Test(program, analyse_finds_the_drag_of_an_array_from_force_and_mean_velocity)
{
  shell_write("array.yaml",
              "domain: {size: [20, 20], left: periodic, right: periodic, bottom: periodic, top: periodic}\n"
              "fluid: {viscosity: 0.1667, force: [0, -1e-6]}\n"
              "particles: {discs: [{radius: 5.0463, position: [10, 10], fixed: true}]}\n"
              "run: {steps: 6000}\n");
  cr_assert_eq(shell("%s run array.yaml --quiet --out o >/dev/null && %s analyse o >out", DELBM, DELBM), 0);
  cr_expect_eq(
      shell("awk '$1 == \"body.resistance\" { k = $2 } END { exit !(k > 0.98 * 51.53 && k < 1.02 * 51.53) }' out"), 0);
  cr_expect(contains("out", "relative to the mean velocity of the fluid") && !contains("out", "not steady"));
  /* a short run notes that it is not steady, an unfinished run that U is unknown */
  cr_assert_eq(shell("%s run array.yaml --set run.steps=200 --set output.every=10 --quiet --out o >/dev/null && "
                     "%s analyse o >out && rm o/run.json && %s analyse o >out2",
                     DELBM, DELBM, DELBM),
               0);
  cr_expect(contains("out", "not steady"));
  cr_expect(contains("out2", "the mean velocity of the fluid is unknown") && !contains("out2", "body.drag"));
}

Test(program, an_interrupted_run_ends_in_order)
{
  shell_write("crowd.yaml", crowd);
  /* after the first rows, when the handler is installed */
  cr_assert_eq(shell("%s run crowd.yaml --set run.steps=100000000 --quiet --out o >out 2>err & p=$!; "
                     "while kill -0 $p && test $(cat o/particles.csv 2>/dev/null | wc -l) -le 1; do sleep 0.05; done; "
                     "kill -INT $p; wait $p; test $? = 130 && grep -q status=interrupted out",
                     DELBM),
               0);
  cr_expect(contains("o/run.json", "\"status\": \"interrupted\""));
  cr_expect(contains("o/run.json", "\"reason\": \"interrupted by SIGINT\""));
}

Test(program, shows_a_title_without_its_control_characters)
{
  shell_write("loud.yaml", "title: \"\\e[31mred\\nsecond line\"\ndomain: {size: [8, 8]}\nfluid: {viscosity: 0.1}\n"
                           "run: {steps: 1}\n");
  cr_expect_eq(shell("$DELBM info loud.yaml >out && grep -q '^case         loud:  \\[31mred second line$' out && "
                     "! grep -q \"$(printf '\\033')\" out"),
               0);
}

Test(program, many_more_threads_than_cores_change_nothing)
{
  shell_write("crowd.yaml", crowd);
  cr_expect_eq(shell("for n in 1 64; do OMP_NUM_THREADS=$n $DELBM run crowd.yaml --quiet --set run.steps=20 --set "
                     "domain.size=[512,512] --out out$n >/dev/null || exit 1; done; cmp out1/particles.csv "
                     "out64/particles.csv && grep -q '\"threads\": 64' out64/run.json"),
               0);
}

/* The benchmark itself fails on a NaN in a file. */
Test(program, no_case_of_the_quick_stability_maps_leaves_nan_in_a_file)
{
  cr_expect_eq(shell("%s bench stability --quick --json maps.json >out", DELBM), 0);
  cr_expect_eq(shell("grep -q 'no file holds what is not a number' out && ! grep -qi nan maps.json"), 0);
}

Test(program, a_damped_contact_gains_no_energy_and_keeps_momentum_at_any_stiffness_of_the_quick_map)
{
  cr_expect_eq(shell("%s bench stability --quick >out", DELBM), 0);
  cr_expect_eq(shell("awk '/^# /{on = /^# impact( by cells)?, damping 0.34, (restitution|momentum)/} on && $2 ~ /[!x]/ "
                     "&& !/^#/' out | grep -v sub-steps | grep . ; test $? -eq 1"),
               0);
}

Test(program, a_disc_too_heavy_for_its_contacts_ends_the_run_when_it_leaves_the_box)
{
  shell_write("c.yaml", "domain: {size: [60, 100]}\nfluid: {viscosity: 0.05}\ncontact: {stiffness: 0}\n"
                        "particles:\n  discs:\n"
                        "    - {radius: 3, density: 1000, position: [30, 8], velocity: [0, -0.1]}\n"
                        "run: {steps: 200}\n");
  cr_expect_eq(shell("%s run c.yaml --quiet --out o 2>err >line", DELBM), 1);
  cr_expect_eq(shell("grep -q 'was pushed out of the box' err"), 0);
}

/* Expects bash's completion of the last word of a line. */
static int completes(const char *line, const char *expected)
{
  return shell("cat >line.bash <<'end'\n"
               "eval \"$($DELBM completion bash)\"\n"
               "complete -p delbm >/dev/null || exit 9\n"
               "COMP_WORDS=(%s)\n"
               "COMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n"
               "_delbm 2>/dev/null\n"
               "echo \"${COMPREPLY[*]}\" >got\n"
               "end\n"
               "bash line.bash && echo '%s' | cmp -s - got || { cat got; exit 1; }",
               line, expected);
}

Test(program, bash_completes_commands_options_and_keys)
{
  if (shell("command -v bash >/dev/null") != 0) cr_skip_test("no bash");
  cr_expect_eq(completes("delbm ru", "run"), 0);
  cr_expect_eq(completes("delbm re", "resume"), 0);
  cr_expect_eq(completes("delbm --v", "--version"), 0);
  cr_expect_eq(completes("delbm run --pl", "--plan"), 0);
  cr_expect_eq(completes("delbm resume out --", "--steps --quiet --help"), 0);
  cr_expect_eq(completes("delbm run case.yaml --set fluid.vi", "fluid.viscosity="), 0);
  cr_expect_eq(completes("delbm run --set particles.discs.0.ra", "particles.discs.0.radius="), 0);
  cr_expect_eq(completes("delbm completion z", "zsh"), 0);
  cr_expect_eq(completes("delbm run case", ""), 0, "files are the shell's to complete");
  cr_expect_eq(shell("$DELBM completion fish 2>err; test $? = 2 && grep -q \"no completion for 'fish'\" err"), 0);
}

Test(program, completion_loads_in_zsh)
{
  if (shell("command -v zsh >/dev/null") != 0) cr_skip_test("no zsh");
  cr_expect_eq(shell("ZDOTDIR=$PWD zsh -fc 'eval \"$($DELBM completion zsh)\" && [[ ${_comps[delbm]} = *_delbm* ]]'"),
               0);
}

Test(program, the_manual_page_has_every_command)
{
  if (access(BUILD_DIR "/src/cli/delbm.1", R_OK) != 0) cr_skip_test("built without scdoc");
  cr_expect_eq(shell("$DELBM --help | awk '/^commands/ {on = 1; next} /^$/ {on = 0} on {print $1}' >names && "
                     "test $(wc -l <names) -gt 5 && "
                     "while read name; do grep -qi \"^\\.SH $name\" %s || exit 1; done <names",
                     BUILD_DIR "/src/cli/delbm.1"),
               0);
}

/* Options in the lines of a command's help and, of all commands, in completion and in the manual page. */
Test(program, each_option_is_accepted_and_stands_in_help_completion_and_manual_page)
{
  cr_assert_eq(shell("$DELBM --help | awk '/^commands/ {on = 1; next} /^$/ {on = 0} on {print $1}' >names && "
                     "for name in $(cat names); do $DELBM $name --help | sed -n 's/^  \\(--[a-z-]*\\).*/\\1/p' | sort "
                     ">help.$name && grep -qx -- --help help.$name || exit 1; done"),
               0);
  cr_expect_eq(
      shell("test $(cat help.* | wc -l) -ge 20 && $DELBM completion bash >script && for name in $(cat names); do "
            "sed -n \"s/^ *$name) options='\\(.*\\)' ;;/\\1/p\" script | tr ' ' '\\n' | sort | cmp - help.$name || "
            "exit 1; done"),
      0);
  cr_expect_eq(shell("for name in $(cat names); do for option in $(cat help.$name); do "
                     "$DELBM $name $option x --help 2>err >out </dev/null; ! grep unknown err || exit 1; done; done"),
               0);
  const char *const page = BUILD_DIR "/src/cli/delbm.1";
  if (access(page, R_OK) != 0) cr_skip_test("built without scdoc");
  cr_expect_eq(
      shell("for name in $(cat names); do awk -v name=$name '/^\\.SH/ {on = tolower($2) == name} on' %s | "
            "tr -d '\\\\' >section && for option in $(cat help.$name); do grep -q -- \"^  *$option\" section || "
            "exit 1; done || exit 1; done",
            page),
      0);
}

/* The case `dkt`, shortened, and the program in the path, for the lines in README.md. */
static void prepare_sweep(void)
{
#ifndef DELBM_PNG
  cr_skip_test("the case of the sweep has frames");
#endif
  cr_assert_eq(shell("mkdir -p cases/dkt bin && ln -s $DELBM bin/delbm && "
                     "sed 's/steps: .*/steps: 2/' %s/../cases/dkt/case.yaml >cases/dkt/case.yaml",
                     TEST_DIR),
               0);
}

Test(program, a_sweep_under_gnu_parallel_runs_as_the_readme_says)
{
  if (shell("parallel --version 2>/dev/null | grep -q GNU") != 0) cr_skip_test("no GNU parallel");
  prepare_sweep();
  cr_assert_eq(shell("grep '^parallel -q delbm' %s/../README.md >sweep && PATH=$PWD/bin:$PATH OMP_NUM_THREADS=1 "
                     "HOME=$PWD bash sweep >log 2>&1",
                     TEST_DIR),
               0);
  cr_expect_eq(
      shell("test $(ls -d out/dkt-* | wc -l) = 6 && test $(grep -l '\"status\": \"done\"' out/*/run.json | wc -l) = 6"),
      0);
  cr_expect_eq(shell("grep -q 'form: unified' out/dkt-unified-101.0/case.yaml && "
                     "grep -qF 'position: [101, 720]' out/dkt-unified-101.0/case.yaml"),
               0);
}

Test(program, a_sweep_as_a_slurm_array_runs_as_the_readme_says)
{
  if (shell("command -v bash >/dev/null") != 0) cr_skip_test("no bash");
  prepare_sweep();
  cr_assert_eq(shell("awk '/^#!\\/bin\\/bash/ {on = 1} /^```/ {on = 0} on' %s/../README.md >job && grep -q SBATCH job",
                     TEST_DIR),
               0);
  cr_assert_eq(shell("for task in 0 1 2; do PATH=$PWD/bin:$PATH SLURM_ARRAY_TASK_ID=$task SLURM_CPUS_PER_TASK=1 "
                     "bash job >log || exit 1; done"),
               0);
  cr_expect_eq(shell("test $(grep -l '\"threads\": 1,' out/dkt-100.1/run.json out/dkt-100.5/run.json "
                     "out/dkt-101.0/run.json | wc -l) = 3"),
               0);
}

/* Warnings from the maps of `delbm bench stability`, and none for a sound case. */
Test(program, info_warns_of_what_the_maps_found_to_fail)
{
  static const struct {
    const char *settings, *note;
  } cases[] = {
      {"--set fluid.collision=mrt --set fluid.viscosity=0.002 --set fluid.magic=0.1875",
       "diverges first of all choices"},
      {"--set coupling.solve=explicit-averaged --set particles.density=0.4", "explicit-averaged diverges"},
      {"--set 'particles={density: 0.9, discs: [{radius: 1.2, position: [90, 90]}]}'", "so small and light"},
      {"--set coupling.form=owen --set 'particles={discs: [{radius: 9, position: [90, 90], fixed: true, spin: "
       "0.004}]}'",
       "is made to spin"},
      {"--set coupling.form=owen --set run.steps=50000", "shake each other"},
      {"--set coupling.form=unified --set fluid.viscosity=0.05", "too little drag"},
      {"--set contact.substeps=1 --set contact.stiffness=1000", "1 sub-steps are fewer than"},
      {"--set contact.area=cells --set contact.stiffness=1000", "areas by cells are known once a step"},
      {"--set 'particles.gravity=[0, -0.002]'", "of the fluid's pressure"},
      {"--set domain.left=periodic --set domain.right=periodic --set domain.bottom=periodic --set domain.top=periodic "
       "--set run.steps=3000",
       "no force balances the weight"},
  };
  shell_write("crowd.yaml", crowd);
  cr_expect_eq(shell("$DELBM info crowd.yaml >out && ! grep -E 'bench/(README|STABILITY)' out >&2"), 0);
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++)
    cr_expect_eq(shell("$DELBM info crowd.yaml %s >out 2>&1 && grep -q \"%s\" out || { cat out >&2; exit 1; }",
                       cases[k].settings, cases[k].note),
                 0, "%s: no note", cases[k].settings);
}

/* Expects a note of info if and only if the recorded run of the map did not complete. */
static void expect_warning_as_in_map(const char *report, const char *map, const char *form, int column,
                                     const char *settings)
{
  const bool failed = maps_verdict(report, map, form, column) != 'c';
  cr_expect_eq(shell("$DELBM info held.yaml --set coupling.form=%s %s >out && grep -q 'form: midpoint does not' out",
                     form, settings),
               failed ? 0 : 1, "%s, %s, column %d", map, form, column);
}

Test(program, info_warns_of_the_places_of_maps_of_held_discs_where_runs_failed_and_of_no_other)
{
  static const char *const forms[] = {"unified", "owen", "midpoint"};
  static const double spins[] = {0.001, 0.002, 0.004, 0.008, 0.015, 0.03}, machs[] = {0.02, 0.05, 0.1, 0.15, 0.2, 0.3};
  char *report = maps_read(), settings[256];
  shell_write("held.yaml",
              "domain: {size: [90, 60]}\nfluid: {viscosity: 0.01}\n"
              "particles: {discs: [{radius: 5, position: [40.3, 55.5], fixed: true}]}\nrun: {steps: 20000}\n");
  for (int form = 0; form < 3; form++)
    for (int c = 0; c < 6; c++) {
      snprintf(settings, sizeof settings, "--set domain.top.velocity=[%g,0]", machs[c] / sqrt(3));
      expect_warning_as_in_map(report, "fixed disc under a lid", forms[form], c, settings);
      snprintf(settings, sizeof settings,
               "--set domain.size=[60,60] --set 'particles.discs=[{radius: 10, position: [30, 30], fixed: true, spin: "
               "%g}]' --set domain.left=periodic --set domain.right=periodic --set domain.top=periodic --set "
               "domain.bottom=periodic",
               spins[c]);
      expect_warning_as_in_map(report, "fixed disc that spins", forms[form], c, settings);
    }
  cr_expect_eq(shell("$DELBM info held.yaml --set coupling.form=owen --set domain.top.velocity=[0.1,0] "
                     "--set particles.discs.0.position=[40,30] >out && ! grep 'form: midpoint does not' out"),
               0, "a disc far from the lid");
  free(report);
}

Test(program, info_warns_once_of_small_viscosity)
{
  shell_write("thin.yaml", "domain: {size: [32, 32]}\nfluid: {viscosity: 0.0009}\nrun: {steps: 3}\n");
  for (int k = 0; k < 4; k++) {
    static const char *const operators[] = {"bgk", "trt", "mrt", "adaptive"};
    cr_expect_eq(
        shell("test $(%s info thin.yaml --set fluid.collision=%s | grep -c 'note: .*reliable above Mach 0.2') = 1 && "
              "test $(%s info thin.yaml --set fluid.collision=%s | grep -c 'note: ') = 1",
              DELBM, operators[k], DELBM, operators[k]),
        0);
  }
}

static const char *const notes_of_rest[] = {"come to lie in a pile", "note: at rest", "sound between"};

/* Expects exactly the notes named by letters: p(ile), o(verlap), s(ound). */
static void expect_notes(const char *path, const char *settings, const char *letters)
{
  cr_assert_eq(shell("$DELBM info %s %s >i 2>err || { cat err; exit 1; }", path, settings), 0, "%s %s", path, settings);
  for (int k = 0; k < 3; k++)
    cr_expect_eq(contains("i", notes_of_rest[k]), strchr(letters, "pos"[k]) != NULL, "%s %s: %s", path, settings,
                 notes_of_rest[k]);
}

/* Measured: after 50,000 steps the pore pressure supports 45 % of the weight, and discs overlap by 2 % of their
 * radius. */
static const char *const pile =
    "units: {dx: 0.1 mm, dt: 0.02 ms, density: 1000 kg/m^3}\n"
    "domain: {size: [12 mm, 12 mm]}\n"
    "fluid: {viscosity: 1e-6 m^2/s}\n"
    "particles:\n"
    "  density: 2500 kg/m^3\n"
    "  gravity: [0, -9.81 m/s^2]\n"
    "  fill: {spacing: 2.2 mm, radius: 1 mm, jitter: 0.05 mm, region: [0, 0, 12 mm, 9 mm]}\n"
    "contact: {stiffness: 0.25}\n"
    "run: {steps: 1 s}\n";

Test(program, info_warns_of_a_pile_and_of_overlap_under_load_where_discs_come_to_rest)
{
  shell_write("pile.yaml", pile);
  expect_notes("pile.yaml", "", "po");
  expect_notes("pile.yaml", "--set contact.stiffness=1.6", "p");
  expect_notes("pile.yaml", "--set run.steps=200", "");
  expect_notes("pile.yaml", "--set particles.gravity=[0,0]", "");
  expect_notes("pile.yaml", "--set 'particles.gravity=[0, 9.81 m/s^2]'", "po");
  expect_notes("pile.yaml", "--set 'particles.gravity=[9.81 m/s^2, 0]'", "po");
  expect_notes("pile.yaml", "--set domain.bottom=periodic --set domain.top=periodic", "");
  expect_notes("pile.yaml", "--set particles.density=0.1", "po");
  expect_notes("pile.yaml", "--set particles.density=1", "");
  /* two discs, alone on the ground: 3 % by their weight; one so heavy that it is 12 % */
  const char *const two =
      "--set 'particles={gravity: [0, -0.0245], density: %s, discs: [{radius: 10, position: [30, 30]}, "
      "{radius: 10, position: [90, 30]}]}'";
  char settings[256];
  snprintf(settings, sizeof settings, two, "1.01");
  expect_notes("pile.yaml", settings, "");
  snprintf(settings, sizeof settings, two, "1.08");
  expect_notes("pile.yaml", settings, "o");
  cr_expect_eq(
      shell("grep -q 'at rest discs and the side that they lie on overlap by about 1[23] %% of their radius' i"), 0);
}

/* Measured: contacts bear 77 % of the weight at 0.99, all of it at 0.95 and below; with softer contacts, whose overlaps close
 * the passages, 84 to 98 % at 0.9. */
Test(program, info_warns_of_a_pile_that_is_sealed_and_names_the_hydraulic_radius_that_opens_it)
{
  shell_write("pile.yaml", pile);
  expect_notes("pile.yaml", "--set coupling.hydraulic_radius=0.99", "po");
  cr_expect(contains("i", "better: coupling.hydraulic_radius: 0.8"));
  expect_notes("pile.yaml", "--set coupling.hydraulic_radius=0.95", "o");
  expect_notes("pile.yaml", "--set coupling.hydraulic_radius=0.8", "o");
  cr_expect(contains("i", "radius 8 to 8 for the fluid, solid fraction 0.279"));
  expect_notes("pile.yaml", "--set coupling.hydraulic_radius=0.9 --set contact.stiffness=0.025", "po");
  expect_notes("pile.yaml", "--set coupling.hydraulic_radius=0.8 --set contact.stiffness=0.025", "o");
}

/* A column of discs that collapses, 200 x 100 cells. Measured overlap: up to 14 % of the radius, 16 % on the ground. */
Test(program, info_foresees_the_overlap_in_a_column_and_names_the_stiffness)
{
  shell_write("pile.yaml", pile);
  const char *const column =
      "--set 'domain.size=[80 mm, 40 mm]' --set 'run.steps=0.5 s' --set "
      "'particles.fill={spacing: 2.02 mm, radius: 1 mm, region: [0, 0, 20 mm, 36 mm], jitter: 0}'";
  expect_notes("pile.yaml", column, "po");
  cr_expect_eq(shell("awk '/note: at rest/ {match($0, /about [0-9.]+ %%/); p = substr($0, RSTART + 6, RLENGTH - 8); "
                     "exit !(p + 0 > 8 && p + 0 < 16)}' i"),
               0);
  cr_expect_eq(shell("k=$(sed -n 's/.*contact.stiffness >= \\([0-9.e+]*\\),.*/\\1/p' i) && test -n \"$k\" && "
                     "$DELBM info pile.yaml %s --set contact.stiffness=$k >i && ! grep 'note: at rest' i",
                     column),
               0);
}

Test(program, info_says_the_stiffness_where_it_is_from_and_the_overlap_under_the_expected_loads)
{
  shell_write("pile.yaml", pile);
  static const struct {
    const char *settings, *words;
  } cases[] = {
      {"", "^contacts .* stiffness 0.25, alpha"},
      {"", "^loads        at rest 0.068., radius 10 on radius 10: overlap 3.6 % of the smaller radius$"},
      {"", "^             impact at up to 0.0201 cells/step, radius 10 against a side: overlap up to 11 %, about 1 "
           "sub-step a step$"},
      {"--set contact.stiffness=auto", "^contacts .* stiffness [0-9.]* (auto: impacts), alpha"},
      {"--set contact.stiffness=auto", "^             impact .*: overlap up to 1 %, about [2-4] sub-steps a step$"},
      {"--set contact.stiffness=auto --set contact.overlap=0.05", "^             impact .*: overlap up to 5 %"},
      {"--set contact.stiffness=auto --set contact.area=cells", "stiffness [0-9.]* (auto: the number of sub-steps)"},
      {"--set contact.stiffness=auto --set particles.density=1", "stiffness 0.25 (auto: the least)"},
      {"--set contact.stiffness=auto --set contact.overlap=1e-4", "note: so many sub-steps .*contact.overlap >= 0.000"},
  };
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++)
    cr_expect_eq(shell("$DELBM info pile.yaml %s >i && grep -q '%s' i || { cat i >&2; exit 1; }", cases[k].settings,
                       cases[k].words),
                 0, "%s: %s", cases[k].settings, cases[k].words);
  cr_expect_eq(shell("$DELBM info pile.yaml --set particles.density=1 >i && ! grep -q '^loads' i"), 0);
  expect_notes("pile.yaml", "--set contact.stiffness=auto", "p");
}

/* Measured Strouhal numbers: src/cli/advice_sound.c. */
Test(program, info_warns_of_sound_between_the_sides_where_it_was_seen_to_spoil_the_shedding)
{
  shell_write("tone.yaml", "domain:\n"
                           "  size: [180, 200]\n"
                           "  left: {type: inlet, velocity: [0.03, 0]}\n"
                           "  right: outlet\n"
                           "  bottom: {type: wall, velocity: [0.03, 0]}\n"
                           "  top: {type: wall, velocity: [0.03, 0]}\n"
                           "fluid: {viscosity: 0.003}\n"
                           "particles: {discs: [{radius: 5, position: [80, 50.3], fixed: true}]}\n"
                           "run: {steps: 60000}\n");
  expect_notes("tone.yaml", "", "s");
  cr_expect(contains("i", "domain.size[0] >= 300"));
  static const struct {
    const char *size, *letters;
  } boxes[] = {{"[270,200]", "s"}, {"[300,200]", ""},  {"[360,200]", ""}, {"[180,400]", "s"}, {"[360,400]", "s"},
               {"[720,400]", ""},  {"[360,800]", "s"}, {"[180,150]", ""}, {"[180,130]", ""},  {"[180,100]", ""}};
  for (size_t k = 0; k < sizeof boxes / sizeof boxes[0]; k++) {
    char settings[64];
    snprintf(settings, sizeof settings, "--set domain.size=%s", boxes[k].size);
    expect_notes("tone.yaml", settings, boxes[k].letters);
  }
  expect_notes("tone.yaml", "--set fluid.viscosity=0.007", "");
  expect_notes("tone.yaml", "--set particles.discs.0.fixed=no --set particles.density=2", "");
  expect_notes("tone.yaml", "--set domain.bottom=periodic --set domain.top=periodic", "");
  expect_notes("tone.yaml", "--set domain.bottom=outlet", "");
  expect_notes("tone.yaml",
               "--set 'domain={size: [200, 180], bottom: {type: inlet, velocity: [0, 0.03]}, top: outlet}'", "s");
  cr_expect(contains("i", "left and right") && contains("i", "domain.size[1] >= 300"));
}

/* The cases of the paper: bed and discs of `settling`, `dkt` and `disc` do not come to rest within their runs. */
Test(program, info_has_no_such_warning_for_the_cases_that_are_right)
{
  static const char *const cases[] = {"disc/case.yaml", "dkt/case.yaml", "settling/case.yaml", "settling/alone.yaml",
                                      "spin/case.yaml"};
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
    char path[512];
    snprintf(path, sizeof path, "%s/../cases/%s", TEST_DIR, cases[k]);
    expect_notes(path, "", "");
    cr_expect_not(contains("i", "Mach above"), "%s", path);
  }
}

/* Memory by info against run.json, MiB; a build with sanitizers needs more. */
static void expect_measured_memory(const char *settings)
{
  cr_expect_eq(shell("%s run crowd.yaml --quiet --out o %s >/dev/null && "
                     "taken=$(sed -n 's/^ *\"peak_rss_mib\": \\([0-9.]*\\).*/\\1/p' o/run.json) && "
                     "told=$(%s info crowd.yaml %s | sed -n 's/^memory.*in all about \\([0-9.]*\\) MiB$/\\1/p') && "
                     "echo \"taken $taken told $told\" && "
                     "awk \"BEGIN { exit !($taken <= 1.2 * $told && $told < 1.2 * $taken) }\"",
                     DELBM, settings, DELBM, settings),
               0, "%s", settings);
}

Test(program, takes_within_a_fifth_the_memory_that_info_says)
{
  if (SLOWNESS > 1) cr_skip_test("a sanitizer takes memory of its own");
  setenv("OMP_NUM_THREADS", "2", 1);
  unsetenv("MALLOC_PERTURB_"); /* set by meson: it touches all allocated memory */
  shell_write("crowd.yaml",
              "domain: {size: [600, 600]}\n"
              "fluid: {viscosity: 0.05}\n"
              "particles:\n"
              "  density: 1.2\n"
              "  gravity: [0, -1e-3]\n"
              "  fill: {pattern: jittered-grid, spacing: 4.2, radius: 2, density: 1.2, jitter: 0.1, seed: 3}\n"
              "contact: {stiffness: 5}\n"
              "run: {steps: 10}\n"
              "output: {every: 0}\n");
  expect_measured_memory("");
  expect_measured_memory("--set particles={}");
  expect_measured_memory("--set contact.search=linked-cell");
  expect_measured_memory("--set contact.area=cells");
#ifdef DELBM_PNG
  expect_measured_memory("--set output.frames.every=5");
#endif
#ifdef DELBM_HDF5
  expect_measured_memory("--set output.fields.every=5");
#endif
}

/* A square box whose populations are a tenth more than the memory of the machine; nothing of it is written to. */
Test(program, a_box_beyond_the_memory_of_the_machine_is_refused_before_the_run)
{
  if (SLOWNESS > 1) cr_skip_test("a sanitizer takes memory of its own");
  if (shell("awk '/^MemTotal/ {n = int(sqrt(1.1 * 1024 * $2 / 72)); exit !(n < 90000)} END "
            "{printf \"domain: {size: [%%d, %%d]}\\nfluid: {viscosity: 0.1}\\nrun: {steps: 3}\\n\", n, n}' "
            "/proc/meminfo >box.yaml") != 0)
    cr_skip_test("more memory than the largest box takes");
  cr_expect_eq(shell("$DELBM run box.yaml --quiet --out o 2>err"), 3);
  cr_expect_eq(
      shell("grep -q '^delbm: too large for this machine: .* GiB for the populations (domain.size) beside' err && "
            "! test -e o"),
      0);
  cr_expect_eq(shell("$DELBM info box.yaml | grep -q '^memory *too large for this machine'"), 0);
}
