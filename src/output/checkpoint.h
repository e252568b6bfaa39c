/* Checkpoints: the state of a run in a file, from which it goes on as if it had never stopped.
 *
 * A plain binary file of its own rather than HDF5: a few arrays written front to back, read by nothing but delbm, in
 * every build. Head (magic, byte order, format, fingerprint of the case, step, kernel), state (simulation_save), the
 * record of the run's files, and a CRC-32 of all that. It is written beside its place, forced to the disk and renamed,
 * so that a file of that name is whole unless the disk itself has harmed it, which the checksum finds. */
#ifndef DELBM_OUTPUT_CHECKPOINT_H
#define DELBM_OUTPUT_CHECKPOINT_H

#include "sim/simulation.h"

/* What a run had written when the checkpoint was taken. */
struct run_record {
  int64_t table_bytes; /* length of particles.csv */
  int64_t snapshots;   /* in fields.h5, of steps before that of the checkpoint */
  double seconds;      /* wall time of the run */
  double output;       /* of which spent on output */
};

enum { CHECKPOINT_KERNEL = 32 };
struct checkpoint_head {
  char magic[8];
  uint32_t order, format;
  uint32_t fingerprint, reserved;
  int64_t step;
  char kernel[CHECKPOINT_KERNEL];
};

/* Writes the simulation's state. `fingerprint` is the case's (case_fingerprint). On failure a file that stood at `path`
 * still stands. */
bool checkpoint_write(const char *path, uint32_t fingerprint, struct simulation *simulation,
                      const struct run_record *record, struct status *status);

/* Reads the whole file and tells whether it is a whole checkpoint of this case; *head is filled if so. Fails with
 * DELBM_IO and the reason. */
bool checkpoint_examine(const char *path, uint32_t fingerprint, struct checkpoint_head *head, struct status *status);

/* Restores from a file that checkpoint_examine has found good, into a simulation of that case. */
bool checkpoint_read(const char *path, struct simulation *simulation, struct run_record *record, struct status *status);

/* Both, of one file: another that takes its name in between is not looked at. *lost becomes true if it fails after the state
 * of the simulation has been touched. */
bool checkpoint_load(const char *path, uint32_t fingerprint, struct simulation *simulation, bool *lost,
                     struct status *status);

#endif
