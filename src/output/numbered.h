/* Files named by their step, in eight digits or more: frames/00000500.png, fields/00000500.h5. */
#ifndef DELBM_OUTPUT_NUMBERED_H
#define DELBM_OUTPUT_NUMBERED_H

#include "base/status.h"

#include <stdint.h>

/* folder/NNNNNNNN.extension, released by free(); NULL when memory runs out. */
char *numbered_path(const char *folder, int64_t step, const char *extension, struct status *status);

/* Removes the files of the extension from step `from` on, and temporary files of interrupted replacements. A missing
 * folder is no error. */
bool numbered_remove(const char *folder, int64_t from, const char *extension, struct status *status);

/* Removes all files of the extension, and the folder if empty. */
bool numbered_remove_folder(const char *folder, const char *extension, struct status *status);

#endif
