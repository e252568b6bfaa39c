/* Plots of a run by gnuplot, in DIR/plots: a script for each, which users may change, the picture that it draws, and
 * case.gp, which tells the scripts about the case. */
#ifndef DELBM_OUTPUT_PLOTS_H
#define DELBM_OUTPUT_PLOTS_H

#include "model/scene.h"

enum plot { PLOT_TRAJECTORIES, PLOT_VELOCITIES, PLOT_INTERFACE, PLOT_MIXING, PLOT_STAGES, PLOT_COUNT };

/* Its script is DIR/plots/NAME.gp, its picture DIR/plots/NAME.png. */
const char *plot_name(enum plot plot);

/* Writes case.gp. */
bool plot_describe(const char *directory, const struct scene *scene, struct status *status);

/* Writes the script. One that is there stays as it is, unless it shall be made afresh; *kept tells. */
bool plot_script(const char *directory, enum plot plot, bool afresh, bool *kept, struct status *status);

/* Runs the script. DELBM_IO if there is no gnuplot, or if it fails. */
bool plot_draw(const char *directory, enum plot plot, struct status *status);

#endif
