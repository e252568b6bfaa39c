/* fields.xdmf: the text that tells ParaView and others what lies where in fields.h5, with an end at any time. */
#ifndef DELBM_OUTPUT_XDMF_H
#define DELBM_OUTPUT_XDMF_H

#include "sim/sample.h"

#include <stdio.h>

struct xdmf {
  const char *path;
  struct sample_grid grid;
  FILE *stream; /* NULL: closed */
};

/* Starts the file anew, without snapshots. The path must outlive it. */
bool xdmf_open(struct xdmf *xdmf, const char *path, const struct sample_grid *grid, struct status *status);

/* Adds a snapshot with so many points for its discs. */
bool xdmf_add(struct xdmf *xdmf, int64_t step, size_t points, struct status *status);

bool xdmf_close(struct xdmf *xdmf, struct status *status);

#endif
