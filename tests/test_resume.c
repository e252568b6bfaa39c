/* Saving and restoring, in memory and from outside: an interrupted run ends like an unbroken run. */
#include "drive.h"
#include "forge.h"
#include "scenes.h"
#include "shell.h"

#include "base/clock.h"
#include "case/case_write.h"
#include "output/checkpoint.h"

#include <math.h>
#include <omp.h>

/* A state as bytes. */
struct saved {
  char *bytes;
  size_t size;
};

static struct saved save(struct simulation *simulation)
{
  struct saved saved = {0};
  struct status status;
  FILE *stream = open_memstream(&saved.bytes, &saved.size);
  struct store store = {.stream = stream, .path = "memory", .saving = true};
  cr_assert(simulation_save(simulation, &store, &status), "%s", status.message);
  fclose(stream);
  return saved;
}

static struct simulation *restore(const struct scene *scene, const struct saved *saved)
{
  struct status status;
  struct simulation *simulation = start(scene);
  FILE *stream = fmemopen(saved->bytes, saved->size, "rb");
  struct store store = {.stream = stream, .path = "memory"};
  cr_assert(simulation_restore(simulation, &store, &status), "%s", status.message);
  fclose(stream);
  return simulation;
}

/* Runs the scene whole, and again with a stop every `pause` steps, each part on another number of threads. The states
 * at the end must have the same bits. */
static void expect_same_end(const char *what, const struct scene *scene, int64_t steps, int64_t pause)
{
  omp_set_num_threads(2);
  struct simulation *whole = start(scene), *part = start(scene);
  advance(whole, steps);
  for (int64_t done = 0; done < steps; done += pause) {
    const int64_t left = steps - done;
    omp_set_num_threads(1 + (int)(done / pause) % 3);
    advance(part, pause < left ? pause : left);
    const struct saved state = save(part);
    simulation_destroy(part);
    part = restore(scene, &state);
    free(state.bytes);
  }
  const struct saved a = save(whole), b = save(part);
  cr_assert_eq(a.size, b.size);
  cr_expect_eq(memcmp(a.bytes, b.bytes, a.size - sizeof(struct stage_times)), 0, "%s", what);
  simulation_destroy(whole);
  simulation_destroy(part);
}

Test(state, of_settling_discs_is_whole)
{
  struct scene scene = scene_crowd(150, 130, 7, 16, 0.9);
  expect_same_end("owen", &scene, 240, 37);
  scene.coupling.form = FORM_UNIFIED;
  scene.contact.area = AREA_CELLS;
  expect_same_end("unified, cells", &scene, 240, 61);
  scene.fluid.precision = PRECISION_SINGLE;
  expect_same_end("single", &scene, 240, 80);
}

Test(state, of_stiff_contacts_is_whole)
{
  struct scene scene = scene_crowd(150, 130, 7, 15, 0.4);
  scene.contact.stiffness = 30;
  scene.contact.search = SEARCH_LINKED_CELL;
  expect_same_end("stiff", &scene, 400, 41);
  scene.contact.search = SEARCH_GRID;
  expect_same_end("stiff, grid", &scene, 400, 63);
  scene.contact.area = AREA_CELLS;
  expect_same_end("stiff, cells", &scene, 400, 41);
}

Test(state, of_lubricated_discs_is_whole)
{
  struct scene scene = scene_crowd(150, 130, 7, 15, 0.4);
  scene.contact.lubrication.cutoff = 2;
  expect_same_end("lubricated", &scene, 240, 37);
}

/* Two discs that move through all sides of a periodic box, one driven. */
static struct scene periodic_pair(double density)
{
  struct scene scene = scene_box(90, 80, 0.04, SIDES_PERIODIC);
  scene.particles.gravity[0] = 2e-4;
  scene.fluid.force[1] = 1e-5;
  scene_add_disc(&scene, 9.3, density, 30, 40)->velocity[1] = 0.05;
  struct disc_spec *driven = scene_add_disc(&scene, 8, 1, 60, 50);
  driven->motion = DISC_DRIVEN;
  driven->velocity[0] = -0.02;
  driven->spin = 0.004;
  return scene;
}

