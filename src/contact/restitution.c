#include "contact/restitution.h"

#include <assert.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_roots.h>

/* -ln e less the value wanted, at zeta = sin(angle). */
static double surplus(double angle, void *wanted)
{
  return (M_PI - 2 * angle) * tan(angle) - *(const double *)wanted;
}

/* Brent's method. The state is not from gsl_root_fsolver_alloc, which aborts for want of memory under GSL's default
 * error handler. */
static double root_of(gsl_function *function, double low, double high)
{
  double state[32];
  gsl_root_fsolver solver = {.type = gsl_root_fsolver_brent, .state = state};
  assert(solver.type->size <= sizeof state);
  int result = gsl_root_fsolver_set(&solver, function, low, high);
  for (int k = 0; k < 100 && result == GSL_SUCCESS; k++) {
    if (gsl_root_test_interval(solver.x_lower, solver.x_upper, 0, 1e-15) == GSL_SUCCESS) break;
    result = gsl_root_fsolver_iterate(&solver);
  }
  return solver.root;
}

double restitution_damping(double restitution, double exponent)
{
  const double max_angle = 1.5; /* e = 0.136 */
  double wanted = -log(restitution);
  gsl_function function = {.function = surplus, .params = &wanted};
  const double zeta = wanted > 0 ? sin(root_of(&function, 0, max_angle)) : 0;
  return zeta * sqrt((exponent + 1) / (2 * exponent));
}
