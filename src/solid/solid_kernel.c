#include "solid/solid_kernel.h"

#include "base/processor.h"

#include <string.h>

extern const struct solid_kernel solid_kernel_baseline;
#ifdef __x86_64__
extern const struct solid_kernel solid_kernel_avx2, solid_kernel_avx512;
#endif

const struct solid_kernel *solid_kernel_find(const char *name)
{
#ifdef __x86_64__
  if (processor_has_avx512() && (!name || strncmp(name, "avx512", 6) == 0)) return &solid_kernel_avx512;
  if (processor_has_avx2() && (!name || strncmp(name, "avx2", 4) == 0)) return &solid_kernel_avx2;
#endif
  (void)name;
  return &solid_kernel_baseline;
}
