#include "base/c_locale.h"

/* newlocale cannot fail here: "C" is a constant of the C library. */
locale_t c_locale_enter(void)
{
  return uselocale(newlocale(LC_ALL_MASK, "C", (locale_t)0));
}

void c_locale_leave(locale_t before)
{
  const locale_t ours = uselocale(before);
  if (ours != before) freelocale(ours);
}
