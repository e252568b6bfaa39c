/* What the threads of a parallel region agree on: whether one of them has failed, and of what.
 *
 * A thread records its failure at any time and goes on. Whether all leave is decided inside the `single` construct that ends
 * a stage, and read behind the barrier of that construct: all threads read the same value and leave together, so that none
 * waits at a barrier that another never reaches. The decision is kept in a flag that belongs to the stage and is written
 * once a step: a flag shared by several stages could be written again, by a thread that is ahead, before the slowest
 * thread has read it. A stage returns false to all threads where they are to leave. */
#ifndef DELBM_BASE_TEAM_H
#define DELBM_BASE_TEAM_H

#include "base/status.h"

struct team {
  bool failed;         /* one thread has failed */
  struct status first; /* the first failure */
};

/* Records a failure; the first one stays. */
void team_fail(struct team *team, const struct status *status);

/* Decides whether all threads leave at a point of a stage, whose flag is *leave. Inside of a `single`. */
static inline void team_decide(const struct team *team, bool *leave)
{
  *leave = team->failed;
}

#endif
