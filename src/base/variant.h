/* For sources that are compiled once per instruction set: names with the suffix VARIANT, and loops over whole vectors. */
#ifndef DELBM_BASE_VARIANT_H
#define DELBM_BASE_VARIANT_H

#define VARIANT_PASTE(a, b)   a##_##b
#define VARIANT_NAME_OF(a, b) VARIANT_PASTE(a, b)
#define KERNEL(part)          VARIANT_NAME_OF(part, VARIANT)

enum { VECTOR = 8 };

/* n rounded up to whole vectors; the mask tells the compiler that such loops have no remainder, so that an element's
 * bits do not depend on its position. */
static inline int whole_vectors(int n)
{
  return (n + VECTOR - 1) & -VECTOR;
}

/* Compilers keep fmax and fmin out of vectors. */
static inline double max_of(double a, double b)
{
  return a > b ? a : b;
}

static inline double min_of(double a, double b)
{
  return a < b ? a : b;
}

#endif
