/* The paper's cases, smaller and shorter than in cases/reproduce, from outside. Results are compared with published
 * or independent values (cases/NAME/reference.csv). */
#include "shell.h"

#include <math.h>

TestSuite(validation, .init = shell_enter, .fini = shell_leave, .timeout = 900 * SLOWNESS);

/* Runs a case of the source with further settings, results into folder `out`. */
static void run(const char *out, const char *name, const char *settings)
{
  char command[1024];
  snprintf(command, sizeof command, "%s run %s/../cases/%s --quiet --out %s --set output.frames.every=0 %s >/dev/null",
           DELBM, TEST_DIR, name, out, settings);
  cr_assert_eq(system(command), 0, "%s", command);
}

/* A figure of `delbm analyse`; NAN if absent. */
static double figure(const char *out, const char *name)
{
  char command[256], line[256], key[64];
  double value, found = NAN;
  snprintf(command, sizeof command, "%s analyse %s", DELBM, out);
  FILE *report = popen(command, "r");
  cr_assert(report);
  while (fgets(line, sizeof line, report))
    if (sscanf(line, "%63s %lf", key, &value) == 2 && strcmp(key, name) == 0) found = value;
  cr_assert_eq(pclose(report), 0);
  return found;
}

static void expect_near(const char *what, double value, double reference, double percent)
{
  cr_expect(fabs(value / reference - 1) < percent / 100, "%s: %g, %+.2f %% off %g", what, value,
            100 * (value / reference - 1), reference);
}

/* Figures 10 and 11: a step is 5e-4 s. The start is published (cases/dkt/README.md). */
Test(validation, two_discs_draft_kiss_and_tumble_when_they_should)
{
  static const char *const forms[] = {"unified", "owen"};
  for (int k = 0; k < 2; k++) {
    char settings[256];
    snprintf(settings, sizeof settings,
             "--set coupling.form=%s --set 'particles.discs.0.position=[100,720]' --set "
             "'particles.discs.1.position=[97,680]' --set run.steps=4500 --set output.every=10",
             forms[k]);
    run(forms[k], "dkt", settings);
    expect_near("drafting", 5e-4 * figure(forms[k], "pair.draft_time"), 1.12, 5);
    expect_near("its velocity", 20 * figure(forms[k], "pair.draft_speed"), -1.704, 5);
    const double kiss = 5e-4 * figure(forms[k], "pair.kiss_time");
    cr_expect(kiss > 1.15 * 0.95 && kiss < 1.36 * 1.05, "%s: kissing at %g s", forms[k], kiss);
    expect_near("tumbling", 5e-4 * figure(forms[k], "pair.tumble_time"), 1.85, 5);
  }
}

/* Figures 7 and 8: the effect of side walls is proportional to the disc's diameter over the width; the extrapolated
 * drag must agree with a fixed cylinder at the same Reynolds number, 2.0001 at 20 to 1.7867 at 26. */
Test(validation, a_settling_disc_has_the_drag_of_a_cylinder)
{
  double excess[2];
  for (int k = 0; k < 2; k++) {
    const char *out = k ? "wide" : "narrow";
    run(out, "disc",
        k ? "--set 'domain.size=[600,1000]' --set 'particles.discs.0.position=[300.3,900]' --set run.steps=9000"
          : "--set 'domain.size=[300,1000]' --set 'particles.discs.0.position=[150.3,900]' --set run.steps=9000");
    const double re = figure(out, "body.reynolds");
    const double cylinder = exp(log(2.0001) + log(1.7867 / 2.0001) * log(re / 20) / log(26.0 / 20));
    cr_assert(re > 20 && re < 27, "Re %g", re);
    excess[k] = figure(out, "body.drag") / cylinder;
  }
  expect_near("drag over a cylinder's, in unbounded water", 2 * excess[1] - excess[0], 1, 5);
}

/* A disc of 0.25 cm, density 1.25, in a box of 2 x 6 cm, viscosity 0.1 cm^2/s: Reynolds number rho_s D U/mu of 17.27
 * at most (Glowinski et al. 2001; the set-up of Wan & Turek 2006). The fall has 15 diameters; the start takes a
 * third. One cell is 0.0125 cm, one step 1.5625e-4 s. */
