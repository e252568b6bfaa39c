/* The library behind the program `delbm`: flows with discs in them, stepped from C or C++.
 *
 * A simulation is opened from a case (a file, a text, or a struct delbm_scene), stepped, read and written, and closed.
 * It is an opaque handle, owns all that it holds, and shares nothing with another: there is no global state.
 * Whatever is read is copied into the caller's memory; whatever is passed in is copied before the call returns.
 *
 * Units are those of the lattice: lengths in cells, time in steps, the density of the fluid at rest is 1; so a velocity
 * is in cells/step, a force in rho cells^3/step^2 (per unit depth), a torque in rho cells^4/step^2. Cell (i, j) covers
 * [i, i+1] x [j, j+1], x to the right, y up. A case may be written in physical units (its `units` block); calls are in
 * lattice units all the same.
 *
 * Errors. A call that can fail returns a code, DELBM_OK if all is well, and then has filled *status, if that is not
 * NULL. The library never ends the program and never prints. After a failed call the simulation is as it was, with these
 * exceptions:
 * - Steps that delbm_step had done before it failed stay done; delbm_time tells how many.
 * - A run that has diverged, which delbm_step or delbm_save finds (DELBM_FAILED), or whose memory ran out within a step,
 *   can be read and closed, but not stepped, changed, saved or loaded: that fails with the first reason again.
 * - If delbm_load fails after the file was found good (memory runs out, the disk fails, the file was forged), or if
 *   delbm_write_discs or delbm_write_fluid lacks memory even to undo what it did, the simulation can only be closed: each
 *   other call that can fail then does, with DELBM_USAGE, and says so.
 *
 * Threads. A step uses OMP_NUM_THREADS threads; results are the same bits for any number, and the same as those of
 * `delbm run`. Only one call at a time may use a handle; different handles may be used by different threads. Waiting
 * threads spin unless GOMP_SPINCOUNT or OMP_WAIT_POLICY is set before the program starts (the program `delbm` sets the
 * first to 500), which costs dear where threads outnumber cores. A call opens OpenMP regions of its own, and may be made
 * by one thread, or by each with a handle of its own, inside of a region of the host: with the same results, but with one
 * thread each unless omp_set_max_active_levels allows more.
 *
 * The host. Numbers are read and written with a decimal point, and messages are in English, whatever its locale; its
 * locale, signal handlers, streams, working folder and rounding mode stay as they are. A path is relative to the working
 * folder at the time of the call. What the library cannot prevent:
 * - If the system has no more threads, the OpenMP runtime ends the program with words of its own.
 * - OpenMP does not survive fork(): where the parent has used the library, a child must not, but may exec another program.
 * - Results are the same bits as those of `delbm run` with rounding to nearest and subnormal numbers kept. A host that was
 *   linked with -ffast-math, or that sets another rounding, may get others; one that has floating-point exceptions trapped
 *   may be ended by SIGFPE.
 * - A limit on the size of files raises SIGXFSZ, which ends the program unless it is ignored. */
#ifndef DELBM_DELBM_H
#define DELBM_DELBM_H

#include "delbm/scene.h"
#include "delbm/status.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

struct delbm_simulation;

/* "0.1.0", of the library in use. */
DELBM_API const char *delbm_version(void);

/* Each opens a simulation at step 0: fluid at rest, discs as given. *simulation is NULL on failure.
 *
 * `settings` are `count` texts "dotted.key=value" that replace values of the case as --set does; `delbm run --help-keys`
 * has all keys. Keys of the run's length and output have no meaning here and may be left out of a text. */
DELBM_API enum delbm_code delbm_open_file(struct delbm_simulation **simulation, const char *path,
                                          const char *const settings[], size_t count, struct delbm_status *status);
DELBM_API enum delbm_code delbm_open_text(struct delbm_simulation **simulation, const char *yaml,
                                          const char *const settings[], size_t count, struct delbm_status *status);
DELBM_API enum delbm_code delbm_open_scene(struct delbm_simulation **simulation, const struct delbm_scene *scene,
                                           const char *const settings[], size_t count, struct delbm_status *status);

/* NULL is fine. */
DELBM_API void delbm_close(struct delbm_simulation *simulation);

/* Advances by `steps` >= 0 steps. DELBM_FAILED when the run has diverged, which is looked for every run.check steps, or
 * when memory runs out; DELBM_USAGE when a callback has asked for a velocity that no disc may have, before that step. */
DELBM_API enum delbm_code delbm_step(struct delbm_simulation *simulation, int64_t steps, struct delbm_status *status);

