#include "base/threads.h"

#include <omp.h>
#include <stdbool.h>
#include <stdio.h>

int threads_for(int64_t cells)
{
  const int64_t useful = cells / 4096;
  const int max = omp_get_max_threads();
  return useful < 1 ? 1 : useful < max ? (int)useful : max;
}

void threads_binding(char text[THREADS_TEXT])
{
  static const char *const policies[] = {"unbound", "bound", "primary", "close", "spread"}; /* as omp_proc_bind_t */
  const int policy = (int)omp_get_proc_bind(), places = omp_get_num_places();
  const bool known = policy >= 0 && policy < (int)(sizeof policies / sizeof policies[0]);
  if (policy == 0)
    snprintf(text, THREADS_TEXT, "%s", policies[0]);
  else
    snprintf(text, THREADS_TEXT, "%s over %d places", known ? policies[policy] : "bound", places);
}
