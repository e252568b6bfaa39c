#include "output/plots.h"

#include "output/file.h"

#include <errno.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

/* Scripts run in the folder of the run. particles.csv has all discs of a step in order, step after step. */
static const char trajectories[] =
    "# Paths of up to a dozen discs, and all of them at the last step.\n"
    "# In the folder of the run: gnuplot plots/trajectories.gp\n"
    "load 'plots/case.gp'\n"
    "set output 'plots/trajectories.png'\n"
    "stats 'particles.csv' using 1 nooutput\n"
    "last = int(STATS_records) - discs\n"
    "\n"
    "# no line from side to side where a disc crosses a periodic one\n"
    "px = py = NaN\n"
    "path_x(x) = (d = abs(x - px), px = x, d > nx / 2. ? NaN : x)\n"
    "path_y(y) = (d = abs(y - py), py = y, d > ny / 2. ? NaN : y)\n"
    "\n"
    "set size ratio -1\n"
    "set xrange [0:nx]\n"
    "set yrange [0:ny]\n"
    "set xlabel 'x / cells'\n"
    "set ylabel 'y / cells'\n"
    "set style fill transparent solid 0.25 border\n"
    "unset key\n"
    "plot 'particles.csv' every ::last using 'x':'y':(radius(column('id'))) with circles linecolor rgb '#2170be', \\\n"
    "  for [k=0:discs - 1:some] 'particles.csv' every discs::k using (path_x(column('x'))):(path_y(column('y'))) \\\n"
    "    with lines linecolor k / some + 1\n";

static const char velocities[] =
    "# Velocity and spin of up to a dozen discs.\n"
    "# In the folder of the run: gnuplot plots/velocities.gp\n"
    "load 'plots/case.gp'\n"
    "set output 'plots/velocities.png'\n"
    "set xlabel 'step'\n"
    "set grid\n"
    "set multiplot layout 3, 1 title name\n"
    "unset title\n"
    "set key outside right\n"
    "do for [quantity in 'vx vy omega'] {\n"
    "  set ylabel quantity eq 'omega' ? 'spin / (radians/step)' : quantity . ' / (cells/step)'\n"
    "  plot for [k=0:discs - 1:some] 'particles.csv' every discs::k using 'step':(column(quantity)) \\\n"
    "    with lines linecolor k / some + 1 title sprintf('disc %d', k)\n"
    "}\n"
    "unset multiplot\n";

static const char interface[] =
    "# Many discs settling: interface, surface of the sediment, and mean heights of five bands by initial height.\n"
    "# In the folder of the run: gnuplot plots/interface.gp   (after delbm analyse DIR --tables, for settling.csv)\n"
    "load 'plots/case.gp'\n"
    "set output 'plots/interface.png'\n"
    "stats 'settling.csv' using (strlen(stringcolumn('front')) > 0) nooutput\n"
    "# without a sediment yet, no line\n"
    "sediment = STATS_max > 0 ? \"'settling.csv' using 'step':'front' with lines linewidth 2 linecolor rgb '#c2481a' "
    "\" \\\n"
    "  . \"title 'sediment'\" : \"NaN notitle\"\n"
    "set xlabel 'step'\n"
    "set ylabel 'height / cells'\n"
    "set yrange [0:ny]\n"
    "set grid\n"
    "plot for [k=1:5] 'settling.csv' using 'step':(column(sprintf('layer%d', k))) with lines linecolor rgb '#b0b0b0' "
    "\\\n"
    "    title k == 1 ? 'bands' : '', \\\n"
    "  'settling.csv' using 'step':'interface' with lines linewidth 2 linecolor rgb '#2170be' title 'interface', \\\n"
    "  @sediment\n";

static const char mixing[] =
    "# Many discs settling: the mixing index lambda by height, at step 0 and five later steps. A disc's layer at step "
    "0\n"
    "# is l_0 of N_l; lambda is the mean of l_0/N_l over the discs of a layer. Step 0 is the diagonal.\n"
    "# In the folder of the run: gnuplot plots/mixing.gp   (after delbm analyse DIR --tables, for profile.csv)\n"
    "load 'plots/case.gp'\n"
    "set output 'plots/mixing.png'\n"
    "stats 'profile.csv' using 'step':'height' nooutput\n"
    "top = STATS_max_y\n"
    "stats 'profile.csv' using (column('height') == top ? column('step') : NaN) nooutput\n"
    "shots = int(STATS_records)\n"
    "array steps[shots]\n"
    "k = 0\n"
    "stats 'profile.csv' using (column('height') == top ? (k = k + 1, steps[k] = column('step'), 0) : NaN) nooutput\n"
    "shown(n) = steps[1 + int(n * (shots - 1) / 5.)]\n"
    "set xlabel 'height / cells'\n"
    "set ylabel 'mixing index'\n"
    "set xrange [0:ny]\n"
    "set yrange [0:1]\n"
    "set grid\n"
    "set key top left\n"
    "plot for [n=0:5] 'profile.csv' using (column('step') == shown(n) ? column('height') : NaN):'lambda' \\\n"
    "    with linespoints pointtype 7 pointsize 0.5 title sprintf('step %d', shown(n))\n";

