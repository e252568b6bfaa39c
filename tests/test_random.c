/* Random scenes, many of them absurd: each is refused with a message that names its key, or it runs with mass and
 * momentum conserved and finite numbers, or it reports divergence. The seed is printed; DELBM_RANDOM_SEED sets it,
 * DELBM_RANDOM_SCENES the number of scenes. */
#include "case/case_file.h"
#include "drive.h"
#include "scenes.h"

#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

static double between(gsl_rng *random, double low, double high)
{
  return low + (high - low) * gsl_rng_uniform(random);
}

static bool chance(gsl_rng *random, double of)
{
  return gsl_rng_uniform(random) < of;
}

static const char *one_of(gsl_rng *random, const char *const words[], size_t count)
{
  return words[gsl_rng_uniform_int(random, count)];
}

#define ONE_OF(random, ...)                                                                                            \
  one_of(random, (const char *const[]){__VA_ARGS__}, sizeof((const char *const[]){__VA_ARGS__}) / sizeof(const char *))

/* Writes a number, rarely an absurd one. */
static void put_number(FILE *to, gsl_rng *random, double number, double absurd)
{
  if (chance(random, absurd))
    fputs(ONE_OF(random, "0", "-1", "-0.0", ".nan", "nan", ".inf", "1e300", "-1e300", "1e-300", "5e-324", "1e999", "~"),
          to);
  else
    fprintf(to, "%.17g", number);
}

static void put_point(FILE *to, gsl_rng *random, const char *key, double x, double y, double absurd)
{
  fprintf(to, "%s: [", key);
  put_number(to, random, x, absurd);
  fputs(", ", to);
  put_number(to, random, y, absurd);
  fputs("]", to);
}

/* Absurdity and size of a scene. */
struct mood {
  double absurd;
  int nx, ny;
};

static void put_domain(FILE *to, gsl_rng *random, const struct mood *mood)
{
  const bool stream = chance(random, 0.1);
  const char *x = stream ? "inlet" : ONE_OF(random, "wall", "periodic"), *y = ONE_OF(random, "wall", "periodic");
  fprintf(to, "domain:\n  size: [%d, %d]\n", mood->nx, mood->ny);
  if (stream)
    fprintf(to, "  left: {type: inlet, velocity: [%.3g, 0]}\n  right: outlet\n", between(random, 0, 0.1));
  else
    fprintf(to, "  left: %s\n  right: %s\n", x, x);
  if (strcmp(y, "wall") == 0 && chance(random, 0.3))
    fprintf(to, "  top: {type: wall, velocity: [%.3g, 0]}\n", between(random, -0.2, 0.2));
  else
    fprintf(to, "  top: %s\n", y);
  fprintf(to, "  bottom: %s\n", chance(random, mood->absurd) ? "outlet" : y);
}

static void put_fluid(FILE *to, gsl_rng *random, const struct mood *mood)
{
  fputs("fluid:\n  viscosity: ", to);
  put_number(to, random, pow(10, between(random, -2.5, 0)), mood->absurd);
  fprintf(to, "\n  collision: %s\n", ONE_OF(random, "bgk", "trt", "mrt"));
  fprintf(to, "  precision: %s\n  ", chance(random, 0.2) ? "single" : "double");
  const double force = chance(random, 0.5) ? between(random, 0, 1e-4) : 0;
  put_point(to, random, "force", force, 0, mood->absurd);
  fprintf(to, "\ncoupling: {form: %s, solve: %s", ONE_OF(random, "owen", "unified"),
          chance(random, 0.2) ? "explicit-averaged" : "implicit");
  if (chance(random, 0.2)) {
    fputs(", hydraulic_radius: ", to);
    put_number(to, random, between(random, 0.5, 1), mood->absurd);
  }
  fputs("}\n", to);
}

