/* Files named by their step, in eight digits or more: frames/00000500.png, fields/00000500.h5. */
#ifndef DELBM_OUTPUT_NUMBERED_H
#define DELBM_OUTPUT_NUMBERED_H

#include "base/status.h"

#include <stdint.h>

/* folder/NNNNNNNN.extension, released by free(); NULL when memory runs out. */
char *numbered_path(const char *folder, int64_t step, const char *extension, struct status *status);

/* Removes the files of that extension from a step on, and what an interrupted replacement left of any. A folder that does not
 * exist is fine. */
bool numbered_remove(const char *folder, int64_t from, const char *extension, struct status *status);

/* Removes all of that extension, and the folder unless something else is in it. */
bool numbered_remove_folder(const char *folder, const char *extension, struct status *status);

#endif
