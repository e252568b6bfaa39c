/* Two discs settle in a box, one above the other: a scene described in code, stepped, looked at, saved and taken up again.
 *
 *   cc settle.c $(pkg-config --cflags --libs delbm) && ./a.out
 */
#include <delbm/delbm.h>

#include <stdio.h>
#include <stdlib.h>

/* Ends the program on an error: the library itself only reports. */
static void check(enum delbm_code code, const struct delbm_status *status)
{
  if (code == DELBM_OK) return;
  fprintf(stderr, "%s\n", status->message);
  exit(code);
}

/* The fastest downward flow, and how many cells the discs cover. */
static void print_flow(struct delbm_simulation *simulation)
{
  struct delbm_status status;
  const size_t nx = (size_t)delbm_size(simulation, 0), ny = (size_t)delbm_size(simulation, 1);
  double *values = malloc(nx * ny * sizeof *values), fastest = 0, covered = 0;
  if (!values) exit(EXIT_FAILURE);
  check(delbm_read_field(simulation, DELBM_VELOCITY_Y, values, &status), &status);
  for (size_t j = 0; j < ny; j++)
    for (size_t i = 0; i < nx; i++)
      if (values[j * nx + i] < fastest) fastest = values[j * nx + i];
  check(delbm_read_field(simulation, DELBM_OCCUPATION, values, &status), &status);
  for (size_t k = 0; k < nx * ny; k++) covered += values[k];
  printf("fastest downward flow %.4g cells/step; discs cover %.6g cells\n", fastest, covered);
  free(values);
}

int main(void)
{
  /* what is left out is zero, which is the default: walls on all sides, discs at rest and free */
  const struct delbm_disc discs[] = {{.radius = 5, .density = 1.05, .position = {50.2, 180}},
                                     {.radius = 5, .density = 1.05, .position = {50, 160}}};
  const struct delbm_scene scene = {
      .size = {100, 200}, .viscosity = 0.05, .gravity = {0, -0.002}, .discs = discs, .disc_count = 2};
  /* any other key of a case file */
  const char *const settings[] = {"contact.damping=0.5"};
  struct delbm_simulation *simulation, *again;
  struct delbm_disc_state now[2], then[2];
  struct delbm_status status;
  check(delbm_open_scene(&simulation, &scene, settings, 1, &status), &status);

  printf("step    y of disc 0   y of disc 1   force of the fluid on disc 1\n");
  for (int k = 0; k < 5; k++) {
    check(delbm_step(simulation, 400, &status), &status);
    check(delbm_read_discs(simulation, 0, 2, now, &status), &status);
    printf("%-6lld  %11.4f   %11.4f   %.4g\n", (long long)delbm_time(simulation), now[0].position[1],
           now[1].position[1], now[1].force[1]);
  }
  print_flow(simulation);

  /* a checkpoint, loaded into a second simulation of the same scene, goes on as the first does */
  check(delbm_save(simulation, "settle.checkpoint", &status), &status);
  check(delbm_open_scene(&again, &scene, settings, 1, &status), &status);
  check(delbm_load(again, "settle.checkpoint", &status), &status);
  check(delbm_step(simulation, 100, &status), &status);
  check(delbm_step(again, 100, &status), &status);
  check(delbm_read_discs(simulation, 0, 2, now, &status), &status);
  check(delbm_read_discs(again, 0, 2, then, &status), &status);
  const int same = now[0].position[1] == then[0].position[1] && now[1].position[1] == then[1].position[1];
  printf("taken up from the checkpoint: %s\n", same ? "the same" : "different");
  remove("settle.checkpoint");
  delbm_close(simulation);
  delbm_close(again);
  return same ? EXIT_SUCCESS : EXIT_FAILURE;
}
