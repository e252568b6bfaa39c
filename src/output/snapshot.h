/* A snapshot as a group of an HDF5 file (content: fields.h). */
#ifndef DELBM_OUTPUT_SNAPSHOT_H
#define DELBM_OUTPUT_SNAPSHOT_H

#include "output/points.h"
#include "sim/sample.h"

#include <hdf5.h>

struct snapshot {
  int64_t step;
  size_t points; /* discs and images */
};

enum { SNAPSHOT_NAME = 32 };
void snapshot_name(char name[SNAPSHOT_NAME], int64_t step);

/* The grid of the samples, as attributes of the root. These and the next two return false when HDF5 fails. */
bool snapshot_write_grid(hid_t root, const int domain_size[2], const struct sample_grid *grid);
bool snapshot_read_grid(hid_t root, const struct snapshot *snapshot, struct sample_grid *grid);

bool snapshot_write(hid_t root, int64_t step, const struct sample_grid *grid, const struct sample *sample,
                    const struct points *points);

/* Copies the snapshot of `step` from one root to another without decompression. In place of H5Ocopy, which crashes
 * when a write fails (HDF5 1.10.8). */
bool snapshot_copy(hid_t from, hid_t to, int64_t step);

/* Reads all data of the snapshot of snapshot->step, so that HDF5 compares checksums; sets snapshot->points. A
 * failure names `path`, the file, and the damaged or missing object. */
bool snapshot_check(hid_t root, const char *path, struct snapshot *snapshot, struct status *status);

#endif
