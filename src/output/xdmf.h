/* fields.xdmf: the index of fields.h5 for ParaView and other readers, valid after each snapshot. */
#ifndef DELBM_OUTPUT_XDMF_H
#define DELBM_OUTPUT_XDMF_H

#include "sim/sample.h"

#include <stdio.h>

struct xdmf {
  const char *path;
  struct sample_grid grid;
  FILE *stream; /* NULL: closed */
};

/* Creates the file without snapshots. The path must outlive *xdmf. */
bool xdmf_open(struct xdmf *xdmf, const char *path, const struct sample_grid *grid, struct status *status);

/* Adds a snapshot with `points` points for discs. */
bool xdmf_add(struct xdmf *xdmf, int64_t step, size_t points, struct status *status);

bool xdmf_close(struct xdmf *xdmf, struct status *status);

#endif
