/* Every call that can fail fails in turn (allocations, threads, files) in a small run with discs, contacts, frames
 * and checkpoints. The program must end by itself with the exit code of the failure and its reason; its files can be
 * resumed, to the same bytes; and a run that reports success is complete. With sanitizers (`tests/harden asan`)
 * nothing leaks. By default a sample of the calls; DELBM_EVERY_CALL=1 tries all. */
#include "shell.h"

#ifdef DELBM_HDF5
#include <hdf5.h>
#endif

static const char *const small = "domain: {size: [40, 30], left: periodic, right: periodic}\n"
                                 "fluid: {viscosity: 0.05}\n"
                                 "particles:\n"
                                 "  density: 1.2\n"
                                 "  gravity: [0, -1e-3]\n"
                                 "  discs:\n"
                                 "    - {radius: 5, position: [10, 5.5]}\n"
                                 "    - {radius: 4, position: [19, 6.5]}\n"
                                 "    - {radius: 3, position: [30, 20], fixed: true}\n"
                                 "  fill: {pattern: jittered-grid, spacing: 6, radius: 2, jitter: 0.5, seed: 1, "
                                 "region: [0, 12, 14, 28]}\n"
                                 "contact: {stiffness: 5}\n"
                                 "run: {steps: 9}\n"
#ifdef DELBM_PNG
                                 "output: {every: 2, series: {every: 2}, checkpoint: {every: 3}, frames: {every: 4}}\n";
#else
                                 "output: {every: 2, series: {every: 2}, checkpoint: {every: 3}}\n";
#endif

/* Kind of failure, command, and judge: a script, with the exit code in `code`, that returns 0 if all is right. */
struct trial {
  const char *kind, *command, *before, *judge;
  int stride; /* between the calls that are tried */
};

/* Shell functions of the judges. */
static const char *const functions =
    "same() { cmp whole/particles.csv $1/particles.csv && cmp whole/series.csv $1/series.csv && "
    "if test -e whole/frames; then diff -r whole/frames $1/frames; fi && "
    "if test -e whole/fields.h5; then cmp whole/fields.h5 $1/fields.h5 && cmp whole/fields.xdmf $1/fields.xdmf; fi; }\n"
    "told() { grep -qE \"^(delbm|libgomp): .*($1)\" err; }\n"
    "clean() { test -z \"$(find cut -name '*.tmp' 2>/dev/null)\"; }\n"
    "resumable() { if ls cut/checkpoint.[01] >/dev/null 2>&1; then $DELBM resume cut --steps 9 --quiet >/dev/null && "
    "same cut; "
    "fi; }\n";

static const char *const no_memory =
    "case $code in 0) same cut ;; 1) told 'out of memory|Out of memory' && "
    "{ ! test -s out || grep -q ' status=failed ' out; } && ! grep -qs diverged cut/run.json ;; "
    "4) told 'Cannot allocate memory|HDF5' ;; *) false ;; esac && clean && resumable";
static const char *const no_file =
    "case $code in 0) same cut ;; 1) told 'out of memory: the fingerprint' ;; 4) told . ;; "
    "*) false ;; esac && clean && resumable";
static const char *const no_room_at_all = "case $code in 1|4) told . && resumable ;; *) false ;; esac";
static const char *const said = "case $code in 0) true ;; 1|4) told . ;; *) false ;; esac";

/* Lets call number `call` fail. False when there is none. */
static bool try_call(const struct trial *trial, int call, const char *on)
{
  const int result = shell("%s\nrm -rf cut at; %s\n"
                           "DELBM_FAILED_AT=at DELBM_FAIL='%s %d%s' $DELBM_FAULTY %s >out 2>err; code=$?\n"
                           "test -s at || { test $code = 0 && exit 100; }\n"
                           "%s",
                           functions, trial->before, trial->kind, call, on, trial->command, trial->judge);
  if (result == 100) return false;
  if (result != 0)
    shell("echo \"%s %d%s of $DELBM_FAULTY %s: $(cat at)\"; cat err", trial->kind, call, on, trial->command);
  cr_expect_eq(result, 0, "%s %d%s of %s", trial->kind, call, on, trial->command);
  return true;
}

static void try_calls(const struct trial *trial, const char *on)
{
  const int stride = getenv("DELBM_EVERY_CALL") ? 1 : trial->stride;
  int call = 1;
  while (try_call(trial, call, on)) call += stride;
  cr_expect_gt(call, 1, "nothing of the kind is called");
}

static void enter(void)
{
  shell_enter();
  setenv("DELBM_FAULTY", DELBM_FAULTY, 1);
  setenv("OMP_NUM_THREADS", "1", 1);
  setenv("GOMP_SPINCOUNT", "500", 1); /* otherwise the program executes itself again to set it */
  shell_write("small.yaml", small);
  cr_assert_eq(shell("$DELBM run small.yaml --quiet --out whole >/dev/null && "
                     "$DELBM run small.yaml --quiet --set run.steps=5 --out part >/dev/null"),
               0);
}

TestSuite(failures, .init = enter, .fini = shell_leave, .timeout = 100 * SLOWNESS);

Test(failures, of_any_allocation_end_a_run_with_words)
{
  try_calls(&(struct trial){"memory", "run small.yaml --quiet --out cut", "", no_memory, 181}, "");
}

Test(failures, of_any_allocation_end_resume_info_and_analyse_with_words)
{
  try_calls(&(struct trial){"memory", "resume cut --steps 9 --quiet", "cp -r part cut", no_memory, 211}, "");
  try_calls(&(struct trial){"memory", "info small.yaml", "", said, 283}, "");
  try_calls(&(struct trial){"memory", "analyse whole --json figures.json --tables", "", said, 283}, "");
}

