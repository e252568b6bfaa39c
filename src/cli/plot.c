#include "cli/commands.h"
#include "cli/report.h"
#include "cli/tables.h"

#include "output/file.h"
#include "output/plots.h"

#include <stdlib.h>

/* True if the file exists and is not empty. */
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

/* Writes the series of settling, which the plots of interface and mixing read. */
static bool find_interface(const struct scene *scene, const char *directory, struct status *status)
{
  struct analysis analysis;
  if (!analysis_create(&analysis, scene, directory, status)) return false;
  const bool found = tables_write(&analysis.settling, directory, status);
  analysis_destroy(&analysis);
  return found;
}

/* Marks the plots for which the run has files. */
static bool choose(const struct scene *scene, const char *directory, bool wanted[PLOT_COUNT], struct status *status)
{
  const bool discs = scene->particles.count > 0 && has_file(directory, "particles.csv");
  wanted[PLOT_TRAJECTORIES] = wanted[PLOT_VELOCITIES] = discs;
  wanted[PLOT_INTERFACE] = wanted[PLOT_MIXING] = discs && settling_applies(scene);
  wanted[PLOT_STAGES] = has_file(directory, "run.json");
  return discs || wanted[PLOT_STAGES] ||
         status_fail(status, DELBM_IO, "nothing to plot: %s contains no results", directory);
}

static bool write_script(const struct arguments *arguments, enum plot plot, struct status *status)
{
  const char *directory = *arguments->operands;
  bool kept;
  if (!plot_script(directory, plot, arguments->fresh, &kept, status)) return false;
  if (kept) fprintf(stderr, "delbm: using %s/plots/%s.gp as it is\n", directory, plot_name(plot));
  return true;
}

static bool draw(const char *directory, enum plot plot, struct status *status)
{
  if (!plot_draw(directory, plot, status)) return false;
  printf("%s/plots/%s.png\n", directory, plot_name(plot));
  return true;
}

static bool plot_scene(const struct arguments *arguments, struct status *status)
{
  const struct scene *scene = &arguments->scene;
  const char *directory = *arguments->operands;
  bool wanted[PLOT_COUNT];
  bool done = choose(scene, directory, wanted, status) && plot_describe(directory, scene, status);
  if (done && wanted[PLOT_INTERFACE]) done = find_interface(scene, directory, status);
  for (int plot = 0; done && plot < PLOT_COUNT; plot++)
    if (wanted[plot]) done = write_script(arguments, (enum plot)plot, status);
  for (int plot = 0; done && plot < PLOT_COUNT; plot++)
    if (wanted[plot]) done = draw(directory, (enum plot)plot, status);
  return done;
}

static int plot_results(struct arguments *arguments)
{
  struct status status;
  return plot_scene(arguments, &status) ? DELBM_OK : report_error(&status);
}

const struct command command_plot = {
    .name = "plot",
    .purpose = "draw a run by gnuplot",
    .operand_name = "DIR",
    .operand = OPERAND_RESULTS,
    .about = "Draws a run, by gnuplot, into DIR/plots:\n"
             "\n"
             "  trajectories.png  paths of discs, and where they are at the last step\n"
             "  velocities.png    velocity and spin of discs\n"
             "  interface.png     many discs settling: interface, sediment and bands by initial height\n"
             "  mixing.png        many discs settling: mixing index by height at six steps\n"
             "  stages.png        seconds in each stage\n"
             "\n"
             "Beside each stands its script (trajectories.gp), to be changed at will: one that is there is used as it "
             "is.",
    .options = {{"fresh", NULL, "writes the scripts anew", .kind = OPTION_FLAG,
                 .target = offsetof(struct arguments, fresh)},
                {"help", NULL, "this text", .kind = OPTION_HELP}},
    .run = plot_results,
};
