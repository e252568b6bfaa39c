/* Plots of a run by gnuplot, in DIR/plots: for each plot a script, which users may change, and its picture; case.gp
 * defines the case's parameters for the scripts. */
#ifndef DELBM_OUTPUT_PLOTS_H
#define DELBM_OUTPUT_PLOTS_H

#include "model/scene.h"

enum plot { PLOT_TRAJECTORIES, PLOT_VELOCITIES, PLOT_INTERFACE, PLOT_MIXING, PLOT_STAGES, PLOT_COUNT };

/* NAME of a plot: the script is DIR/plots/NAME.gp, the picture DIR/plots/NAME.png. */
const char *plot_name(enum plot plot);

/* Writes case.gp. */
bool plot_describe(const char *directory, const struct scene *scene, struct status *status);

/* Writes the script. Without `afresh` an existing script is kept, and *kept is true. */
bool plot_script(const char *directory, enum plot plot, bool afresh, bool *kept, struct status *status);

/* Runs the script. DELBM_IO if there is no gnuplot, or if it fails. */
bool plot_draw(const char *directory, enum plot plot, struct status *status);

#endif
