/* A host of the library, in which every call of the C library fails in turn: `host-faulty memory | file` in a
 * writable folder. A failed call of the library must leave the simulation unchanged, so that the repeated call leads
 * to the same bits as a call that never failed; or in a state that can only be read or closed, and reports so. */
#include "faulty.h"

#include "delbm/delbm.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NX = 48, NY = 40, CELLS = NX * NY, DISCS = 5 };

static const char *const scene = "domain: {size: [48, 40], left: periodic, right: periodic}\n"
                                 "fluid: {viscosity: 0.05}\n"
                                 "particles:\n"
                                 "  density: 1.2\n"
                                 "  gravity: [0, -1e-3]\n"
                                 "  discs:\n"
                                 "    - {radius: 5, position: [10, 5.5]}\n"
                                 "    - {radius: 4, position: [19, 6.5]}\n"
                                 "    - {radius: 3, position: [30, 20], fixed: true}\n"
                                 "    - {radius: 2, position: [40, 30], driven: true}\n"
                                 "    - {radius: 2, position: [40, 10]}\n"
                                 "contact: {stiffness: 5}\n";

/* All that can be read. */
struct state {
  int64_t step;
  struct delbm_disc_state discs[DISCS];
  double density[CELLS], vx[CELLS], vy[CELLS], occupation[CELLS];
};

static void die(const char *what, const char *wish, const struct delbm_status *status)
{
  printf("%s, %s: %d %s\n", what, wish, status ? (int)status->code : 0, status ? status->message : "");
  exit(1);
}

static struct delbm_simulation *open_and_step(void)
{
  struct delbm_simulation *s;
  struct delbm_status status;
  if (delbm_open_text(&s, scene, NULL, 0, &status) || delbm_step(s, 7, &status)) die("open", "nothing fails", &status);
  return s;
}

static void read_state(struct delbm_simulation *s, struct state *state)
{
  struct delbm_status status;
  memset(state, 0, sizeof *state);
  state->step = delbm_time(s);
  if (delbm_read_discs(s, 0, DISCS, state->discs, &status) ||
      delbm_read_field(s, DELBM_DENSITY, state->density, &status) ||
      delbm_read_field(s, DELBM_VELOCITY_X, state->vx, &status) ||
      delbm_read_field(s, DELBM_VELOCITY_Y, state->vy, &status) ||
      delbm_read_field(s, DELBM_OCCUPATION, state->occupation, &status))
    die("read", "nothing fails", &status);
}

static enum delbm_code step(struct delbm_simulation *s, struct delbm_status *status)
{
  return delbm_step(s, 5, status);
}

/* Moves all discs to the top, where the bands' arrays must then grow. */
static enum delbm_code write_discs(struct delbm_simulation *s, struct delbm_status *status)
{
  static const double x[DISCS] = {8, 19.5, 28.5, 36, 43};
  struct delbm_disc_state discs[DISCS];
  delbm_read_discs(s, 0, DISCS, discs, NULL);
  for (int k = 0; k < DISCS; k++) discs[k].position[0] = x[k], discs[k].position[1] = 33;
  return delbm_write_discs(s, 0, DISCS, discs, status);
}

static enum delbm_code write_fluid(struct delbm_simulation *s, struct delbm_status *status)
{
  static double density[CELLS], rest[CELLS];
  for (int k = 0; k < CELLS; k++) density[k] = 1 + 0.01 * sin(0.1 * k);
  return delbm_write_fluid(s, density, rest, rest, status);
}

static enum delbm_code read_occupation(struct delbm_simulation *s, struct delbm_status *status)
{
  static double values[CELLS];
  return delbm_read_field(s, DELBM_OCCUPATION, values, status);
}

static void faster(void *context, int64_t at, const struct delbm_disc_state *now, double velocity[2], double *spin)
{
  (void)context, (void)now, (void)spin;
  velocity[0] = 1e-3 * (double)at;
}

static enum delbm_code drive(struct delbm_simulation *s, struct delbm_status *status)
{
  return delbm_drive(s, 3, faster, NULL, status);
}

static enum delbm_code save(struct delbm_simulation *s, struct delbm_status *status)
{
  return delbm_save(s, "saved", status);
}

static enum delbm_code load(struct delbm_simulation *s, struct delbm_status *status)
{
  return delbm_load(s, "given", status);
}

