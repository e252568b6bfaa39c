/* Faults of disk and folder: a clear message, exit code 4, and the last good checkpoint remains. */
#include "shell.h"

static const char *const pair = "domain: {size: [64, 60]}\n"
                                "fluid: {viscosity: 0.05}\n"
                                "particles:\n"
                                "  density: 1.2\n"
                                "  gravity: [0, -1e-4]\n"
                                "  discs: [{radius: 7, position: [30, 40]}, {radius: 6, position: [33, 20]}]\n"
                                "run: {steps: 3000}\n"
                                "output: {every: 1, checkpoint: {every: 100}}\n";

static void enter(void)
{
  shell_enter();
  shell_write("pair.yaml", pair);
  shell_write("silent.yaml", "domain: {size: [8, 8]}\nfluid: {viscosity: 0.1}\nrun: {steps: 3}\n");
}

TestSuite(faults, .init = enter, .fini = shell_leave, .timeout = 60 * SLOWNESS);

/* Runs a script in a mount namespace of its own; skips the test where that is not allowed. */
static void need_mounts(void)
{
  if (shell("unshare -m mount -t tmpfs tmpfs /mnt 2>/dev/null") != 0) cr_skip_test("mounting needs root");
}

Test(faults, a_full_disk_ends_the_run_and_room_lets_it_go_on)
{
  need_mounts();
  cr_assert_eq(shell("$DELBM run pair.yaml --quiet --out whole >/dev/null && mkdir disk"), 0);
  cr_expect_eq(shell("unshare -m sh -c 'mount -t tmpfs -o size=1000k tmpfs disk && "
                     "$DELBM run pair.yaml --quiet --out disk/cut >out 2>err; test $? = 4 || exit 9; "
                     "ls disk/cut/checkpoint.0 disk/cut/checkpoint.1 >/dev/null || exit 8; "
                     "mount -o remount,size=8000k disk && $DELBM resume disk/cut --quiet >/dev/null || exit 7; "
                     "cmp whole/particles.csv disk/cut/particles.csv'"),
               0);
  cr_expect_eq(
      shell("grep -qE '^delbm: cannot write disk/cut/(particles.csv|checkpoint.[01]): No space left on device$' "
            "err && grep -q status=failed out"),
      0);
}

Test(faults, a_limit_on_file_size_is_an_error_like_a_full_disk)
{
  cr_expect_eq(shell("$DELBM run pair.yaml --quiet --out whole >/dev/null; ulimit -f 800; "
                     "$DELBM run pair.yaml --quiet --out cut >out 2>err"),
               4);
  cr_expect_eq(shell("grep -q '^delbm: cannot write cut/particles.csv: File too large$' err"), 0);
  cr_expect_eq(shell("$DELBM resume cut --quiet >/dev/null && cmp whole/particles.csv cut/particles.csv"), 0);
}

Test(faults, a_checkpoint_that_cannot_be_written_leaves_the_earlier_ones)
{
  cr_assert_eq(shell("$DELBM run pair.yaml --quiet --set run.steps=300 --out cut >/dev/null && "
                     "cp cut/checkpoint.0 cut/checkpoint.1 ."),
               0);
  cr_expect_eq(shell("sed -i 's/^  every: 1$/  every: 0/' cut/case.yaml; ulimit -f 100; "
                     "$DELBM resume cut --steps 900 --quiet >out 2>err"),
               4);
  cr_expect_eq(
      shell("grep -qE '^delbm: cannot write cut/checkpoint.[01]: File too large$' err && "
            "cmp checkpoint.0 cut/checkpoint.0 && cmp checkpoint.1 cut/checkpoint.1 && ! ls cut/*.tmp 2>/dev/null"),
      0);
  cr_expect_eq(shell("$DELBM resume cut --steps 900 --quiet >/dev/null"), 0);
}

Test(faults, a_read_only_folder_is_refused_before_the_first_step)
{
  need_mounts();
  cr_expect_eq(
      shell("mkdir disk; unshare -m sh -c 'mount -t tmpfs tmpfs disk && $DELBM run silent.yaml --quiet --out disk/old "
            ">/dev/null && mount -o remount,ro disk; "
            "$DELBM run silent.yaml --out disk/new 2>err1; a=$?; $DELBM run silent.yaml --out disk/old 2>err2; b=$?; "
            "test $a = 4 -a $b = 4 -a -s disk/old/run.json'"),
      0);
  cr_expect_eq(shell("grep -q '^delbm: cannot make folder disk/new: Read-only file system$' err1 && "
                     "grep -q '^delbm: cannot .* disk/old/.*: Read-only file system$' err2"),
               0);
}