Test(failures, of_any_file_end_a_run_with_words)
{
  try_calls(&(struct trial){"file", "run small.yaml --quiet --out cut", "", no_file, 43}, "");
}

Test(failures, of_any_file_end_resume_and_analyse_with_words)
{
  try_calls(&(struct trial){"file", "resume cut --steps 9 --quiet", "cp -r part cut", no_file, 43}, "");
  try_calls(&(struct trial){"file", "analyse whole --json figures.json --tables", "", said, 13}, "");
}

Test(failures, of_all_files_from_some_point_on_leave_the_last_good_checkpoint)
{
  try_calls(&(struct trial){"file", "run small.yaml --quiet --out cut", "", no_room_at_all, 89}, " on");
}

Test(failures, of_any_thread_end_a_run_with_words)
{
  setenv("OMP_NUM_THREADS", "3", 1);
  try_calls(&(struct trial){"thread", "run small.yaml --quiet --out cut --set domain.size=[160,80]", "",
                            "test $code = 1 && told 'Thread creation failed'", 1},
            "");
}

/* In a host of the library: host_faulty.c. */
Test(failures, of_any_allocation_leave_a_simulation_of_the_library_as_it_was)
{
  setenv("OMP_NUM_THREADS", "2", 1);
  cr_expect_eq(shell("%s memory", HOST_FAULTY), 0);
}

Test(failures, of_any_file_leave_a_simulation_of_the_library_as_it_was)
{
  cr_expect_eq(shell("%s file", HOST_FAULTY), 0);
}

#ifdef DELBM_HDF5
/* The case with snapshots of the flow; a whole run, and an interrupted run to resume. */
static const char *const with_fields = " --set output.fields.every=2";

static void enter_with_fields(void)
{
  enter();
  cr_assert_eq(shell("rm -rf whole part; $DELBM run small.yaml --quiet --out whole%s >/dev/null && "
                     "$DELBM run small.yaml --quiet --set run.steps=5 --out part%s >/dev/null",
                     with_fields, with_fields),
               0);
}

TestSuite(failures_of_fields, .init = enter_with_fields, .fini = shell_leave, .timeout = 100 * SLOWNESS);

Test(failures_of_fields, of_any_file_end_a_run_and_resume_with_words)
{
  try_calls(&(struct trial){"file", "run small.yaml --quiet --out cut --set output.fields.every=2", "", no_file, 149},
            "");
  try_calls(&(struct trial){"file", "resume cut --steps 9 --quiet", "cp -r part cut", no_file, 149}, "");
}

/* True if every snapshot that fields.h5 names can be opened and has its values of rho. */
static bool all_are_readable(const char *path)
{
  H5G_info_t group;
  const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  bool readable = file >= 0 && H5Gget_info(file, &group) >= 0;
  for (hsize_t k = 0; readable && k < group.nlinks; k++) {
    char name[64];
    static double rho[40 * 30];
    const ssize_t length = H5Lget_name_by_idx(file, ".", H5_INDEX_NAME, H5_ITER_INC, k, name, 40, H5P_DEFAULT);
    snprintf(name + (length > 0 ? length : 0), 5, "/rho");
    const hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
    readable = set >= 0 && H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, rho) >= 0;
    if (set >= 0) H5Dclose(set);
  }
  if (file >= 0) H5Fclose(file);
  return readable;
}

/* Kills a command at one call after the other, with those in which snapshots are joined and their files removed. */
static void kill_at_calls(const char *command, const char *before, int stride)
{
  int call = 1;
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  for (;; call += getenv("DELBM_EVERY_CALL") ? 1 : stride) {
    if (shell("rm -rf cut at; %s; DELBM_FAILED_AT=at DELBM_FAIL='file %d kill' $DELBM_FAULTY %s >out 2>err", before,
              call, command) == 0)
      break;
    if (access("cut/fields.h5", F_OK) == 0)
      cr_expect(all_are_readable("cut/fields.h5"), "call %d of %s", call, command);
    cr_expect_eq(shell("%s ls cut/checkpoint.[01] >/dev/null 2>&1 && go='resume cut --steps 9' || "
                       "go='run small.yaml --out cut --set output.fields.every=2'; $DELBM $go --quiet >/dev/null && "
                       "same cut && test ! -e cut/fields",
                       functions),
                 0, "call %d of %s", call, command);
  }
  cr_expect_gt(call, 500);
}

Test(failures_of_fields, a_kill_at_any_call_leaves_snapshots_that_can_be_read_and_resumed)
{
  kill_at_calls("run small.yaml --quiet --out cut --set output.fields.every=2", "true", 113);
  kill_at_calls("resume cut --steps 9 --quiet", "cp -r part cut", 167);
}

/* A sample may miss the few seeks of a resumed run. */
Test(failures_of_fields, of_any_seek_leave_what_can_be_resumed)
{
  try_calls(&(struct trial){"lseek", "resume cut --steps 9 --quiet", "cp -r part cut", no_file, 1}, "");
}

Test(failures_of_fields, of_all_files_from_some_point_on_leave_the_last_good_checkpoint)
{
  try_calls(
      &(struct trial){"file", "run small.yaml --quiet --out cut --set output.fields.every=2", "", no_room_at_all, 293},
      " on");
}

Test(failures_of_fields, of_any_allocation_end_a_run_with_words)
{
  try_calls(
      &(struct trial){"memory", "run small.yaml --quiet --out cut --set output.fields.every=2", "", no_memory, 997},
      "");
}
#endif
