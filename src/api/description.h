/* Converts a struct delbm_scene to the text of a case, so that defaults, checks and messages are the same as for
 * files. */
#ifndef DELBM_API_DESCRIPTION_H
#define DELBM_API_DESCRIPTION_H

#include "base/status.h"
#include "delbm/scene.h"

/* The text, to be released by free(); NULL if memory runs out. */
char *description_write(const struct delbm_scene *scene, size_t *size, struct status *status);

#endif
