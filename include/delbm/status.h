/* Results of calls: a code, and a message for a person. The codes are also the exit codes of the `delbm` program. */
#ifndef DELBM_STATUS_H
#define DELBM_STATUS_H

/* Exported from the shared library. */
#define DELBM_API __attribute__((visibility("default")))

enum delbm_code {
  DELBM_OK = 0,
  DELBM_FAILED = 1,        /* the run failed: it diverged, or memory ran out */
  DELBM_USAGE = 2,         /* invalid command line or argument */
  DELBM_INVALID = 3,       /* invalid case, or too large for this machine */
  DELBM_IO = 4,            /* reading or writing a file failed */
  DELBM_HUNG_UP = 129,     /* by SIGHUP, after a checkpoint */
  DELBM_INTERRUPTED = 130, /* by SIGINT, after a checkpoint */
  DELBM_TERMINATED = 143   /* by SIGTERM, after a checkpoint */
};

enum { DELBM_MESSAGE = 4096 };

/* Filled by a call that did not return DELBM_OK. The message is UTF-8 without a final newline. For an invalid case
 * it has a line for each error, up to the size of the array. */
struct delbm_status {
  enum delbm_code code;
  char message[DELBM_MESSAGE];
};

#endif
