/* Eight doubles at a time: GCC's and clang's portable vectors, for loops over runs so short that their ends would cost
 * more than their middle. The compiler makes of them what the instruction set has. Included by kernels only. */
#ifndef DELBM_BASE_LANES_H
#define DELBM_BASE_LANES_H

enum { LANES = 8 };

typedef double lanes __attribute__((vector_size(64)));

/* Elements in memory, at any address. */
typedef double lanes_in_doubles __attribute__((vector_size(64), aligned(8), may_alias));
typedef float lanes_in_floats __attribute__((vector_size(32), aligned(4), may_alias));

static const lanes lanes_count = {0, 1, 2, 3, 4, 5, 6, 7};

static inline __attribute__((always_inline)) lanes lanes_load(const double *from)
{
  return *(const lanes_in_doubles *)from;
}

/* One in the first n lanes (n > 0; all if there are more), zero in the others. */
static inline __attribute__((always_inline)) lanes lanes_first(int n)
{
  static const double ones_and_zeros[2 * LANES] = {1, 1, 1, 1, 1, 1, 1, 1};
  return lanes_load(ones_and_zeros + (n < LANES ? LANES - n : 0));
}

/* The sum of all lanes, pairwise. */
static inline __attribute__((always_inline)) double lanes_sum(lanes v)
{
  return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

#endif