static const struct operation {
  const char *name;
  enum delbm_code (*call)(struct delbm_simulation *s, struct delbm_status *status);
  bool may_end; /* a failure may end the simulation */
  enum delbm_code (*before)(struct delbm_simulation *s, struct delbm_status *status); /* NULL: nothing */
} operations[] = {{.name = "step", .call = step, .may_end = true, .before = write_discs},
                  {.name = "write discs", .call = write_discs},
                  {.name = "write fluid", .call = write_fluid},
                  {.name = "read", .call = read_occupation},
                  {.name = "drive", .call = drive},
                  {.name = "save", .call = save},
                  {.name = "load", .call = load, .may_end = true}};

/* A simulation that has ended reports so at each call, and can be closed. */
static void check_ended(struct delbm_simulation *s, const char *name, const char *wish)
{
  struct delbm_status first, second;
  read_occupation(s, &first); /* if there is a state, it can be read */
  if (delbm_step(s, 1, &first) == DELBM_OK || delbm_save(s, "ended", &second) == DELBM_OK) die(name, wish, NULL);
  if (strcmp(first.message, second.message) != 0) die(name, wish, &second);
}

static struct delbm_simulation *prepare(const struct operation *operation)
{
  struct delbm_simulation *s = open_and_step();
  struct delbm_status status;
  if (operation->before && operation->before(s, &status)) die(operation->name, "nothing fails", &status);
  return s;
}

/* Lets a call of an operation fail; false when there is none of that number. */
static bool try_call(const struct operation *operation, const char *kind, int number, const struct state *expected)
{
  static struct state before, after;
  char wish[32];
  struct delbm_status status;
  struct delbm_simulation *s = prepare(operation);
  snprintf(wish, sizeof wish, "%s %d", kind, number);
  read_state(s, &before);
  faulty_begin(wish);
  const enum delbm_code code = operation->call(s, &status);
  const bool failed = faulty_end();
  if (code != DELBM_OK && (!failed || strlen(status.message) == 0)) die(operation->name, wish, &status);
  struct delbm_status again = {DELBM_OK, ""};
  if (code != DELBM_OK) {
    if (!operation->may_end) read_state(s, &after);
    if (!operation->may_end && memcmp(&before, &after, sizeof before) != 0) die("as it was", wish, &status);
    operation->call(s, &again);
  }
  if (again.code == DELBM_OK) {
    if (delbm_step(s, 5, &again) != DELBM_OK) die(operation->name, wish, &again);
    read_state(s, &after);
    if (memcmp(expected, &after, sizeof after) != 0) die("the same bits", wish, &again);
  } else {
    if (!operation->may_end) die(operation->name, wish, &again);
    check_ended(s, operation->name, wish);
  }
  delbm_close(s);
  return failed;
}

/* By default a sample of the calls, where they are many: reading YAML, writing rows of a field. */
static int stride_of(int stride)
{
  return getenv("DELBM_EVERY_CALL") ? 1 : stride;
}

static void try_operation(const struct operation *operation, const char *kind)
{
  static struct state expected;
  struct delbm_status status;
  struct delbm_simulation *s = prepare(operation);
  if (operation->call(s, &status) || delbm_step(s, 5, &status)) die(operation->name, "nothing fails", &status);
  read_state(s, &expected);
  delbm_close(s);
  int number = 1;
  while (try_call(operation, kind, number, &expected)) number += number < 20 ? 1 : stride_of(23);
}

/* A failed opening leaves *simulation NULL. */
static void try_opening(const char *kind)
{
  const int stride = stride_of(41);
  for (int number = 1;; number += stride) {
    struct delbm_simulation *s;
    struct delbm_status status;
    char wish[32];
    snprintf(wish, sizeof wish, "%s %d", kind, number);
    faulty_begin(wish);
    const enum delbm_code code = delbm_open_text(&s, scene, NULL, 0, &status);
    const bool failed = faulty_end();
    if ((code != DELBM_OK) != (s == NULL) || (code != DELBM_OK && !failed)) die("open", wish, &status);
    delbm_close(s);
    if (!failed) return;
  }
}

int main(int argc, char **argv)
{
  if (argc != 2) return 2;
  struct delbm_simulation *s = open_and_step();
  struct delbm_status status;
  if (delbm_step(s, 6, &status) || delbm_save(s, "given", &status)) die("save", "nothing fails", &status);
  delbm_close(s);
  try_opening(argv[1]);
  for (size_t k = 0; k < sizeof operations / sizeof operations[0]; k++) try_operation(&operations[k], argv[1]);
  return 0;
}
