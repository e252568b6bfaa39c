#ifndef DELBM_BASE_CLOCK_H
#define DELBM_BASE_CLOCK_H

/* Seconds of a monotonic clock. */
double clock_now(void);

#endif
