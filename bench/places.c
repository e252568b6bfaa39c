#include "places.h"

#include <math.h>

struct offset place_offset(int k)
{
  static const double at[] = {0, 0.25, 0.5}, weight[] = {0.25, 0.5, 0.25};
  const int x = k % 3, y = k / 3;
  return (struct offset){at[x], at[y], weight[x] * weight[y]};
}

void deviations_add(struct deviations *all, double deviation, double weight)
{
  const double size = fabs(deviation);
  all->mean += weight * deviation;
  all->error += weight * size;
  all->worst = isnan(size) || isnan(all->worst) ? NAN : fmax(all->worst, size);
}