Test(state, of_dry_discs_is_whole)
{
  struct scene scene = scene_crowd(150, 130, 7, 15, 0.4);
  scene_dry(&scene);
  scene.particles.gravity[1] = -5e-4;
  scene.contact.stiffness = 30;
  expect_same_end("dry", &scene, 400, 41);
}

Test(state, of_light_discs_is_whole)
{
  const struct scene scene = periodic_pair(0.1);
  expect_same_end("light", &scene, 300, 43);
}

Test(state, of_averaged_forces_is_whole)
{
  struct scene scene = periodic_pair(2);
  scene.coupling.solve = SOLVE_EXPLICIT_AVERAGED;
  expect_same_end("explicit-averaged", &scene, 300, 43);
}

Test(state, of_fixed_discs_and_of_none_is_whole)
{
  struct scene scene = scene_square_array(8, 0.2, 0.05, 1e-5);
  expect_same_end("fixed", &scene, 200, 33);
  scene = scene_box(140, 120, 0.03, SIDES_CLOSED);
  scene.domain.side[SIDE_TOP].velocity[0] = 0.05;
  expect_same_end("blocked in time", &scene, 300, 71);
  scene.fluid.zero_flux = true;
  expect_same_end("blocked in time, without flux", &scene, 300, 71);
  scene_add_disc(&scene, 6, 1.5, 50, 100);
  scene.particles.gravity[1] = -1e-3;
  expect_same_end("rows that no disc can reach ahead, without flux", &scene, 300, 71);
  scene.fluid.zero_flux = false;
  scene.particles.count = scene.particles.listed = 0;
  scene.domain.side[SIDE_LEFT] = (struct side){SIDE_INLET, {0.03, 0}};
  scene.domain.side[SIDE_RIGHT].type = SIDE_OUTLET;
  expect_same_end("outlet", &scene, 200, 51);
  scene_add_disc(&scene, 6, 1.5, 50, 60);
  expect_same_end("outlet and a disc", &scene, 200, 51);
  scene_add_disc(&scene, 6, 1.5, 134.3, 60)->motion = DISC_FIXED;
  expect_same_end("a disc beside an outlet", &scene, 200, 51);
}

Test(state, that_has_diverged_is_not_saved)
{
  struct scene scene = scene_box(40, 40, 0.03, SIDES_CLOSED);
  scene_add_disc(&scene, 6, 1.5, 20, 20)->velocity[0] = 0.3;
  scene.domain.side[SIDE_TOP].velocity[0] = 0.34;
  scene.fluid.force[0] = 0.05;
  scene.run.check = 1000;
  struct simulation *simulation = start(&scene);
  struct status status;
  simulation_advance(simulation, 40, &status);
  char *bytes;
  size_t size;
  struct store store = {.stream = open_memstream(&bytes, &size), .path = "memory", .saving = true};
  cr_assert_not(simulation_save(simulation, &store, &status));
  cr_assert_eq(status.code, DELBM_FAILED);
  fclose(store.stream);
}

/* Overwrites bytes at a distance after a mark in a saved state; true if the state can be restored. */
static bool restores_with(const struct scene *scene, const struct saved *saved, const char *mark, size_t behind,
                          const void *bytes, size_t size, struct status *status)
{
  char *copy = malloc(saved->size), *at;
  cr_assert(copy);
  memcpy(copy, saved->bytes, saved->size);
  at = memmem(copy, saved->size, mark, strlen(mark));
  cr_assert(at);
  memcpy(at + 16 + behind, bytes, size);
  struct simulation *simulation = start(scene);
  struct store store = {.stream = fmemopen(copy, saved->size, "rb"), .path = "forged"};
  const bool restored = simulation_restore(simulation, &store, status);
  fclose(store.stream);
  simulation_destroy(simulation);
  free(copy);
  return restored;
}