static void put_disc(FILE *to, gsl_rng *random, const struct mood *mood)
{
  const double most = fmin(mood->nx, mood->ny) / 2.0, out = chance(random, mood->absurd) ? 2 : 0;
  fputs("    - {radius: ", to);
  put_number(to, random, fmax(0.5, most * pow(gsl_rng_uniform(random), 2)), mood->absurd);
  const bool coincident = chance(random, 0.2);
  fputs(", ", to);
  put_point(to, random, "position", coincident ? mood->nx / 2 : between(random, -out, mood->nx + out),
            coincident ? mood->ny / 2 : between(random, -out, mood->ny + out), mood->absurd);
  if (chance(random, 0.5)) {
    fputs(", density: ", to);
    put_number(to, random, pow(10, between(random, -0.5, 1)), mood->absurd);
  }
  if (chance(random, 0.3)) {
    fputs(", ", to);
    put_point(to, random, "velocity", between(random, -0.05, 0.05), between(random, -0.05, 0.05), mood->absurd);
  }
  if (chance(random, 0.3)) {
    fputs(", spin: ", to);
    put_number(to, random, between(random, -0.002, 0.002), mood->absurd);
  }
  if (chance(random, 0.3)) fprintf(to, ", %s: true", ONE_OF(random, "fixed", "driven"));
  fputs("}\n", to);
}

static void put_particles(FILE *to, gsl_rng *random, const struct mood *mood)
{
  const unsigned long count = gsl_rng_uniform_int(random, 6);
  fputs("particles:\n  density: 1.2\n  ", to);
  put_point(to, random, "gravity", 0, -between(random, 0, 1e-3), mood->absurd);
  fputs("\n", to);
  if (chance(random, 0.2)) {
    fputs("  fill: {spacing: ", to);
    put_number(to, random, between(random, 4, 12), mood->absurd);
    fputs(", radius: ", to);
    put_number(to, random, between(random, 1, 2), mood->absurd);
    fputs("}\n", to);
  }
  if (count > 0) fputs("  discs:\n", to);
  for (unsigned long k = 0; k < count; k++) put_disc(to, random, mood);
}

static void put_scene(FILE *to, gsl_rng *random)
{
  const struct mood mood = {
      .absurd = chance(random, 0.5) ? 0.04 : 0, .nx = (int)between(random, 1, 50), .ny = (int)between(random, 1, 50)};
  put_domain(to, random, &mood);
  put_fluid(to, random, &mood);
  put_particles(to, random, &mood);
  fputs("contact: {stiffness: ", to);
  put_number(to, random, pow(10, between(random, -2, 1)), mood.absurd);
  fprintf(to, ", area: %s, damping: ", ONE_OF(random, "lens", "cells"));
  put_number(to, random, between(random, 0, 1), mood.absurd);
  fprintf(to, ", search: %s}\nrun: {steps: 60, check: 20}\n", chance(random, 0.2) ? "linked-cell" : "grid");
}

enum fate { REFUSED, DIVERGED, HELD };

static void expect_key_named(const struct case_errors *errors, const char *text)
{
  for (size_t k = 0; k < errors->count; k++) {
    const char *key = strstr(errors->lines[k], ": ");
    const bool named = key && (strncmp(key, ": domain", 8) == 0 || strncmp(key, ": fluid", 7) == 0 ||
                               strncmp(key, ": coupling", 10) == 0 || strncmp(key, ": particles", 11) == 0 ||
                               strncmp(key, ": contact", 9) == 0);
    cr_expect(named, "no key in: %s\n%s", errors->lines[k], text);
  }
}

static void expect_finite(struct simulation *simulation, const char *text)
{
  const struct discs *discs = simulation_discs(simulation);
  const size_t cells = (size_t)scene_cells(simulation_scene(simulation));
  double *field = malloc(3 * cells * sizeof *field), sum = 0;
  cr_assert(field);
  simulation_fields(simulation, field, field + cells, field + 2 * cells);
  for (size_t k = 0; k < 3 * cells; k++) sum += fabs(field[k]);
  for (size_t i = 0; i < discs->count; i++)
    sum += fabs(discs->x[i]) + fabs(discs->y[i]) + fabs(discs->vx[i]) + fabs(discs->vy[i]) + fabs(discs->omega[i]) +
           fabs(discs->fx[i]) + fabs(discs->fy[i]) + fabs(discs->torque[i]) + fabs(discs->contact_fx[i]);
  cr_expect(isfinite(sum), "not finite:\n%s", text);
  free(field);
}

static bool has_outlet(const struct scene *scene)
{
  for (int side = 0; side < SIDE_COUNT; side++)
    if (scene->domain.side[side].type == SIDE_OUTLET) return true;
  return false;
}

