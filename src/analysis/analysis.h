/* Figures of a finished run from case.yaml, particles.csv and run.json. Parts that do not apply to the scene are
 * left out. */
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

/* Analyses the run of `scene` in a folder, from particles.csv and, if it exists, run.json. The scene must outlive
 * the analysis. */
bool analysis_create(struct analysis *analysis, const struct scene *scene, const char *directory,
                     struct status *status);
void analysis_destroy(struct analysis *analysis);

/* One figure a line: part.name, value, unit, meaning. Lines that start with # are notes. */
void analysis_print(const struct analysis *analysis, FILE *stream);

/* An object of an object for each part; the series of `settling` as arrays, null where a layer is empty. */
void analysis_json(const struct analysis *analysis, FILE *stream);

/* The series of `settling` as CSV. settling: one row a snapshot (step; interface; front, empty without sediment;
 * mixing; layer1 .., the mean heights of the bands). profile: one row a snapshot and layer (step; height;
 * concentration; lambda, empty without discs). */
void analysis_settling_csv(const struct settling *settling, FILE *stream);
void analysis_profile_csv(const struct settling *settling, FILE *stream);

#endif