Test(state, that_no_run_can_have_reached_is_refused)
{
  const double places[] = {NAN, INFINITY, -1e300, 1e300, 1e10}, outside = 70.5, elsewhere = 3;
  const int parity = 7;
  struct scene scene = scene_box(64, 60, 0.05, SIDES_CLOSED);
  scene.domain.side[SIDE_LEFT].type = scene.domain.side[SIDE_RIGHT].type = SIDE_PERIODIC;
  scene_add_disc(&scene, 7, 1.2, 30, 40);
  struct status status;
  struct simulation *simulation = start(&scene);
  const struct saved saved = save(simulation);
  simulation_destroy(simulation);
  for (size_t k = 0; k < sizeof places / sizeof places[0]; k++)
    for (size_t axis = 0; axis < 2; axis++) {
      cr_expect_not(restores_with(&scene, &saved, "discs", axis * sizeof(double), &places[k], sizeof(double), &status));
      cr_expect(strstr(status.message, "cannot read forged: disc 0 at ("), "%s", status.message);
    }
  cr_expect_not(restores_with(&scene, &saved, "discs", 0, &outside, sizeof outside, &status), "beyond a periodic side");
  cr_expect_not(restores_with(&scene, &saved, "populations", 0, &parity, sizeof parity, &status));
  cr_expect_str_eq(status.message, "cannot read forged: parity 7");
  cr_expect(restores_with(&scene, &saved, "discs", 0, &elsewhere, sizeof elsewhere, &status), "%s", status.message);
  free(saved.bytes);
  scene_clear(&scene);
}

Test(checkpoint, of_another_case_is_known_and_of_another_length_is_not)
{
  struct scene scene = scene_crowd(100, 100, 7, 16, 0.9);
  struct status status;
  uint32_t first, second;
  cr_assert(case_fingerprint(&scene, &first, &status));
  scene.run.steps = 17;
  scene.output.every = 3;
  cr_assert(case_fingerprint(&scene, &second, &status));
  cr_expect_eq(first, second);
  scene.contact.alpha = nextafter(scene.contact.alpha, 1);
  cr_assert(case_fingerprint(&scene, &second, &status));
  cr_expect_neq(first, second);
}

Test(checkpoint, whose_head_tells_another_step_or_order_of_bytes_is_refused_though_its_checksum_is_right)
{
  shell_enter();
  struct scene scene = scene_box(40, 30, 0.05, SIDES_CLOSED);
  const struct run_record record = {.seconds = 1};
  struct run_record read;
  struct checkpoint_head head;
  struct status status;
  struct simulation *simulation = start(&scene), *other = start(&scene);
  advance(simulation, 7);
  cr_assert(checkpoint_write("state", 1, simulation, &record, &status), "%s", status.message);
  forge_step("state", 0);
  cr_assert(checkpoint_examine("state", 1, &head, &status), "%s", status.message);
  cr_expect(head.step == 7 && checkpoint_read("state", other, &read, &status), "%s", status.message);
  forge_step("state", 1);
  cr_assert(checkpoint_examine("state", 1, &head, &status), "%s", status.message);
  cr_expect_not(checkpoint_read("state", other, &read, &status));
  cr_expect(status.code == DELBM_IO && strcmp(status.message, "state: its state is of another step") == 0, "%s",
            status.message);
  forge_head("state", -1, 1);
  cr_expect_not(checkpoint_examine("state", 1, &head, &status));
  cr_expect(strstr(status.message, "another order of bytes"), "%s", status.message);
  simulation_destroy(simulation);
  simulation_destroy(other);
  shell_leave();
}