Test(faults, a_missing_folder_or_case_is_named)
{
  cr_expect_eq(shell("$DELBM resume absent 2>err"), 4);
  cr_expect_eq(shell("grep -q '^delbm: cannot open absent/case.yaml: No such file or directory$' err"), 0);
  cr_expect_eq(shell("mkdir bare; cp silent.yaml bare/case.yaml; $DELBM resume bare 2>err"), 4);
  cr_expect_eq(shell("grep -q '^delbm: nothing to resume: bare contains no checkpoint$' err"), 0);
}

/* Starts a run without end, runs the script on its folder once there are rows, and returns the run's exit code. */
static int disturb(const char *what)
{
  return shell("$DELBM run pair.yaml --quiet --out cut --set run.steps=100000000 %s >out 2>err & p=$!; "
               "while kill -0 $p && test $(cat cut/particles.csv 2>/dev/null | wc -l) -le 300; do sleep 0.01; done; "
               "%s; wait $p",
#ifdef DELBM_PNG
               "--set output.frames.every=50",
#else
               "",
#endif
               what);
}

Test(faults, a_folder_that_is_removed_moved_or_replaced_ends_the_run)
{
  static const char *const what[] = {"until rm -rf cut 2>/dev/null; do :; done", "mv cut moved",
                                     "mv cut moved; mkdir cut", "mv cut moved; ln -s moved other; ln -s nowhere cut"};
  for (size_t k = 0; k < sizeof what / sizeof what[0]; k++) {
    cr_expect_eq(disturb(what[k]), 4, "%s", what[k]);
    cr_expect_eq(
        shell("grep -q '^delbm: cannot .* cut[/:]' err && grep -q status=failed out && ! ls cut/* 2>/dev/null"), 0,
        "%s", what[k]);
    /* during its removal the folder may lack only some files */
    cr_expect_eq(shell("test %zu = 0 || "
                       "grep -q '^delbm: cannot go on in cut: it was removed, moved or replaced while the run' err",
                       k),
                 0, "%s", what[k]);
    cr_assert_eq(shell("rm -rf cut moved"), 0);
  }
}

Test(faults, a_table_that_is_removed_or_replaced_ends_the_run)
{
  cr_expect_eq(disturb("rm cut/particles.csv"), 4);
  cr_expect_eq(shell("grep -q '^delbm: cannot go on in cut/particles.csv: it was removed' err"), 0);
  cr_expect_eq(disturb("mv cut/particles.csv old; echo hello >cut/particles.csv"), 4);
  cr_expect_eq(shell("grep -q '^delbm: cannot go on in cut/particles.csv: it was removed' err && "
                     "test $(cat cut/particles.csv) = hello && grep -q '\"status\": \"failed\"' cut/run.json"),
               0);
}

/* Root may write anywhere: the run is another user's. */
Test(faults, a_folder_that_nobody_may_write_to_any_more_ends_the_run)
{
  if (shell("setpriv --reuid 65534 --regid 65534 --clear-groups $DELBM --version >/dev/null 2>&1") != 0)
    cr_skip_test("becoming another user needs root");
  cr_assert_eq(shell("chmod 755 . && mkdir cut && chown 65534:65534 cut && : >out && : >err && chmod 666 out err"), 0);
  setenv("DELBM", "setpriv --reuid 65534 --regid 65534 --clear-groups " DELBM, 1);
  cr_expect_eq(disturb("chmod 555 cut"), 4);
  cr_expect_eq(shell("grep -qE '^delbm: cannot (create|write) cut/[a-z0-9./]+: Permission denied$' err"), 0);
}

#ifdef DELBM_PNG
Test(faults, a_folder_of_frames_that_is_removed_ends_the_run)
{
  cr_expect_eq(disturb("mv cut/frames gone"), 4);
  cr_expect_eq(
      shell("grep -qE '^delbm: cannot (create|write) cut/frames/[0-9]+.png(.tmp)?: No such file or directory$' err"),
      0);
}
#endif

/* Arguments of a run in the folder `cut`. */
static const char *const short_run = "run pair.yaml --quiet --out cut --set run.steps=300"
#ifdef DELBM_PNG
                                     " --set output.frames.every=100"
