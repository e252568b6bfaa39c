#include "cli/commands.h"
#include "cli/options.h"
#include "cli/tables.h"

#include "output/file.h"
#include "output/plots.h"

#include <stdlib.h>
#include <unistd.h>

enum { OPTION_FRESH = OPTION_OWN };

const struct option plot_options[] = {
    {"fresh", no_argument, NULL, OPTION_FRESH}, {"help", no_argument, NULL, OPTION_HELP}, {0}};

static void print_help(void)
{
  puts("usage: delbm plot DIR [--fresh]\n"
       "\n"
       "Draws a run, by gnuplot, into DIR/plots:\n"
       "\n"
       "  trajectories.png  paths of discs, and where they are at the last step\n"
       "  velocities.png    velocity and spin of discs\n"
       "  interface.png     many discs settling: interface, sediment and bands by initial height\n"
       "  mixing.png        many discs settling: mixing index by height at six steps\n"
       "  stages.png        seconds in each stage\n"
       "\n"
       "Beside each stands its script (trajectories.gp), to be changed at will: one that is there is used as it is.\n"
       "\n"
       "  --fresh  writes the scripts anew\n"
       "  --help   this text");
}

struct request {
  const char *directory;
  bool fresh;
};

/* True if a run has the file, and not an empty one. */
static bool has_file(const char *directory, const char *name)
{
  struct status ignored;
  char *path = file_join(directory, name, &ignored);
  FILE *file = path ? fopen(path, "r") : NULL;
  free(path);
  if (!file) return false;
  const bool filled = fgetc(file) != EOF;
  fclose(file);
  return filled;
}

/* The interface has to be found before it can be drawn. */
static bool find_interface(const struct scene *scene, const char *directory, struct status *status)
{
  struct analysis analysis;
  if (!analysis_create(&analysis, scene, directory, status)) return false;
  const bool found = tables_write(&analysis.settling, directory, status);
  analysis_destroy(&analysis);
  return found;
}

/* Which plots the run allows. */
static bool choose(const struct scene *scene, const char *directory, bool wanted[PLOT_COUNT], struct status *status)
{
  const bool discs = scene->particles.count > 0 && has_file(directory, "particles.csv");
  wanted[PLOT_TRAJECTORIES] = wanted[PLOT_VELOCITIES] = discs;
  wanted[PLOT_INTERFACE] = wanted[PLOT_MIXING] = discs && settling_applies(scene);
  wanted[PLOT_STAGES] = has_file(directory, "run.json");
  return discs || wanted[PLOT_STAGES] ||
         status_fail(status, DELBM_IO, "nothing to plot: %s holds no results", directory);
}

static bool write_script(const struct request *request, enum plot plot, struct status *status)
{
  bool kept;
  if (!plot_script(request->directory, plot, request->fresh, &kept, status)) return false;
  if (kept) fprintf(stderr, "delbm: using %s/plots/%s.gp as it is\n", request->directory, plot_name(plot));
  return true;
}

static bool draw(const struct request *request, enum plot plot, struct status *status)
{
  if (!plot_draw(request->directory, plot, status)) return false;
  printf("%s/plots/%s.png\n", request->directory, plot_name(plot));
  return true;
}

static bool plot_scene(const struct scene *scene, const struct request *request, struct status *status)
{
  bool wanted[PLOT_COUNT];
  bool done = choose(scene, request->directory, wanted, status) && plot_describe(request->directory, scene, status);
  if (done && wanted[PLOT_INTERFACE]) done = find_interface(scene, request->directory, status);
  for (int plot = 0; done && plot < PLOT_COUNT; plot++)
    if (wanted[plot]) done = write_script(request, (enum plot)plot, status);
  for (int plot = 0; done && plot < PLOT_COUNT; plot++)
    if (wanted[plot]) done = draw(request, (enum plot)plot, status);
  return done;
}

int command_plot(int argc, char **argv)
{
  struct request request = {0};
  for (int option; (option = option_next(argc, argv, plot_options)) != OPTION_END;) {
    if (option == OPTION_HELP) print_help();
    if (option == OPTION_HELP) return DELBM_OK;
    if (option == OPTION_BAD) return DELBM_USAGE;
    request.fresh = true;
  }
  request.directory = option_operand(argc, argv, "DIR");
  if (!request.directory) return DELBM_USAGE;
  struct scene scene = {0};
  struct status status;
  const struct settings none = {0};
  int code = read_case(&scene, request.directory, &none, NULL);
  if (code == DELBM_OK && !plot_scene(&scene, &request, &status)) code = report_error(&status);
  scene_clear(&scene);
  return code;
}