Test(checkpoint, of_a_case_in_other_units_is_of_another_case)
{
  struct scene scene = scene_crowd(100, 100, 7, 16, 0.9);
  const struct units units[] = {{0}, {1e-4, 1e-3, 0}, {2e-4, 1e-3, 0}, {1e-4, 2e-3, 0}, {1e-4, 1e-3, 1000}};
  enum { COUNT = sizeof units / sizeof units[0] };
  uint32_t sums[COUNT];
  struct status status;
  for (int k = 0; k < COUNT; k++) {
    scene.units = units[k];
    cr_assert(case_fingerprint(&scene, &sums[k], &status));
    for (int before = 0; before < k; before++) cr_expect_neq(sums[k], sums[before], "%d and %d", before, k);
  }
  scene_clear(&scene);
}

/* From here on from outside. */
TestSuite(resume, .init = shell_enter, .fini = shell_leave, .timeout = 120 * SLOWNESS);

/* Discs that fall and collide with each other and the walls; frames and rows at different steps. */
static const char *const crowd = "title: crowd\n"
                                 "domain: {size: [200, 180]}\n"
                                 "fluid: {viscosity: 0.03}\n"
                                 "particles:\n"
                                 "  density: 1.3\n"
                                 "  gravity: [1e-5, -4e-4]\n"
                                 "  fill: {pattern: jittered-grid, spacing: 20, radius: 9.2, jitter: 1, seed: 5}\n"
                                 "run: {steps: 1501}\n"
                                 "output:\n"
                                 "  every: 50\n"
                                 "  checkpoint: {every: 97}\n"
                                 "  series: {every: 30}\n"
#ifdef DELBM_PNG
                                 "  frames: {every: 400, discs: height}\n"
#endif
#ifdef DELBM_HDF5
                                 "  fields: {every: 40, region: [20, 10, 121, 90], stride: 3}\n"
#endif
    ;

/* Compares the folders `whole` and `cut`, but for the run time. */
static const char *const compare =
    "cmp whole/particles.csv cut/particles.csv && cmp whole/series.csv cut/series.csv && cmp whole/case.yaml "
    "cut/case.yaml && "
    "{ test ! -e whole/frames || diff -r whole/frames cut/frames; } && "
    "{ test ! -e whole/fields.h5 || { cmp whole/fields.h5 cut/fields.h5 && cmp whole/fields.xdmf cut/fields.xdmf; }; } "
    "&& "
    "for run in whole cut; do for k in 0 1; do "
    "printf '%d %d\\n' $(od -An -t d8 -j 24 -N 8 $run/checkpoint.$k) $k; done | sort -n | tail -n 1 | "
    "{ read -r step k; head -c -108 $run/checkpoint.$k >$run.state; }; done; cmp whole.state cut.state && "
    "for key in steps mass_drift max_mach max_substeps max_overlap; do "
    "test \"$(grep $key whole/run.json)\" = \"$(grep $key cut/run.json)\" || exit 1; done";

/* 108 bytes: stage_times, and behind them a mark, struct run_record and the checksum. */
_Static_assert(sizeof(struct stage_times) + 16 + sizeof(struct run_record) + 4 == 108, "what `compare` cuts off");

Test(resume, after_kills_at_any_moment_the_files_equal_an_unbroken_run)
{
  shell_write("crowd.yaml", crowd);
  cr_assert_eq(shell("OMP_NUM_THREADS=2 $DELBM run crowd.yaml --quiet --out whole >/dev/null"), 0);
  for (int seed = 1; seed <= 3; seed++) {
    /* kills after 0.05 to 0.3 s, later at each attempt, until a run completes */
    cr_assert_eq(shell("RANDOM=%d; export RANDOM; rm -rf cut; n=0; r=%d; go=\"run crowd.yaml --out cut\"; "
                       "while :; do n=$((n + 1)); r=$(((r * 1103515245 + 12345) %% 2147483648)); "
                       "OMP_NUM_THREADS=$((1 + n %% 3)) $DELBM $go --quiet >/dev/null 2>err & p=$!; "
                       "sleep $(awk \"BEGIN { print (0.05 + 0.25 * $r / 2147483648) * (1 + $n / 20) }\"); "
                       "kill -KILL $p 2>/dev/null; wait $p && break; "
                       "ls cut/checkpoint.[01] >/dev/null 2>&1 && go=\"resume cut\"; test $n -lt 200 || exit 9; done; "
                       "test $n -gt 2 || exit 8",
                       seed, seed * 7919),
                 0);
    cr_expect_eq(shell("%s", compare), 0, "seed %d", seed);
  }
}

