/* The library behind the program `delbm`: flows with discs in them, stepped from C or C++.
 *
 * A simulation is opened from a case (a file, a text, or a struct delbm_scene), stepped, read and written, and
 * closed. A simulation is an opaque handle that owns its memory; there is no global state. Results are copied into
 * the caller's memory; arguments are copied before a call returns.
 *
 * Lattice units: lengths in cells, time in steps, the density of the fluid at rest is 1; so a velocity is in
 * cells/step, a force in rho cells^3/step^2 (per unit depth), a torque in rho cells^4/step^2. Cell (i, j) is [i,
 * i+1] x [j, j+1], x to the right, y up. A case may be written in physical units (its `units` block); calls are in
 * lattice units all the same.
 *
 * Errors. A call that can fail returns a code, DELBM_OK on success, and fills *status unless `status` is NULL. The
 * library never ends the program and never prints. A failed call leaves the simulation unchanged, with these
 * exceptions:
 * - Steps completed by delbm_step before its failure remain; delbm_time returns their number.
 * - A run that has diverged, as found by delbm_step or delbm_save (DELBM_FAILED), or whose memory ran out within a
 *   step, can be read and closed. Calls that step, change, save or load it fail again with the first reason.
 * - If delbm_load fails after the checksum was found right (memory runs out, the disk fails, the file was forged), or
 *   if delbm_write_discs or delbm_write_fluid lacks memory even to undo its changes, the simulation can only be
 *   closed: each other call that can fail returns DELBM_USAGE with this reason.
 *
 * Threads. A step uses OMP_NUM_THREADS threads; results have the same bits for any number, and the same as with
 * `delbm run`. Only one call at a time may use a handle; different threads may use different handles. Waiting
 * threads spin unless GOMP_SPINCOUNT or OMP_WAIT_POLICY is set before the program starts (the program `delbm` sets
 * the first to 500), which is slow if threads outnumber cores. A call opens its own OpenMP regions. Inside of a
 * region of the host one thread may call, or each thread with its own handle: with the same results, but with one
 * thread each unless omp_set_max_active_levels allows more.
 *
 * The host. Numbers are read and written with a decimal point, and messages are in English, in any locale of the
 * host; locale, signal handlers, streams, working folder and rounding mode of the host are not changed. A path is
 * relative to the working folder at the time of the call. Limits:
 * - If the system has no more threads, the OpenMP runtime ends the program with its own message.
 * - OpenMP does not survive fork(): after a call in the parent, a child must not call the library; it may exec another
 *   program.
 * - Results have the same bits as with `delbm run` under rounding to nearest with subnormal numbers. They may differ in
 *   a host that was linked with -ffast-math or sets another rounding; with trapped floating-point exceptions, SIGFPE
 *   may end the host.
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

/* Opens a simulation at step 0: fluid at rest, or none with `fluid: none`, discs as in the case. *simulation is NULL on
 * failure: DELBM_IO for a file that cannot be read, DELBM_INVALID for an invalid or too large case, DELBM_USAGE for a
 * setting that is not key=value, DELBM_FAILED for want of memory.
 *
 * `settings` are `count` texts "dotted.key=value" that replace values of the case as --set does; `delbm run
 * --help-keys` has all keys. Keys of the run's length and output are ignored and may be missing. */
DELBM_API enum delbm_code delbm_open_file(struct delbm_simulation **simulation, const char *path,
                                          const char *const settings[], size_t count, struct delbm_status *status);
DELBM_API enum delbm_code delbm_open_text(struct delbm_simulation **simulation, const char *yaml,
                                          const char *const settings[], size_t count, struct delbm_status *status);
DELBM_API enum delbm_code delbm_open_scene(struct delbm_simulation **simulation, const struct delbm_scene *scene,
                                           const char *const settings[], size_t count, struct delbm_status *status);

/* Closes a simulation; NULL is allowed. */
DELBM_API void delbm_close(struct delbm_simulation *simulation);

/* Advances by `steps` >= 0 steps. DELBM_FAILED if the run has diverged, which is checked every run.check steps, or
 * if memory runs out; DELBM_USAGE if a callback sets a velocity beyond the limit of delbm_write_discs, before that
 * step. */
DELBM_API enum delbm_code delbm_step(struct delbm_simulation *simulation, int64_t steps, struct delbm_status *status);

/* Steps done. */
DELBM_API int64_t delbm_time(const struct delbm_simulation *simulation);

/* Cells in x (axis 0) or y (axis 1). */
DELBM_API int delbm_size(const struct delbm_simulation *simulation, int axis);

