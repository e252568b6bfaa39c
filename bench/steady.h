/* When a flow has become steady, and what it would become: a quantity looked at in equal intervals, whose last transient
 * decays as exp(-t/T), has the limit u - d^2/(d - d'), d and d' its last two changes (Aitken 1926). Three limits in a row that
 * agree end the run, once u is within 1 % of them: farther away a second transient may hold them still for a while. */
#ifndef DELBM_BENCH_STEADY_H
#define DELBM_BENCH_STEADY_H

#include <stdbool.h>

struct steady {
  double enough; /* relative difference of limits that agree */
  double limit;  /* from the third look on */
  double value, change;
  int looks, agreeing;
};

/* The next look; true once the limit is known. */
bool steady_look(struct steady *steady, double value);

#endif
