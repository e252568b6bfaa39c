/* Files and folders of a run: every failure is DELBM_IO with the path and the system's reason. */
#ifndef DELBM_OUTPUT_FILE_H
#define DELBM_OUTPUT_FILE_H

#include "base/status.h"

#include <stdint.h>
#include <stdio.h>

/* A file written beside its final place, as NAME.tmp, and moved there once complete, so that no reader ever sees half of
 * it. A link of either name is replaced, and not followed. All happens in the folder that the path led to at first, wherever
 * that is moved to meanwhile. */
struct replacement {
  FILE *stream;
  int folder; /* descriptor */
  char *path;
  char *temporary;
};

/* "cannot VERB PATH: reason"; returns false. An error of 0 is one that the system did not name. */
bool file_fail(struct status *status, const char *verb, const char *path, int error);

/* directory/name, released by free(); NULL when memory runs out. */
char *file_join(const char *directory, const char *name, struct status *status);

/* Makes a folder and those above it. One that exists is fine. */
bool file_make_directory(const char *path, struct status *status);

/* Forces what was written to a file to the disk. */
bool file_sync(int descriptor, const char *path, struct status *status);

/* Where a file ends, bytes; less than 0 on failure. */
int64_t file_end(int descriptor, const char *path, struct status *status);

/* The same of one that must not have become shorter since a checkpoint. */
bool file_reaches(int descriptor, const char *path, int64_t length, struct status *status);

/* Removes a file. One that does not exist is fine. */
bool file_remove(const char *path, struct status *status);

/* Opens a new file of that name, with the given O_ flags. What had the name is removed, be it a link or a FIFO, and not
 * written to; only a device is opened as it is. -1 on failure. The second does it for a stream; NULL on failure. */
int file_create(const char *path, int flags, struct status *status);
FILE *file_create_stream(const char *path, struct status *status);

/* Opens a file of a run that goes on, to write in it: a plain file, no link, of that name alone. -1 on failure. */
int file_reopen(const char *path, int flags, struct status *status);

/* Opens a plain file, or a link to one, for reading: no FIFO, which would be waited for. NULL on failure. */
FILE *file_open_stream(const char *path, struct status *status);

/* False unless the path still leads to the file or folder that is open: else what is written would be lost. */
bool file_stays(int descriptor, const char *path, struct status *status);

/* Between begin and commit the caller writes to file->stream, whose error flag commit checks. Either of commit and
 * abandon ends the replacement; after a failed commit the file that was there before still stands. */
bool replacement_begin(struct replacement *file, const char *path, struct status *status);
bool replacement_commit(struct replacement *file, struct status *status);
/* The same, forced to the disk before and after the move: neither a crash of the machine leaves half a file. */
bool replacement_commit_durably(struct replacement *file, struct status *status);
void replacement_abandon(struct replacement *file);

#endif
