#include "steady.h"

#include <math.h>

bool steady_add(struct steady *s, double value)
{
  const double change = value - s->value, curve = change - s->change, before = s->limit;
  s->limit = s->samples >= 2 && curve != 0 ? value - change * change / curve : value;
  s->value = value;
  s->change = change;
  s->samples++;
  const double size = fabs(s->limit);
  const bool agrees = s->samples > 3 && fabs(s->limit - before) <= s->enough * size;
  s->agreeing = agrees && fabs(s->limit - value) <= 0.01 * size ? s->agreeing + 1 : 0;
  return s->agreeing >= 2;
}
