/* Crowds of dry discs with friction: slope of heaps, run-out of columns; larger in bench/README.md, grains. */
#include "column.h"

#include <criterion/criterion.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>

static struct column run(struct column c)
{
  struct status status;
  omp_set_num_threads(1); /* so few discs gain nothing from more */
  c.restitution = 0.5;
  cr_assert(column_run(&c, &status), "%s", status.message);
  return c;
}

/* Mean slope in degrees, and standard deviation over the seeds. */
static double slope_of_heaps(double friction, double *deviation)
{
  enum { SEEDS = 3 };
  double sum = 0, squares = 0;
  for (int k = 1; k <= SEEDS; k++) {
    const struct column c = run((struct column){.discs = 150, .aspect = 1, .friction = friction, .seed = (uint64_t)k});
    sum += c.slope;
    squares += c.slope * c.slope;
  }
  *deviation = sqrt(fmax(0, (squares - sum * sum / SEEDS) / (SEEDS - 1)));
  return sum / SEEDS;
}

Test(heap, is_flat_without_friction_and_steeper_with_more_by_more_than_the_spread)
{
  double spread[3];
  const double none = slope_of_heaps(0, &spread[0]), some = slope_of_heaps(0.2, &spread[1]),
               much = slope_of_heaps(0.8, &spread[2]);
  cr_expect_lt(fabs(none), 2, "%g degrees without friction", none);
  cr_expect_gt(some - none, spread[0] + spread[1], "%g +- %g, then %g +- %g", none, spread[0], some, spread[1]);
  cr_expect_gt(much - some, spread[1] + spread[2], "%g +- %g, then %g +- %g", some, spread[1], much, spread[2]);
}

/* Staron & Hinch 2005: 2.5 a below a = 2, 3.25 a^0.7 above, for 1000 discs and more; from 1 to 4 that is an exponent of 0.88. */
Test(column, runs_out_within_a_quarter_of_the_published_law_at_two_aspect_ratios)
{
  static const double wanted[] = {1, 4};
  double a[2], run_out[2];
  for (int k = 0; k < 2; k++) {
    const struct column c = run((struct column){.discs = 600, .aspect = wanted[k], .friction = 0.5, .seed = 1});
    a[k] = c.height / c.width;
    run_out[k] = c.run_out;
    const double law = a[k] < 2 ? 2.5 * a[k] : 3.25 * pow(a[k], 0.7);
    cr_expect_float_eq(c.run_out / law, 1, 0.25, "a = %g: %g times the law", a[k], c.run_out / law);
    cr_expect_lt(c.max_overlap, 0.05, "a = %g: overlap %g", a[k], c.max_overlap);
    cr_expect_lt(c.apart, 90, "a = %g: %zu discs have left", a[k], c.apart);
  }
  const double exponent = log(run_out[1] / run_out[0]) / log(a[1] / a[0]);
  cr_expect(exponent > 0.7 && exponent < 1, "exponent %g", exponent);
}
