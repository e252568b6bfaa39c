#include "base/threads.h"

#include <omp.h>

int threads_for(int64_t cells)
{
  const int64_t shares = cells / 4096;
  const int most = omp_get_max_threads();
  return shares < 1 ? 1 : shares < most ? (int)shares : most;
}
