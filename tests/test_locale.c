/* A host, or a process, whose locale has a decimal comma: numbers are read and written with a point, and the locale
 * of the host is unchanged. The locale is compiled here from the sources in Debian's package `locales`. */
#include "shell.h"

#include "delbm/delbm.h"

#include <locale.h>
#include <omp.h>

static const char *const german = "de_DE.UTF-8";

/* A temporary folder with the locale. */
static void enter(void)
{
  shell_enter();
  if (shell("mkdir locales; localedef -i de_DE -f UTF-8 locales/%s >log 2>&1", german) != 0)
    cr_skip_test("the locale cannot be made (Debian: locales)");
  char path[256];
  snprintf(path, sizeof path, "%s/locales", shell_folder);
  setenv("LOCPATH", path, 1);
}

TestSuite(locales, .init = enter, .fini = shell_leave, .timeout = 100 * SLOWNESS);

static bool has_comma(void)
{
  char text[8];
  snprintf(text, sizeof text, "%.1f", 0.5);
  return strcmp(text, "0,5") == 0;
}

static const char *const crowd = "domain: {size: [120, 100], left: periodic, right: periodic}\n"
                                 "fluid: {viscosity: 0.03, force: [1e-5, 0]}\n"
                                 "particles:\n"
                                 "  density: 1.3\n"
                                 "  gravity: [0, -4e-4]\n"
                                 "  discs:\n"
                                 "    - {radius: 6.5, position: [30.25, 80], driven: true, velocity: [0.01, 0]}\n"
                                 "    - {radius: 7, position: [90, 20.5]}\n";

static const struct delbm_disc disc = {.radius = 6.5, .density = 1.25, .position = {30.5, 40.25}, .angle = 0.125};
static const struct delbm_scene scene = {.size = {80, 70},
                                         .top = {DELBM_WALL, {0.0125, 0}},
                                         .viscosity = 0.03125,
                                         .force = {1.5e-6, 0},
                                         .discs = &disc,
                                         .disc_count = 1};

static void ask(void *context, int64_t step, const struct delbm_disc_state *now, double velocity[2], double *spin)
{
  (void)step, (void)now, (void)spin;
  velocity[0] = 0.0125;
  *(int *)context += has_comma();
}

/* A disc of the text's case, and of the struct's, after some steps; calls of the callback with a comma are counted. */
struct outcome {
  struct delbm_disc_state of_text, of_scene;
  int commas;
};

static struct outcome use(const char *load, const char *save)
{
  const char *const settings[] = {"contact.stiffness=0.5", "fluid.viscosity=0.0325"};
  struct outcome outcome = {0};
  struct delbm_simulation *a, *b;
  struct delbm_status status;
  cr_assert_eq(delbm_open_text(&a, crowd, settings, 2, &status), DELBM_OK, "%s", status.message);
  cr_assert_eq(delbm_open_scene(&b, &scene, settings, 1, &status), DELBM_OK, "%s", status.message);
  if (load) cr_assert_eq(delbm_load(a, load, &status), DELBM_OK, "%s", status.message);
  delbm_drive(a, 0, ask, &outcome.commas, NULL);
  cr_assert_eq(delbm_step(a, 10, &status), DELBM_OK, "%s", status.message);
  cr_assert_eq(delbm_step(b, 10, &status), DELBM_OK, "%s", status.message);
  if (save) cr_assert_eq(delbm_save(a, save, &status), DELBM_OK, "%s", status.message);
  delbm_read_discs(a, 1, 1, &outcome.of_text, NULL);
  delbm_read_discs(b, 0, 1, &outcome.of_scene, NULL);
  delbm_close(a);
  delbm_close(b);
  return outcome;
}

Test(locales, of_the_host_change_no_result_and_stay_as_they_are)
{
  const struct outcome first = use(NULL, "first"), second = use("first", NULL);
  cr_expect_eq(first.commas + second.commas, 0);
  cr_assert(setlocale(LC_ALL, german) && has_comma());
  const struct outcome german_first = use(NULL, "german"), german_second = use("first", NULL);
  cr_expect(has_comma());
  cr_expect_eq(german_first.commas + german_second.commas, 20, "a callback is called in the host's locale");
  cr_assert(setlocale(LC_ALL, "C"));
  const struct outcome loaded = use("german", NULL);
  cr_expect_eq(memcmp(&first.of_text, &german_first.of_text, sizeof first.of_text), 0);
  cr_expect_eq(memcmp(&first.of_scene, &german_first.of_scene, sizeof first.of_scene), 0);
  cr_expect_eq(memcmp(&second.of_text, &german_second.of_text, sizeof second.of_text), 0, "saved with a point");
  cr_expect_eq(memcmp(&second.of_text, &loaded.of_text, sizeof second.of_text), 0, "saved with a comma");
}

