/* A scene described in code, as the text of a case: it is then read, completed and checked as any other, with the same
 * words for what is wrong. */
#ifndef DELBM_API_DESCRIPTION_H
#define DELBM_API_DESCRIPTION_H

#include "base/status.h"
#include "delbm/scene.h"

/* The text and its size, to be released by free(); NULL for want of memory. */
char *description_write(const struct delbm_scene *scene, size_t *size, struct status *status);

#endif
