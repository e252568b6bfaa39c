/* Vectors of eight doubles (portable vector extension of GCC and clang), for loops over runs of about ten cells, whose
 * scalar remainder would take longer than the vector part. Included by kernels only. */
#ifndef DELBM_BASE_LANES_H
#define DELBM_BASE_LANES_H

enum { LANES = 8 };

typedef double lanes __attribute__((vector_size(64)));

/* Vectors in memory, aligned as their elements. */
typedef double lanes_in_doubles __attribute__((vector_size(64), aligned(8), may_alias));
typedef float lanes_in_floats __attribute__((vector_size(32), aligned(4), may_alias));

static const lanes lanes_count = {0, 1, 2, 3, 4, 5, 6, 7};

static inline __attribute__((always_inline)) lanes lanes_load(const double *from)
{
  return *(const lanes_in_doubles *)from;
}

/* 1 in the first min(n, 8) lanes (n > 0), 0 in the others. */
static inline __attribute__((always_inline)) lanes lanes_first(int n)
{
  static const double ones_and_zeros[2 * LANES] = {1, 1, 1, 1, 1, 1, 1, 1};
  return lanes_load(ones_and_zeros + (n < LANES ? LANES - n : 0));
}

/* Lane k of the result is the sum of the lanes of v[k], in the order ((0 + 4) + (2 + 6)) + ((1 + 5) + (3 + 7)). The
 * eight sums share each addition: 7 vector additions in place of 56 scalar ones. */
static inline __attribute__((always_inline)) lanes lanes_sums(const lanes v[8])
{
  lanes half[4], quarter[2];
  for (int k = 0; k < 4; k++)
    half[k] = __builtin_shufflevector(v[2 * k], v[2 * k + 1], 0, 1, 2, 3, 8, 9, 10, 11) +
              __builtin_shufflevector(v[2 * k], v[2 * k + 1], 4, 5, 6, 7, 12, 13, 14, 15);
  for (int k = 0; k < 2; k++)
    quarter[k] = __builtin_shufflevector(half[2 * k], half[2 * k + 1], 0, 1, 4, 5, 8, 9, 12, 13) +
                 __builtin_shufflevector(half[2 * k], half[2 * k + 1], 2, 3, 6, 7, 10, 11, 14, 15);
  return __builtin_shufflevector(quarter[0], quarter[1], 0, 2, 4, 6, 8, 10, 12, 14) +
         __builtin_shufflevector(quarter[0], quarter[1], 1, 3, 5, 7, 9, 11, 13, 15);
}

#endif
