/* Files and folders of a run. A failure is DELBM_IO, with the path and the reason of the system. */
#ifndef DELBM_OUTPUT_FILE_H
#define DELBM_OUTPUT_FILE_H

#include "base/status.h"

#include <stdint.h>
#include <stdio.h>

/* Atomic replacement of a file: written as NAME.tmp in the same folder and renamed when complete. A symbolic link with
 * either name is itself replaced. The folder is opened once, so that it may be moved meanwhile. */
struct replacement {
  FILE *stream;
  int folder; /* descriptor */
  char *path;
  char *temporary;
};

/* "cannot VERB PATH: reason"; returns false. Error 0: unknown reason. */
bool file_fail(struct status *status, const char *verb, const char *path, int error);

/* directory/name, released by free(); NULL when memory runs out. */
char *file_join(const char *directory, const char *name, struct status *status);

/* Creates a folder and its parents if they do not exist. */
bool file_make_directory(const char *path, struct status *status);

/* Forces the written data of a file to the disk (fsync). */
bool file_sync(int descriptor, const char *path, struct status *status);

/* Length of a file, bytes; negative on failure. */
int64_t file_end(int descriptor, const char *path, struct status *status);

/* Fails if the file is shorter than `length`, its length at a checkpoint. */
bool file_reaches(int descriptor, const char *path, int64_t length, struct status *status);

/* Removes a file if it exists. */
bool file_remove(const char *path, struct status *status);

/* Creates a file, with the O_ flags. An existing file, link or FIFO of that name is removed; a device is opened.
 * Returns a descriptor, or -1; or a stream, or NULL. */
int file_create(const char *path, int flags, struct status *status);
FILE *file_create_stream(const char *path, struct status *status);

/* Opens a file of a resumed run for writing: a plain file, without symbolic or further hard links. -1 on failure. */
int file_reopen(const char *path, int flags, struct status *status);

/* Opens a plain file, or a link to one, for reading; refuses FIFOs, on which reading would wait. NULL on failure. */
FILE *file_open_stream(const char *path, struct status *status);

/* Fails if the path no longer refers to the open file or folder: written data would be lost. */
bool file_stays(int descriptor, const char *path, struct status *status);

/* Between begin and commit the caller writes to file->stream; commit checks its error flag. commit and abandon end the
 * replacement. After a failed commit the former file is unchanged. */
bool replacement_begin(struct replacement *file, const char *path, struct status *status);
bool replacement_commit(struct replacement *file, struct status *status);
/* replacement_commit with data and folder forced to the disk: complete also after a crash of the machine. */
bool replacement_commit_durably(struct replacement *file, struct status *status);
void replacement_abandon(struct replacement *file);

#endif