static const char stages[] =
    "# Seconds of the run spent in each stage.\n"
    "# In the folder of the run: gnuplot plots/stages.gp\n"
    "load 'plots/case.gp'\n"
    "set output 'plots/stages.png'\n"
    "set datafile separator whitespace\n"
    "unset datafile columnheaders\n"
    "stage = \"< awk -F '[\\\":, ]+' '/stages/ {inside = 1; next} /}/ {inside = 0} inside {print $2, $3}' run.json\"\n"
    "stats stage using 2 nooutput\n"
    "set ylabel 'time / s'\n"
    "set yrange [0:*]\n"
    "set offsets graph 0.05, graph 0.05, graph 0.1, 0\n"
    "set boxwidth 0.7\n"
    "set style fill solid 0.7\n"
    "unset key\n"
    "plot stage using 0:2:xtic(1) with boxes linecolor rgb '#2170be', \\\n"
    "  stage using 0:2:(sprintf('%.1f %%', 100 * $2 / STATS_sum)) with labels offset 0, 0.7\n";

static const struct {
  const char *name, *script;
} plots[PLOT_COUNT] = {[PLOT_TRAJECTORIES] = {"trajectories", trajectories},
                       [PLOT_VELOCITIES] = {"velocities", velocities},
                       [PLOT_INTERFACE] = {"interface", interface},
                       [PLOT_MIXING] = {"mixing", mixing},
                       [PLOT_STAGES] = {"stages", stages}};

const char *plot_name(enum plot plot)
{
  return plots[plot].name;
}

/* Writes a gnuplot string in single quotes, on one line. */
static void write_text(const char *text, FILE *stream)
{
  fputc('\'', stream);
  for (; *text; text++) {
    if (*text == '\'') fputc('\'', stream);
    fputc((unsigned char)*text < ' ' ? ' ' : *text, stream);
  }
  fputc('\'', stream);
}

static void describe(const struct scene *scene, FILE *stream)
{
  enum { SHOWN = 12 };
  const size_t discs = scene->particles.count;
  fputs("# About the case; written anew by every `delbm plot`.\nname = ", stream);
  write_text(scene->title, stream);
  fprintf(stream, "\nnx = %d\nny = %d\ndiscs = %zu\nsome = %zu # every so many discs one is followed\n",
          scene->domain.size[0], scene->domain.size[1], discs, (discs + SHOWN - 1) / SHOWN);
  if (discs > 0) fprintf(stream, "array R[%zu]\n", discs);
  for (size_t i = 0; i < discs; i++) fprintf(stream, "R[%zu] = %.17g\n", i + 1, scene->particles.discs[i].radius);
  fputs("radius(id) = R[int(id) + 1]\n"
        "set encoding utf8\n"
        "set terminal pngcairo size 900, 900 font 'sans,11' noenhanced\n"
        "set datafile separator ','\n"
        "set datafile columnheaders\n"
        "set title name\n",
        stream);
}

static char *script_path(const char *directory, const char *name, struct status *status)
{
  char file[64];
  snprintf(file, sizeof file, "plots/%s.gp", name);
  return file_join(directory, file, status);
}

bool plot_describe(const char *directory, const struct scene *scene, struct status *status)
{
  struct replacement file;
  char *folder = file_join(directory, "plots", status), *path = script_path(directory, "case", status);
  bool written = folder && path && file_make_directory(folder, status) && replacement_begin(&file, path, status);
  if (written) {
    describe(scene, file.stream);
    written = replacement_commit(&file, status);
  }
  free(folder);
  free(path);
  return written;
}

bool plot_script(const char *directory, enum plot plot, bool afresh, bool *kept, struct status *status)
{
  struct replacement file;
  char *path = script_path(directory, plot_name(plot), status);
  *kept = path && !afresh && access(path, F_OK) == 0;
  bool written = *kept || (path && replacement_begin(&file, path, status));
  if (written && !*kept) {
    fputs(plots[plot].script, file.stream);
    written = replacement_commit(&file, status);
  }
  free(path);
  return written;
}

/* Starts `gnuplot SCRIPT` in the folder. Returns an error number, or 0. */
static int start_gnuplot(const char *directory, char *script, pid_t *process)
{
  char program[] = "gnuplot";
  char *const words[] = {program, script, NULL};
  posix_spawn_file_actions_t actions;
  int error = posix_spawn_file_actions_init(&actions);
  if (error) return error;
  error = posix_spawn_file_actions_addchdir_np(&actions, directory);
  if (error == 0) error = posix_spawnp(process, program, &actions, NULL, words, environ);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

bool plot_draw(const char *directory, enum plot plot, struct status *status)
{
  char script[64];
  pid_t process;
  int ended = 0;
  snprintf(script, sizeof script, "plots/%s.gp", plot_name(plot));
  const int error = start_gnuplot(directory, script, &process);
  if (error == ENOENT)
    return status_fail(status, DELBM_IO,
                       "cannot draw: gnuplot is not installed (Debian: gnuplot-nox); the scripts are in %s/plots",
                       directory);
  if (error) return file_fail(status, "run", "gnuplot", error);
  while (waitpid(process, &ended, 0) < 0)
    if (errno != EINTR) return file_fail(status, "wait for", "gnuplot", errno);
  return (WIFEXITED(ended) && WEXITSTATUS(ended) == 0) ||
         status_fail(status, DELBM_IO, "gnuplot fails on %s/%s; --fresh writes the script anew", directory, script);
}
