/* Case files: YAML to a scene. */
#ifndef DELBM_CASE_CASE_FILE_H
#define DELBM_CASE_CASE_FILE_H

#include "case/case_errors.h"
#include "case/case_yaml.h"
#include "model/scene.h"

enum { SCENE_FILE_MIB = 64 }; /* largest case file taken */

/* Reads the case at `path`, a case file or a folder that holds case.yaml, with overrides "dotted.key=value" on top,
 * fills in the defaults and draws the discs of particles.fill. On success the scene is to be released by scene_clear.
 * False if
 *   - the file cannot be read (DELBM_IO),
 *   - the case is not valid (DELBM_INVALID): `errors` then holds every error found, and *status their number, or
 *   - memory runs out (DELBM_FAILED). */
bool case_read(struct scene *scene, const char *path, char *const set[], size_t set_count, struct case_errors *errors,
               struct status *status);

/* The same for a case in memory, whose name becomes "case". */
bool case_read_text(struct scene *scene, const struct yaml_text *text, char *const set[], size_t set_count,
                    struct case_errors *errors, struct status *status);

#endif