Test(locales, of_the_host_do_not_change_messages)
{
  struct delbm_simulation *s;
  struct delbm_status status;
  cr_assert(setlocale(LC_ALL, german));
  cr_expect_eq(delbm_open_text(&s, "domain: {size: [20, 20]}\nfluid: {viscosity: -0.5}\n", NULL, 0, &status),
               DELBM_INVALID);
  cr_expect(strstr(status.message, "fluid.viscosity: got -0.5; expected a number > 0"), "%s", status.message);
  cr_assert_eq(delbm_open_text(&s, crowd, NULL, 0, &status), DELBM_OK, "%s", status.message);
  struct delbm_disc_state state;
  delbm_read_discs(s, 1, 1, &state, NULL);
  state.spin = 0.25;
  cr_expect_eq(delbm_write_discs(s, 1, 1, &state, &status), DELBM_USAGE);
  cr_expect(strstr(status.message, "velocity (0, 0), spin 0.25: |velocity|"), "%s", status.message);
  cr_expect_eq(delbm_load(s, "nowhere", &status), DELBM_IO);
  cr_expect_str_eq(status.message, "cannot open nowhere: No such file or directory");
  delbm_close(s);
  cr_expect(has_comma());
}

/* The failure is caused by the last disc, in the last thread. */
Test(locales, of_the_host_do_not_change_messages_from_other_threads)
{
  struct delbm_simulation *s;
  struct delbm_status status;
  omp_set_num_threads(3);
  cr_assert(setlocale(LC_ALL, german));
  cr_assert_eq(delbm_open_text(&s,
                               "domain: {size: [160, 100], left: periodic, right: periodic}\nfluid: {viscosity: 0.1}\n"
                               "particles:\n"
                               "  density: 50\n"
                               "  gravity: [0.005, 0]\n"
                               "  discs:\n"
                               "    - {radius: 6, position: [30, 20], fixed: true}\n"
                               "    - {radius: 6, position: [30, 50], fixed: true}\n"
                               "    - {radius: 6, position: [30, 80], velocity: [0.29, 0]}\n",
                               NULL, 0, &status),
               DELBM_OK, "%s", status.message);
  cr_expect_eq(delbm_step(s, 100, &status), DELBM_FAILED);
  cr_expect(strstr(status.message, " disc 2 near (") && strstr(status.message, " moves at (0.3"), "%s", status.message);
  delbm_close(s);
}

/* The program in a process with a decimal comma: equal files and output. */
Test(locales, of_the_process_change_no_file_of_a_run)
{
  shell_write("case.yaml", "title: pair\n"
                           "units: {dx: 0.1 mm, viscosity: 0.05}\n"
                           "domain: {size: [7.2 mm, 6 mm]}\n"
                           "fluid: {viscosity: 1e-6 m^2/s}\n"
                           "particles:\n"
                           "  density: 1.25\n"
                           "  gravity: [0, -1e-4]\n"
                           "  discs: [{radius: 7.5, position: [30.5, 40]}, {radius: 6, position: [33.25, 20]}]\n"
                           "run: {steps: 200}\n"
                           "output:\n"
                           "  every: 5\n"
                           "  checkpoint: {every: 100}\n"
#ifdef DELBM_PNG
                           "  frames: {every: 100}\n"
#endif
#ifdef DELBM_HDF5
                           "  fields: {every: 100}\n"
#endif
  );
  setenv("DELBM_FAULTY", DELBM_FAULTY, 1);
  setenv("ASAN_OPTIONS", "detect_leaks=0", 1); /* with LOCPATH a library of HDF5 leaks at its start */
  cr_assert_eq(shell("uses() { $1 run case.yaml --quiet --set contact.stiffness=0.5 --out $2 >$2.out 2>&1 && "
                     "$1 resume $2 --steps 300 >$2.out 2>&1 && $1 info case.yaml >$2.info && "
                     "$1 analyse $2 --json $2.json --tables >$2.analysis && "
                     "{ $1 plot $2 >/dev/null 2>&1; cp $2/plots/case.gp $2.gp; }; }; "
                     "uses $DELBM point && mv point/plots point.plots && export DELBM_LOCALE=%s && "
                     "uses $DELBM_FAULTY comma && mv comma/plots comma.plots",
                     german),
               0);
  cr_expect_eq(
      shell("for f in info analysis json gp; do sed s/comma/point/g comma.$f | cmp - point.$f || exit 1; done"), 0);
  cr_expect_eq(
      shell("rm point/checkpoint.* comma/checkpoint.* && mv point/run.json . && mv comma/run.json comma.run && "
            "diff -r point comma"),
      0);
  cr_expect_eq(shell("grep -q '\"max_mach\": 0\\.[0-9]' comma.run && ! grep -E '[0-9],[0-9]' comma.run comma.out && "
                     "grep -q 'max_mach=0\\.[0-9]' comma.out"),
               0);
}