/* The exit code of a run that gets a signal after its first rows, when the handler is installed. */
static int stop(const char *signal, const char *command)
{
  return shell("rows() { cat cut/particles.csv 2>/dev/null | wc -l; }; n=$(rows); "
               "$DELBM %s --quiet >out 2>err & p=$!; "
               "while kill -0 $p && test $(rows) -le $((n + 1)); do sleep 0.01; done; kill -%s $p; wait $p",
               command, signal);
}

Test(resume, after_signals_goes_on_and_their_exit_codes_differ)
{
  shell_write("crowd.yaml", crowd);
  cr_assert_eq(shell("$DELBM run crowd.yaml --quiet --out whole >/dev/null"), 0);
  cr_expect_eq(stop("INT", "run crowd.yaml --out cut"), 130);
  cr_expect_eq(shell("grep -q 'interrupted at step .*delbm resume cut' err && grep -q status=interrupted out && "
                     "grep -q '\"status\": \"interrupted\"' cut/run.json"),
               0);
  cr_expect_eq(shell("grep -q 'interrupted by SIGINT' cut/run.json"), 0);
  cr_expect_eq(stop("TERM", "resume cut"), 143);
  cr_expect_eq(shell("grep -q 'interrupted by SIGTERM' cut/run.json"), 0);
  cr_expect_eq(stop("HUP", "resume cut"), 129);
  cr_expect_eq(shell("grep -q 'interrupted by SIGHUP' cut/run.json"), 0);
  cr_expect_eq(shell("$DELBM resume cut >out 2>err && grep -q 'resuming cut at step' err && grep -q steps=1501 out"),
               0);
  cr_expect_eq(shell("%s", compare), 0);
}

Test(resume, after_a_terminal_has_closed_goes_on_however_often_it_says_so)
{
  shell_write("crowd.yaml", crowd);
  cr_expect_eq(stop("HUP $p; kill -HUP $p 2>/dev/null; kill -HUP", "run crowd.yaml --out cut"), 129);
  cr_expect_eq(shell("grep -q 'interrupted at step' err && $DELBM resume cut --quiet >/dev/null"), 0);
}

Test(resume, is_not_needed_under_nohup)
{
  shell_write("crowd.yaml", crowd);
  setenv("DELBM", "nohup " DELBM, 1);
  cr_expect_eq(stop("HUP", "run crowd.yaml --out cut"), 0);
  cr_expect_eq(shell("grep -q 'status=done steps=1501' out"), 0);
}

Test(resume, without_regular_checkpoints_leaves_none_behind)
{
  shell_write("crowd.yaml", crowd);
  cr_expect_eq(stop("INT", "run crowd.yaml --set output.checkpoint.every=0 --out cut"), 130);
  cr_expect_eq(shell("ls cut/checkpoint.0 >/dev/null && $DELBM resume cut --quiet >/dev/null"), 0);
  cr_expect_eq(shell("ls cut/checkpoint.* cut/fields 2>/dev/null"), 2);
  cr_expect_eq(shell("$DELBM resume cut 2>err"), 4);
  cr_expect_eq(shell("grep -q 'nothing to resume: cut contains no checkpoint' err"), 0);
}

