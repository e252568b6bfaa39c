#include "fluid/sweep.h"

#include "base/processor.h"

#include <string.h>

#define DECLARE(variant)                                                                                               \
  extern const struct sweep_kernel sweep_kernel_##variant##_double, sweep_kernel_##variant##_float;
DECLARE(baseline)
#ifdef __x86_64__
DECLARE(avx2)
DECLARE(avx512)
#endif

static bool always(void)
{
  return true;
}

static const struct {
  const struct sweep_kernel *kernel;
  bool (*runs_here)(void);
} kernels[] = {
#ifdef __x86_64__
    {&sweep_kernel_avx512_double, processor_has_avx512},
    {&sweep_kernel_avx512_float, processor_has_avx512},
    {&sweep_kernel_avx2_double, processor_has_avx2},
    {&sweep_kernel_avx2_float, processor_has_avx2},
#endif
    {&sweep_kernel_baseline_double, always},
    {&sweep_kernel_baseline_float, always},
};
enum { KERNELS = sizeof kernels / sizeof kernels[0] };

const struct sweep_kernel *sweep_kernel_at(size_t index, bool *runs_here)
{
  if (index >= KERNELS) return NULL;
  *runs_here = kernels[index].runs_here();
  return kernels[index].kernel;
}

static bool name_matches(const char *name, const struct sweep_kernel *kernel)
{
  size_t length = strlen(name); /* a name may lack the precision: "avx2" is avx2-double or avx2-single */
  return strncmp(kernel->name, name, length) == 0 && (kernel->name[length] == '\0' || kernel->name[length] == '-');
}

const struct sweep_kernel *sweep_find(const char *name, enum precision precision, struct status *status)
{
  for (size_t i = 0; i < KERNELS; i++) {
    const struct sweep_kernel *kernel = kernels[i].kernel;
    if (kernel->precision != precision || (name && !name_matches(name, kernel))) continue;
    if (kernels[i].runs_here()) return kernel;
    if (name) {
      status_fail(status, DELBM_INVALID, "fluid.kernel: %s needs instructions that this processor lacks", name);
      return NULL;
    }
  }
  status_fail(status, DELBM_INVALID, "fluid.kernel: got %s; `delbm bench --list` names the kernels of each precision",
              name ? name : "none");
  return NULL;
}
