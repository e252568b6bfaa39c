#include "base/team.h"

void team_fail(struct team *team, const struct status *status)
{
#pragma omp critical(delbm_team_fail)
  if (!team->failed) {
    team->first = *status;
    team->failed = true;
  }
}
