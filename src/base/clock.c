#include "base/clock.h"

#include <time.h>

const char *stage_name(enum stage stage)
{
  static const char *const names[STAGE_COUNT] = {"occupation", "contact", "exchange", "sweep", "boundary", "output"};
  return names[stage];
}

double clock_now(void)
{
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}