#endif
#ifdef DELBM_HDF5
                                     " --set output.fields.every=100"
#endif
    ;

/* Every file name of a run, with and without .tmp, is a link or fifo that leads outside of the folder. */
Test(faults, links_and_fifos_of_a_files_name_are_replaced_and_what_they_lead_to_stays)
{
  static const char *const plant[] = {"ln -s \"$PWD/precious\"", "ln precious", "mkfifo"};
  cr_assert_eq(shell("$DELBM %s >/dev/null && mv cut whole && echo precious >precious", short_run), 0);
  for (size_t k = 0; k < sizeof plant / sizeof plant[0]; k++) {
    cr_assert_eq(shell("rm -rf cut; mkdir -p cut/frames; (cd whole; find . -type f) >names; "
                       "while read -r n; do %s \"cut/$n.tmp\"; done <names",
                       plant[k]),
                 0);
    cr_expect_eq(shell("timeout 20 $DELBM %s >out 2>err", short_run), 0, "%s", plant[k]);
    cr_expect_eq(shell("test \"$(cat precious)\" = precious && cmp whole/particles.csv cut/particles.csv && "
                       "cmp whole/case.yaml cut/case.yaml"),
                 0, "%s", plant[k]);
    cr_assert_eq(shell("rm -rf cut; mkdir -p cut/frames; "
                       "grep -v -e case -e frames -e json names | while read -r n; do %s \"cut/$n\"; done",
                       plant[k]),
                 0);
    cr_expect_eq(shell("timeout 20 $DELBM %s >out 2>err", short_run), 0, "%s", plant[k]);
    cr_expect_eq(shell("test \"$(cat precious)\" = precious && cmp whole/particles.csv cut/particles.csv && "
                       "test -z \"$(find cut -type l -o -type p)\""),
                 0, "%s", plant[k]);
  }
}

Test(faults, links_and_fifos_are_not_gone_on_with)
{
  cr_assert_eq(shell("$DELBM %s >/dev/null && mv cut whole", short_run), 0);
  cr_expect_eq(shell("cp -al whole cut && timeout 20 $DELBM resume cut --steps 400 2>err"), 4);
  cr_expect_eq(shell("grep -q '^delbm: cannot go on with cut/particles.csv: the file has 2 names (hard links)' err && "
                     "cmp whole/particles.csv cut/particles.csv"),
               0);
  cr_expect_eq(shell("rm -rf cut; cp -r whole cut; mv cut/particles.csv table; ln -s ../table cut/particles.csv; "
                     "timeout 20 $DELBM resume cut --steps 400 2>err"),
               4);
  cr_expect_eq(shell("grep -q '^delbm: cannot go on with cut/particles.csv: it is a symbolic link' err && "
                     "cmp whole/particles.csv table"),
               0);
  cr_expect_eq(shell("rm cut/particles.csv; mkfifo cut/particles.csv; timeout 20 $DELBM resume cut --steps 400 2>err"),
               4);
  cr_expect_eq(shell("rm -rf cut; cp -r whole cut; rm cut/checkpoint.0; mkfifo cut/checkpoint.0; "
                     "timeout 20 $DELBM resume cut --steps 400 --quiet >out 2>err"),
               0);
  cr_expect_eq(shell("grep -q 'refused checkpoint cannot open cut/checkpoint.0: it is not a plain file' err"), 0);
}

Test(faults, stdout_closed_full_or_broken_fails_after_the_run)
{
  cr_expect_eq(shell("$DELBM run silent.yaml --quiet --out closed >&- 2>err"), 4);
  cr_expect_eq(shell("grep -q '^delbm: cannot write to standard output: ' err && "
                     "grep -q '\"status\": \"done\"' closed/run.json && ! grep -q status= closed/particles.csv"),
               0);
  cr_expect_eq(shell("$DELBM run silent.yaml --quiet --out full >/dev/full 2>err"), 4);
  cr_expect_eq(shell("grep -q '^delbm: cannot write to standard output: No space left on device$' err && "
                     "grep -q '\"status\": \"done\"' full/run.json"),
               0);
  cr_expect_eq(
      shell("{ $DELBM run silent.yaml --quiet --out pipe 2>err; echo $? >code; } | true; read -r c <code; exit $c"), 4);
}