Test(resume, extends_a_finished_run)
{
  shell_write("crowd.yaml", crowd);
  cr_assert_eq(shell("$DELBM run crowd.yaml --quiet --out whole >/dev/null"), 0);
  cr_assert_eq(shell("$DELBM run crowd.yaml --set run.steps=777 --quiet --out cut >/dev/null && "
                     "$DELBM resume cut --steps 1501 --quiet >/dev/null"),
               0);
  cr_expect_eq(shell("%s", compare), 0);
  cr_expect_eq(shell("$DELBM resume cut --steps 100 2>err"), 3);
  cr_expect_eq(shell("$DELBM resume cut --steps=-1 2>err"), 3);
}

Test(resume, refuses_what_is_damaged_or_foreign_and_says_why)
{
  shell_write("crowd.yaml", crowd);
  cr_assert_eq(shell("$DELBM run crowd.yaml --quiet --out whole >/dev/null && cp -r whole good"), 0);
  /* the newer of two checkpoints is damaged: the older is used, with the same end */
  cr_assert_eq(
      shell("cp -r good cut; newer=$(for k in 0 1; do "
            "printf '%%d %%d\\n' $(od -An -t d8 -j 24 -N 8 good/checkpoint.$k) $k; done | sort -n | tail -n 1); "
            "echo ${newer#* } >newer; "
            "printf x | dd of=cut/checkpoint.${newer#* } bs=1 seek=200000 conv=notrunc 2>/dev/null; "
            "$DELBM resume cut --quiet >/dev/null 2>err"),
      0);
  cr_expect_eq(
      shell("grep -q \"refused checkpoint cut/checkpoint.$(cat newer): damaged or incomplete: its checksum does not "
            "match; using the other one\" err"),
      0);
  cr_expect_eq(shell("%s", compare), 0);
  /* cut short, and not a checkpoint at all */
  cr_expect_eq(shell("truncate -s -1 cut/checkpoint.1; echo hello >cut/checkpoint.0; $DELBM resume cut 2>err"), 4);
  cr_expect_eq(shell("grep -q 'checkpoint.1: damaged or incomplete' err"), 0);
  cr_expect_eq(shell("rm cut/checkpoint.1; $DELBM resume cut 2>err"), 4);
  cr_expect_eq(shell("grep -q 'cut/checkpoint.0: not a checkpoint of delbm' err"), 0);
  /* of another case */
  cr_assert_eq(shell("$DELBM run crowd.yaml --set fluid.viscosity=0.031 --quiet --out other >/dev/null; "
                     "cp other/checkpoint.0 cut/; $DELBM resume cut 2>err"),
               4);
  cr_expect_eq(
      shell("grep -q 'cut/checkpoint.0: of another case: domain, fluid, units, coupling, particles or contact differ' "
            "err"),
      0);
  /* of another format, found before the checksum is */
  cr_expect_eq(shell("cp good/checkpoint.0 cut/; printf '\\77' | dd of=cut/checkpoint.0 bs=1 seek=12 conv=notrunc "
                     "2>/dev/null; $DELBM resume cut 2>err"),
               4);
  cr_expect_eq(shell("grep -q 'cut/checkpoint.0: of format 63; this delbm .* reads format [0-9]*' err"), 0);
  /* the table was truncated */
  cr_expect_eq(shell("cp good/checkpoint.0 cut/; truncate -s 100 cut/particles.csv; $DELBM resume cut 2>err"), 4);
  cr_expect_eq(shell("grep -q 'cut/particles.csv has 100 bytes, fewer than' err"), 0);
}

Test(resume, and_run_keep_out_of_a_folder_in_use)
{
  shell_write("crowd.yaml", crowd);
  cr_expect_eq(
      shell("$DELBM run crowd.yaml --set run.steps=100000000 --quiet --out cut >/dev/null 2>&1 & p=$!; sleep 0.4; "
            "$DELBM resume cut 2>err1; a=$?; $DELBM run crowd.yaml --out cut 2>err2; b=$?; kill $p; wait $p; "
            "test $a = 4 -a $b = 4"),
      0);
  cr_expect_eq(
      shell("grep -q 'another delbm is running in cut' err1 && grep -q 'another delbm is running in cut' err2"), 0);
}