/* Steps done. */
DELBM_API int64_t delbm_time(const struct delbm_simulation *simulation);

/* Cells in x (axis 0) or y (axis 1). */
DELBM_API int delbm_size(const struct delbm_simulation *simulation, int axis);

/* A disc as it is now. Forces are those of the last step: of the fluid on the disc, and of contacts with others and
 * with walls. */
struct delbm_disc_state {
  double position[2], velocity[2];
  double angle, spin;
  double force[2], torque;
  double contact_force[2], contact_torque;
};

DELBM_API size_t delbm_disc_count(const struct delbm_simulation *simulation);

/* Reads discs first .. first + count - 1, counted from 0: first the case's list, then those of particles.fill. */
DELBM_API enum delbm_code delbm_read_discs(const struct delbm_simulation *simulation, size_t first, size_t count,
                                           struct delbm_disc_state *states, struct delbm_status *status);

/* Sets position, velocity, angle and spin of those discs, all or, on failure, none; forces are not looked at. The fluid
 * stays as it is: a disc that jumps finds the fluid of its new place in it, and takes it along within some hundred steps
 * (coupling.form midpoint, the default; the others have no damping inside discs). The centre must lie in the box, |velocity|
 * + |spin| radius be at most 0.3, and a fixed disc have no velocity. */
DELBM_API enum delbm_code delbm_write_discs(struct delbm_simulation *simulation, size_t first, size_t count,
                                            const struct delbm_disc_state *states, struct delbm_status *status);

/* Sets the velocity and the spin of a driven disc for the coming step, the `step`-th from 0. `now` is the disc before
 * that step, with the force and torque felt in the last one. */
typedef void delbm_drive_function(void *context, int64_t step, const struct delbm_disc_state *now, double velocity[2],
                                  double *spin);

/* From now on asks `function` before each step; NULL ends that, and the disc keeps its last velocity. The force is what
 * acts on the solid, as for free discs: its mass times its acceleration is that force and what the drive adds. A
 * callback runs in the thread that called delbm_step, between steps. It must not call anything with this simulation, and
 * must return: neither longjmp nor a C++ exception may leave it. If one of several asks for a velocity that no disc may
 * have, no disc's velocity changes. Checkpoints do not hold callbacks. */
DELBM_API enum delbm_code delbm_drive(struct delbm_simulation *simulation, size_t disc, delbm_drive_function *function,
                                      void *context, struct delbm_status *status);

enum delbm_field {
  DELBM_DENSITY,    /* 1 at rest; the pressure above rest is (density - 1)/3 */
  DELBM_VELOCITY_X, /* cells/step; in cells that a disc covers, of the fluid inside it */
  DELBM_VELOCITY_Y,
  DELBM_OCCUPATION /* share of the cell that discs cover, 0 to 1 */
};

/* Copies a field into an array of delbm_size(.., 0) x delbm_size(.., 1) numbers, row by row from the bottom: cell (i, j)
 * is values[j * nx + i]. So the strides are 1 in x and nx in y, the shape (ny, nx) of a NumPy array. */
DELBM_API enum delbm_code delbm_read_field(struct delbm_simulation *simulation, enum delbm_field field, double *values,
                                           struct delbm_status *status);

/* Sets the fluid of every cell to equilibrium at this density and velocity, arrays laid out as above. Densities must lie
 * above 0, speeds at most at 0.3. Gradients that the flow has are left to build up in the first few steps. A cell under
 * discs takes (1 - B) of this velocity and B of the discs', with B the weight of its occupation: 1 or nearly so where it is
 * covered wholly, so that the fluid inside a disc moves with it. */
DELBM_API enum delbm_code delbm_write_fluid(struct delbm_simulation *simulation, const double *density,
                                            const double *velocity_x, const double *velocity_y,
                                            struct delbm_status *status);

/* Writes the whole state to a file, in one move: it is written as `path`.tmp, forced to the disk and renamed, so that a
 * file that stood there stands until the new one is whole. Two saves to one path at the same time are an error of the host.
 * Loading the file into a simulation opened from the same case gives what was saved, and its coming steps have the same
 * bits. The files checkpoint.0 and checkpoint.1 of a run are such files, of its case.yaml. */
DELBM_API enum delbm_code delbm_save(struct delbm_simulation *simulation, const char *path,
                                     struct delbm_status *status);
DELBM_API enum delbm_code delbm_load(struct delbm_simulation *simulation, const char *path,
                                     struct delbm_status *status);

#ifdef __cplusplus
}
#endif

#endif
