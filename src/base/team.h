/* Agreement of the threads of a parallel region on failure.
 *
 * A thread records its failure at any time and continues to the end of the stage. There, one thread inside a `single`
 * construct copies `failed` to a flag that belongs to this place of the stage; all threads read the flag after the
 * barrier of the construct. They thus read the same value and leave together, so that no thread waits at a barrier that
 * another one never reaches. One flag per place: a flag that several stages wrote could be overwritten by a fast thread
 * before the slowest one has read it. A stage returns false to all threads if they are to leave. */
#ifndef DELBM_BASE_TEAM_H
#define DELBM_BASE_TEAM_H

#include "base/status.h"

struct team {
  bool failed;         /* at least one thread has failed */
  struct status first; /* the first failure */
};

/* Records a failure; later failures than the first are ignored. */
void team_fail(struct team *team, const struct status *status);

/* Sets the flag of a place in a stage: true if all threads are to leave there. To be called inside a `single`. */
static inline void team_decide(const struct team *team, bool *leave)
{
  *leave = team->failed;
}

#endif
