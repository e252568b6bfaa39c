/* `delbm plot`: pictures, and scripts that belong to the user. */
#include "shell.h"

static const char *const pair = "title: It's a \"pair\"\n"
                                "domain: {size: [64, 60], left: periodic, right: periodic}\n"
                                "fluid: {viscosity: 0.05}\n"
                                "particles:\n"
                                "  density: 1.2\n"
                                "  gravity: [0, -1e-4]\n"
                                "  discs: [{radius: 7, position: [60, 40]}, {radius: 6, position: [33, 20]}]\n"
                                "run: {steps: 200}\n"
                                "output: {every: 10}\n";

static void enter(void)
{
  shell_enter();
  shell_write("pair.yaml", pair);
  cr_assert_eq(shell("$DELBM run pair.yaml --quiet --out o >/dev/null"), 0);
}

TestSuite(plot, .init = enter, .fini = shell_leave, .timeout = 60 * SLOWNESS);

static void need_gnuplot(void)
{
  if (shell("command -v gnuplot >/dev/null") != 0) cr_skip_test("gnuplot is not installed");
}

static bool is_picture(const char *path)
{
  return shell("test \"$(head -c 4 %s | tail -c 3)\" = PNG", path) == 0;
}

Test(plot, draws_what_the_run_has)
{
  need_gnuplot();
  cr_expect_eq(shell("$DELBM plot o >out 2>err"), 0);
  cr_expect(is_picture("o/plots/trajectories.png") && is_picture("o/plots/velocities.png") &&
            is_picture("o/plots/stages.png"));
  cr_expect_eq(shell("test $(wc -l <out) = 3 && ! test -s err && grep -q '^o/plots/stages.png$' out"), 0);
  /* without discs there is no table */
  shell_write("still.yaml", "domain: {size: [64, 80]}\nfluid: {viscosity: 0.1}\nrun: {steps: 3}\n");
  cr_expect_eq(shell("$DELBM run still.yaml --quiet --out s >/dev/null; $DELBM plot s >out 2>err"), 0);
  cr_expect_eq(shell("test \"$(cat out)\" = s/plots/stages.png && ls s/plots | grep -c gp | grep -q 2"), 0);
}

Test(plot, of_many_discs_settling_shows_their_interface)
{
  need_gnuplot();
  shell_write("crowd.yaml", "domain: {size: [120, 100]}\n"
                            "fluid: {viscosity: 0.05}\n"
                            "particles: {density: 1.2, gravity: [0, -1e-4], fill: {spacing: 20, radius: 5}}\n"
                            "run: {steps: 200}\n"
                            "output: {every: 20}\n");
  cr_expect_eq(shell("$DELBM run crowd.yaml --quiet --out c >/dev/null; $DELBM plot c >out 2>err && ! test -s err"), 0);
  cr_expect(is_picture("c/plots/interface.png") && is_picture("c/plots/mixing.png") &&
            is_picture("c/plots/trajectories.png"));
}

Test(plot, uses_a_changed_script_as_it_is_until_told_otherwise)
{
  need_gnuplot();
  cr_assert_eq(shell("$DELBM plot o >/dev/null && cp o/plots/stages.gp . && echo 'print 22 + 20' >o/plots/stages.gp"),
               0);
  cr_expect_eq(shell("$DELBM plot o >out 2>err && grep -q '^42$' err && "
                     "grep -q '^delbm: using o/plots/stages.gp as it is$' err"),
               0);
  cr_expect_eq(shell("echo nonsense >o/plots/stages.gp; $DELBM plot o >out 2>err"), 4);
  cr_expect_eq(shell("grep -q '^delbm: gnuplot fails on o/plots/stages.gp; --fresh writes the script anew$' err"), 0);
  cr_expect_eq(shell("$DELBM plot --fresh o >out 2>err && cmp stages.gp o/plots/stages.gp"), 0);
  cr_expect_eq(shell("cd o && rm plots/*.png && gnuplot plots/trajectories.gp && test -s plots/trajectories.png"), 0);
}

Test(plot, without_gnuplot_leaves_the_scripts_and_says_what_is_missing)
{
  cr_expect_eq(shell("PATH=/nonexistent $DELBM plot o >out 2>err"), 4);
  cr_expect_eq(shell("grep -q '^delbm: cannot draw: gnuplot is not installed (Debian: gnuplot-nox); the scripts are in "
                     "o/plots$' err && test -s o/plots/trajectories.gp -a -s o/plots/stages.gp"),
               0);
}

Test(plot, of_no_run_is_an_error)
{
  cr_expect_eq(shell("$DELBM plot absent 2>err"), 4);
  cr_expect_eq(shell("$DELBM plot 2>err"), 2);
  cr_expect_eq(shell("mkdir bare; cp pair.yaml bare/case.yaml; $DELBM plot bare 2>err"), 4);
  cr_expect_eq(shell("grep -q '^delbm: nothing to plot: bare contains no results$' err"), 0);
}
