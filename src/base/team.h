/* What the threads of a parallel region agree on: whether one of them has failed, and of what.
 *
 * A thread that fails says so at any time and goes on. Whether to leave is decided at the points below, inside of the
 * `single` construct that ends a stage, and read behind its barrier: all threads read the same and leave together, so
 * that none waits at a barrier that another never reaches. Each point has a flag of its own, written once a step: one
 * flag for all of them could be written again, by a thread that is ahead, before the slowest has read it. A stage
 * returns false to all threads where they are to leave. */
#ifndef DELBM_BASE_TEAM_H
#define DELBM_BASE_TEAM_H

#include "base/status.h"

/* Where threads may leave a step, in the order in which it comes by. */
enum team_point {
  TEAM_EXCHANGED,
  TEAM_SEARCHED, /* for pairs, by linked cells */
  TEAM_MET,      /* contacts are known */
  TEAM_MOVED,
  TEAM_LISTED, /* discs, by bands */
  TEAM_PAINTED,
  TEAM_KEPT, /* by the rows in which they are looked for */
  TEAM_POINTS
};

struct team {
  bool failed;            /* one thread has failed */
  bool stop[TEAM_POINTS]; /* all threads are to leave there */
  struct status first;    /* the first failure */
};

/* Records a failure; the first one stays. */
void team_fail(struct team *team, const struct status *status);

/* Decides whether to leave at this point. Inside of a `single`. */
static inline void team_decide(struct team *team, enum team_point point)
{
  team->stop[point] = team->failed;
}

#endif
