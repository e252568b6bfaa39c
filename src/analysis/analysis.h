/* What can be said about a finished run from its case.yaml and particles.csv. What a scene does not have is left out. */
#ifndef DELBM_ANALYSIS_ANALYSIS_H
#define DELBM_ANALYSIS_ANALYSIS_H

#include "analysis/body.h"
#include "analysis/pair.h"
#include "analysis/settling.h"

#include <stdio.h>

struct analysis {
  const struct scene *scene;
  struct history history;
  bool has_body, has_pair, has_settling;
  struct body body;
  struct pair pair;
  struct settling settling;
};

/* Analyses the run of `scene` whose table of discs is at `path`. The scene must outlive the analysis. */
bool analysis_create(struct analysis *analysis, const struct scene *scene, const char *path, struct status *status);
void analysis_destroy(struct analysis *analysis);

/* One figure a line: part.name, value, unit, meaning. */
void analysis_print(const struct analysis *analysis, FILE *stream);

/* An object of an object for each part; the series of `settling` as arrays. */
void analysis_json(const struct analysis *analysis, FILE *stream);

/* The series of `settling` as CSV: one row a snapshot (step, interface, front, mixing, layer1 ..), or one row a
 * snapshot and slab (step, height, concentration). */
void analysis_settling_csv(const struct settling *settling, FILE *stream);
void analysis_profile_csv(const struct settling *settling, FILE *stream);

#endif