static void expect_held(struct simulation *simulation, const char *text)
{
  struct simulation_report report;
  const struct scene *scene = simulation_scene(simulation);
  const double least = scene->fluid.precision == PRECISION_SINGLE ? 1e-5 : 1e-13;
  simulation_report(simulation, &report);
  if (!has_outlet(scene)) cr_expect_leq(report.mass_drift, least, "mass drifts by %g:\n%s", report.mass_drift, text);
  if (!isnan(report.momentum_drift))
    cr_expect_leq(report.momentum_drift, least, "momentum drifts by %g:\n%s", report.momentum_drift, text);
}

static enum fate run(const struct scene *scene, const char *text)
{
  struct status status;
  struct simulation *simulation = start(scene);
  const bool done = simulation_advance(simulation, scene->run.steps, &status) && simulation_check(simulation, &status);
  if (done) {
    expect_finite(simulation, text);
    expect_held(simulation, text);
  } else {
    cr_expect_eq(status.code, DELBM_FAILED);
    cr_expect(strlen(status.message) > 20);
  }
  simulation_destroy(simulation);
  return done ? HELD : DIVERGED;
}

/* Reads and runs a case in a text. */
static enum fate try_case(const char *text)
{
  char path[64];
  struct scene scene;
  struct case_errors errors = {0};
  struct status status;
  enum fate fate = REFUSED;
  const int descriptor = memfd_create("case", 0);
  cr_assert(descriptor >= 0 && write(descriptor, text, strlen(text)) == (ssize_t)strlen(text));
  snprintf(path, sizeof path, "/proc/self/fd/%d", descriptor);
  if (case_read(&scene, path, NULL, 0, &errors, &status)) {
    fate = run(&scene, text);
    scene_clear(&scene);
  } else {
    cr_expect_eq(status.code, DELBM_INVALID, "%s\n%s", status.message, text);
    expect_key_named(&errors, text);
  }
  case_errors_clear(&errors);
  close(descriptor);
  return fate;
}

static unsigned long wish(const char *name, unsigned long fallback)
{
  const char *given = getenv(name);
  return given ? strtoul(given, NULL, 10) : fallback;
}

Test(random, scenes_conserve_mass_and_momentum_or_are_refused_by_key_or_diverge_with_words, .timeout = 60 * SLOWNESS)
{
  const unsigned long seed = wish("DELBM_RANDOM_SEED", 1), scenes = wish("DELBM_RANDOM_SCENES", 400);
  unsigned long fates[3] = {0};
  gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(random, seed);
  for (unsigned long k = 0; k < scenes; k++) {
    char *text;
    size_t size;
    FILE *to = open_memstream(&text, &size);
    put_scene(to, random);
    fclose(to);
    fates[try_case(text)]++;
    free(text);
  }
  gsl_rng_free(random);
  fprintf(stderr, "seed %lu: of %lu scenes %lu refused, %lu diverged, %lu held\n", seed, scenes, fates[REFUSED],
          fates[DIVERGED], fates[HELD]);
  cr_expect_gt(fates[HELD], scenes / 5);
  cr_expect_gt(fates[REFUSED], scenes / 5);
}

Test(fill, displaces_discs_evenly_to_all_sides_by_up_to_the_jitter)
{
  struct scene scene = scene_crowd(400, 400, 2, 10, 1.5);
  double mean[2] = {0, 0}, least = 0, most = 0;
  cr_assert_eq(scene.particles.count, 1600);
  for (size_t i = 0; i < 1600; i++) {
    const size_t place[2] = {i % 40, i / 40};
    for (int axis = 0; axis < 2; axis++) {
      const double by = scene.particles.discs[i].position[axis] - 10 * ((double)place[axis] + 0.5);
      mean[axis] += by / 1600;
      least = fmin(least, by);
      most = fmax(most, by);
    }
  }
  /* of a mean the standard deviation is 1.5/sqrt(3 * 1600) = 0.022 */
  cr_expect(fabs(mean[0]) < 0.09 && fabs(mean[1]) < 0.09, "by (%g, %g) in the mean", mean[0], mean[1]);
  cr_expect(least >= -1.5 && least < -1.45 && most <= 1.5 && most > 1.45, "from %g to %g", least, most);
  scene_clear(&scene);
}
