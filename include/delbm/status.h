/* Result codes. They are also the exit codes of the `delbm` program. */
#ifndef DELBM_STATUS_H
#define DELBM_STATUS_H

enum delbm_code {
  DELBM_OK = 0,
  DELBM_FAILED = 1,        /* the run failed: it diverged, or memory ran out */
  DELBM_USAGE = 2,         /* the command line was not understood */
  DELBM_INVALID = 3,       /* the case is not valid */
  DELBM_IO = 4,            /* reading or writing a file failed */
  DELBM_INTERRUPTED = 130, /* by SIGINT, after a checkpoint */
  DELBM_TERMINATED = 143   /* by SIGTERM, after a checkpoint */
};

#endif
