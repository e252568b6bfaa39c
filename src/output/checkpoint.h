/* Checkpoints: the state of a run in a file. A resumed run is bit-identical to an unbroken one.
 *
 * Format: head (magic, byte order, format, fingerprint of the case, step, kernel), state (simulation_save), record of
 * the files of the run, CRC-32 of everything before. A binary file rather than HDF5, which a build may lack. It is
 * written as a durable replacement (file.h), so that a file of this name is complete; the checksum detects damage by
 * the disk. */
#ifndef DELBM_OUTPUT_CHECKPOINT_H
#define DELBM_OUTPUT_CHECKPOINT_H

#include "sim/simulation.h"

/* Output of the run up to the checkpoint. */
struct run_record {
  int64_t discs_bytes;  /* length of particles.csv */
  int64_t series_bytes; /* length of series.csv */
  int64_t snapshots;    /* number in fields.h5 of earlier steps than the checkpoint */
  double seconds;       /* wall time of the run */
  double output;        /* time of output in `seconds` */
};

enum { CHECKPOINT_KERNEL = 32 };
struct checkpoint_head {
  char magic[8];
  uint32_t order, format;
  uint32_t fingerprint, reserved;
  int64_t step;
  char kernel[CHECKPOINT_KERNEL];
};

/* Writes the state of the simulation. `fingerprint`: case_fingerprint. On failure an existing file is unchanged. */
bool checkpoint_write(const char *path, uint32_t fingerprint, struct simulation *simulation,
                      const struct run_record *record, struct status *status);

/* Fails with DELBM_IO and the reason unless the file is a complete checkpoint of this case; fills *head. */
bool checkpoint_examine(const char *path, uint32_t fingerprint, struct checkpoint_head *head, struct status *status);

/* Restores a simulation of the case from a file that checkpoint_examine has accepted. */
bool checkpoint_read(const char *path, struct simulation *simulation, struct run_record *record, struct status *status);

/* Examines and restores one open file, so that no other file can take its name in between. Sets *lost if it fails after
 * the state of the simulation has changed. */
bool checkpoint_load(const char *path, uint32_t fingerprint, struct simulation *simulation, bool *lost,
                     struct status *status);

#endif