Test(validation, a_short_fall_has_its_terminal_speed_found)
{
  shell_write("disc.yaml", "domain: {size: [160, 480]}\n"
                           "fluid: {viscosity: 0.1}\n"
                           "particles: {density: 1.25, gravity: [0, -1.916e-3], discs: [{radius: 10, position: [80, "
                           "320]}]}\n"
                           "run: {steps: 6000}\n"
                           "output: {every: 20}\n");
  cr_assert_eq(shell("%s run disc.yaml --quiet --out fall >/dev/null", DELBM), 0);
  expect_near("Reynolds number", 1.25 * figure("fall", "body.reynolds"), 17.27, 2);
  expect_near("terminal over largest speed", figure("fall", "body.speed") / figure("fall", "body.fastest"), 1, 1);
  cr_assert_eq(shell("%s run disc.yaml --set run.steps=2200 --quiet --out begun >/dev/null && %s analyse begun | "
                     "grep -q 'no terminal speed: still accelerating'",
                     DELBM, DELBM),
               0);
  cr_expect(isnan(figure("begun", "body.speed")));
}

/* Figure 9: drag and lift of R = 10 in a box of 40 R, less the effect of the box, which is proportional to 1/L:
 * twice the change for R = 5 from 40 R to 80 R. */
Test(validation, a_spinning_disc_is_lifted_and_dragged_as_computed_otherwise)
{
  static const char *const boxes[] = {"coarse", "large", "fine"};
  static const char *const settings[] = {
      "'domain.size=[200,200]' --set 'particles.discs.0.position=[80,100]' --set run.steps=22000",
      "'domain.size=[400,400]' --set 'particles.discs.0.position=[160,200]' --set run.steps=30000",
      "'domain.size=[400,400]' --set 'particles.discs.0.position=[160,200]' --set run.steps=30000"};
  const char *const finer = "--set particles.discs.0.radius=10 --set particles.discs.0.spin=0.002 --set "
                            "fluid.viscosity=0.02";
  double drag[3], lift[3];
  for (int k = 0; k < 3; k++) {
    char all[512];
    snprintf(all, sizeof all, "--set %s %s", settings[k], k == 2 ? finer : "");
    run(boxes[k], "spin", all);
    drag[k] = figure(boxes[k], "body.drag");
    lift[k] = -figure(boxes[k], "body.lift");
  }
  expect_near("C_D", drag[2] + 2 * (drag[1] - drag[0]), 1.8192, 3);
  expect_near("C_L", lift[2] + 2 * (lift[1] - lift[0]), 2.7316, 3);
}

/* Figures 12 to 15, 300 discs: Kynch's first mode, one jump between suspension and sediment. */
Test(validation, a_crowd_settles_with_a_straight_interface_onto_a_bed_that_takes_what_arrives)
{
  run("crowd", "settling", "--set 'domain.size=[300,400]' --set run.steps=34000 --set output.every=250");
  expect_near("R^2", figure("crowd", "settling.interface_r2"), 1, 1);
  expect_near("concentration at the start", figure("crowd", "settling.concentration"), M_PI / 16, 0.01);
  expect_near("rise of the sediment's surface",
              figure("crowd", "settling.front_speed") / figure("crowd", "settling.front_speed_kynch"), 1, 7);
  const double bed = figure("crowd", "settling.bed");
  /* concentration of the upper 100 cells of the full bed, under small load: 0.66 to 0.74 */
  cr_expect(bed > 0.65 && bed < 0.75, "concentration of the bed: %g", bed);
}

/* Figure 2: (11) in the limit of small overlap. */
Test(validation, fitted_overlap_areas_have_the_factor_of_their_radii)
{
  char command[256];
  snprintf(command, sizeof command, "%s bench overlap --quick --json overlap.json >/dev/null", DELBM);
  cr_assert_eq(system(command), 0);
  char *text = calloc(1, 1 << 16);
  FILE *file = fopen("overlap.json", "r");
  cr_assert(file && fread(text, 1, (1 << 16) - 1, file) > 0);
  fclose(file);
  int ratios = 0;
  double beta, factor, limit;
  for (const char *at = text; (at = strstr(at, "{\"beta\"")); at++, ratios++) {
    cr_assert_eq(sscanf(at, "{\"beta\": %lf, \"factor\": %lf, \"limit\": %lf", &beta, &factor, &limit), 3);
    expect_near("factor", factor, limit, 1);
  }
  cr_expect_eq(ratios, 6);
  free(text);
}
