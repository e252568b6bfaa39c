#include "contact/contact_kernel.h"

#include "base/processor.h"

#include <string.h>

extern const struct contact_kernel contact_kernel_baseline;
#ifdef __x86_64__
extern const struct contact_kernel contact_kernel_avx2, contact_kernel_avx512;
#endif

const struct contact_kernel *contact_kernel_find(const char *name)
{
#ifdef __x86_64__
  if (processor_has_avx512() && (!name || strncmp(name, "avx512", 6) == 0)) return &contact_kernel_avx512;
  if (processor_has_avx2() && (!name || strncmp(name, "avx2", 4) == 0)) return &contact_kernel_avx2;
#endif
  (void)name;
  return &contact_kernel_baseline;
}
