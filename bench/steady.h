/* The limit of a quantity that approaches a steady state. Samples u at equal intervals with a transient exp(-t/T)
 * have the limit u - d^2/(d - d'), d and d' the last two changes (Aitken 1926). The limit is accepted after three
 * consecutive estimates that agree, with u within 1 % of them: at larger distance a second transient can make
 * estimates agree by chance. */
#ifndef DELBM_BENCH_STEADY_H
#define DELBM_BENCH_STEADY_H

#include <stdbool.h>

struct steady {
  double enough; /* largest relative difference of limits that agree */
  double limit;  /* estimate, from the third sample on */
  double value, change;
  int samples, agreeing;
};

/* Adds the next sample; true once the limit is accepted. */
bool steady_add(struct steady *steady, double value);

#endif
