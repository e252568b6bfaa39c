/* Reading of case files: YAML to a scene. */
#ifndef DELBM_CASE_CASE_FILE_H
#define DELBM_CASE_CASE_FILE_H

#include "case/case_errors.h"
#include "case/case_yaml.h"
#include "model/scene.h"

enum { SCENE_FILE_MIB = 64 }; /* maximum size of a case file */

/* Reads the case at `path` (a case file, or a folder with case.yaml) and applies the overrides "dotted.key=value", the
 * defaults and particles.fill. On success the scene is to be released by scene_clear.
 * False if
 *   - the file cannot be read (DELBM_IO),
 *   - the case is not valid (DELBM_INVALID): `errors` then has every error found, and *status their number, or
 *   - memory runs out (DELBM_FAILED). */
bool case_read(struct scene *scene, const char *path, char *const set[], size_t set_count, struct case_errors *errors,
               struct status *status);

/* case_read for a text in memory; the name of the case is "case". */
bool case_read_text(struct scene *scene, const struct yaml_text *text, char *const set[], size_t set_count,
                    struct case_errors *errors, struct status *status);

#endif