/* State of a disc. With `fluid: none` a velocity is that of half a contact sub-step before the position (without
 * contact: half a step), at step 0 that of the position. Forces act in the last step: `force` and `torque` from the
 * fluid, the contact forces from discs and walls. */
struct delbm_disc_state {
  double position[2], velocity[2];
  double angle, spin;
  double force[2], torque;
  double contact_force[2], contact_torque;
};

DELBM_API size_t delbm_disc_count(const struct delbm_simulation *simulation);

/* Reads discs first .. first + count - 1, counted from 0: first the case's list, then the discs of particles.fill. */
DELBM_API enum delbm_code delbm_read_discs(const struct delbm_simulation *simulation, size_t first, size_t count,
                                           struct delbm_disc_state *states, struct delbm_status *status);

/* Sets position, velocity, angle and spin of discs first .. first + count - 1, all or, on failure, none; forces in
 * `states` are ignored. The fluid is unchanged: the fluid at the new position of a disc reaches the disc's velocity
 * within some hundred steps (coupling.form midpoint, the default; the other forms have no damping inside discs). The
 * centre must lie in the box, |velocity| + |spin| radius must be at most 0.3, and a fixed disc must have velocity 0:
 * otherwise DELBM_USAGE. */
DELBM_API enum delbm_code delbm_write_discs(struct delbm_simulation *simulation, size_t first, size_t count,
                                            const struct delbm_disc_state *states, struct delbm_status *status);

/* Sets velocity (cells/step) and spin (radians/step) of a driven disc for the coming step, number `step` counted
 * from 0. `now` is the disc before that step, with force and torque of the last step. */
typedef void delbm_drive_function(void *context, int64_t step, const struct delbm_disc_state *now, double velocity[2],
                                  double *spin);

/* Calls `function` before each coming step; NULL removes the callback, and the disc keeps its last velocity. The
 * force is the fluid's force on the solid, as for free discs: mass times acceleration is the sum of this force,
 * contact forces and the drive's force. A callback runs in the thread that called delbm_step, between steps. It must
 * not use this simulation, and must return: neither longjmp nor a C++ exception may leave it. If one of several
 * callbacks sets a velocity beyond the limit, no disc's velocity changes. Checkpoints do not contain callbacks. */
DELBM_API enum delbm_code delbm_drive(struct delbm_simulation *simulation, size_t disc, delbm_drive_function *function,
                                      void *context, struct delbm_status *status);

enum delbm_field {
  DELBM_DENSITY,    /* 1 at rest; the pressure above rest is (density - 1)/3 */
  DELBM_VELOCITY_X, /* cells/step; inside discs, of the fluid there */
  DELBM_VELOCITY_Y,
  DELBM_OCCUPATION /* part of the cell's area inside discs, 0 to 1 */
};

/* Copies a field into an array of nx * ny numbers, nx = delbm_size(.., 0), ny = delbm_size(.., 1), row by row from
 * the bottom: cell (i, j) is values[j * nx + i], as in a NumPy array of shape (ny, nx). DELBM_FAILED for want of
 * memory; DELBM_USAGE in a case with `fluid: none`, which has no fields. */
DELBM_API enum delbm_code delbm_read_field(struct delbm_simulation *simulation, enum delbm_field field, double *values,
                                           struct delbm_status *status);

/* Sets the fluid of every cell to equilibrium at this density and velocity (cells/step), arrays in the order of
 * delbm_read_field. Densities must be above 0, speeds at most 0.3, and there must be fluid: otherwise DELBM_USAGE. The
 * viscous stress develops in the first few steps. In a cell of discs the velocity is (1 - B) times `velocity` plus B times the
 * discs' velocity, with B the weight of the occupation fraction, 1 or nearly 1 inside a disc: the fluid there moves
 * with the disc. */
DELBM_API enum delbm_code delbm_write_fluid(struct delbm_simulation *simulation, const double *density,
                                            const double *velocity_x, const double *velocity_y,
                                            struct delbm_status *status);

/* Writes the whole state to a file: as `path`.tmp, forced to the disk and renamed, so that an old file remains until
 * the new file is complete. Two simultaneous saves to one path are an error of the host. Loading the file into a
 * simulation opened from the same case restores the state, and the next steps have the same bits. checkpoint.0 and
 * checkpoint.1 of a run are such files, of the run's case.yaml. DELBM_IO if the file cannot be written. */
DELBM_API enum delbm_code delbm_save(struct delbm_simulation *simulation, const char *path,
                                     struct delbm_status *status);
DELBM_API enum delbm_code delbm_load(struct delbm_simulation *simulation, const char *path,
                                     struct delbm_status *status);

#ifdef __cplusplus
}
#endif

#endif
