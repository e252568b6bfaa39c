/* What the threads of a parallel region agree on: whether one of them has failed, and of what.
 *
 * A thread that fails says so at any time and goes on. Whether to leave is read from `stop`, which changes only inside
 * of the `single` constructs that end a stage: all threads read the same value behind that construct's barrier and
 * leave together, so that none waits at a barrier that another never reaches. */
#ifndef DELBM_BASE_TEAM_H
#define DELBM_BASE_TEAM_H

#include "base/status.h"

struct team {
  bool failed;         /* one thread has failed */
  bool stop;           /* all threads are to leave */
  struct status first; /* the first failure */
};

/* Records a failure; the first one stays. */
void team_fail(struct team *team, const struct status *status);

#endif
