#include "analysis/ambient.h"

#include "output/file.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Sets *value if the line of run.json is the member `name` with a number; null is no number. */
static void take_member(const char *line, const char *name, double *value)
{
  char *end;
  const char *at = strstr(line, name);
  if (!at) return;
  at += strlen(name);
  const double number = strtod(at, &end);
  if (end != at) *value = number;
}

bool ambient_read_mean(const char *directory, double mean[2], struct status *status)
{
  char line[4096], *path = file_join(directory, "run.json", status);
  mean[0] = mean[1] = NAN;
  if (!path) return false;
  FILE *file = fopen(path, "r");
  const bool good = file || errno == ENOENT || file_fail(status, "open", path, errno);
  free(path);
  if (!file) return good;
  while (fgets(line, sizeof line, file)) {
    take_member(line, "\"mean_ux\": ", &mean[0]);
    take_member(line, "\"mean_uy\": ", &mean[1]);
  }
  fclose(file);
  return true;
}

struct ambient ambient_of(const struct scene *scene, const double mean[2])
{
  struct ambient ambient;
  for (int k = 0; k < SIDE_COUNT; k++) {
    const double *velocity = scene->domain.side[k].velocity;
    if (scene->domain.side[k].type == SIDE_INLET)
      return (struct ambient){{AMBIENT_STREAM, AMBIENT_STREAM}, {velocity[0], velocity[1]}};
  }
  for (int axis = 0; axis < 2; axis++) {
    const bool closed = scene_is_closed(scene, axis);
    ambient.kind[axis] = closed ? AMBIENT_REST : AMBIENT_MEAN;
    ambient.velocity[axis] = closed ? 0 : mean[axis];
  }
  return ambient;
}

const char *ambient_name(enum ambient_kind kind)
{
  static const char *const names[] = {"the stream of the inlet", "fluid at rest: walls close the box",
                                      "the mean velocity of the fluid at the end of the run"};
  return names[kind];
}
