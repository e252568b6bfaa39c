/* Moments of a cell from its nine deviations g_i = f_i - w_i: rho = 1 + sum g_i, j = sum e_i g_i, and with a force F
 * the velocity (j + F/2)/rho.
 *
 * diagnostics_totals adds the sums of rows in an ordered section, in the order of y. diagnostics_worst finds the
 * worst row with the vectorised scan_row, each thread over its own rows, and then the cell within this row; of equal
 * rows the lower y is taken. Both results therefore have the same bits for any number of threads. Nothing is written
 * but the results: no race. */
#include "sim/diagnostics.h"

#include "base/threads.h"

#include <math.h>

struct cell_moments {
  double excess, jx, jy; /* rho - 1, j */
};

/* Of the cell x cells to the right of the addresses a. */
static inline struct cell_moments moments_from(void *const a[Q], enum precision precision, int x)
{
  double g[Q];
  for (int i = 0; i < Q; i++)
    g[i] = precision == PRECISION_DOUBLE ? ((const double *)a[i])[x] : (double)((const float *)a[i])[x];
  struct cell_moments m = {0};
  for (int i = 0; i < Q; i++) {
    m.excess += g[i];
    m.jx += d2q9_ex[i] * g[i];
    m.jy += d2q9_ey[i] * g[i];
  }
  return m;
}

/* rho |u|^2/2. */
static double kinetic_energy(const struct cell_moments *m, const struct fluid_force *f)
{
  const double rho = 1 + m->excess, px = m->jx + (rho * f->per_mass[0] + f->uniform[0]) / 2,
               py = m->jy + (rho * f->per_mass[1] + f->uniform[1]) / 2;
  return (px * px + py * py) / (2 * rho);
}

struct fluid_totals diagnostics_totals(const struct populations *p, const struct fluid_force *force)
{
  struct fluid_totals totals = {0};
#pragma omp parallel for ordered schedule(static, 1) num_threads(threads_for((int64_t)p->nx * p->ny))
  for (int y = 0; y < p->ny; y++) {
    struct fluid_totals row = {0};
    void *a[Q];
    populations_cells(p, 0, y, a);
    for (int x = 0; x < p->nx; x++) {
      const struct cell_moments m = moments_from(a, p->precision, x);
      row.excess_mass += m.excess;
      row.jx += m.jx;
      row.jy += m.jy;
      row.kinetic += kinetic_energy(&m, force);
    }
#pragma omp ordered
    {
      totals.excess_mass += row.excess_mass;
      totals.jx += row.jx;
      totals.jy += row.jy;
      totals.kinetic += row.kinetic;
    }
  }
  return totals;
}

void fluid_mean_velocity(const struct fluid_totals *totals, double cells, const struct fluid_force *force,
                         double mean[2])
{
  const double mass = cells + totals->excess_mass, momentum[2] = {totals->jx, totals->jy};
  for (int axis = 0; axis < 2; axis++)
    mean[axis] = (momentum[axis] + (mass * force->per_mass[axis] + cells * force->uniform[axis]) / 2) / mass;
}

/* The cell of row y to report: the first that is not finite, otherwise the fastest. */
static struct worst_cell worst_of_row(const struct populations *p, int y)
{
  struct worst_cell worst = {.speed2 = -1, .y = y};
  void *a[Q];
  populations_cells(p, 0, y, a);
  for (int x = 0; x < p->nx; x++) {
    const struct cell_moments m = moments_from(a, p->precision, x);
    const double rho = 1 + m.excess, speed2 = (m.jx * m.jx + m.jy * m.jy) / (rho * rho);
    if (!isfinite(speed2) || rho <= 0) return (struct worst_cell){NAN, x, y};
    if (speed2 > worst.speed2) worst = (struct worst_cell){speed2, x, y};
  }
  return worst;
}

/* Order of severity: not finite, then faster. */
static bool worse(double a, double b)
{
  return isnan(a) ? !isnan(b) : a > b;
}

struct worst_cell diagnostics_worst(const struct populations *p, scan_row *scan)
{
  double worst = -1;
  int row = 0;
#pragma omp parallel num_threads(threads_for((int64_t)p->nx * p->ny))
  {
    double own = -1;
    int own_row = 0;
#pragma omp for schedule(static) nowait
    for (int y = 0; y < p->ny; y++) {
      void *a[Q];
      populations_cells(p, 0, y, a);
      const double speed2 = scan(a, p->nx);
      if (worse(speed2, own)) own = speed2, own_row = y;
    }
#pragma omp critical(delbm_worst_cell)
    if (worse(own, worst) || (!worse(worst, own) && own_row < row)) worst = own, row = own_row;
  }
  return worst_of_row(p, row);
}

double diagnostics_largest_speed(const struct populations *p)
{
  double largest = 0;
#pragma omp parallel for schedule(static) reduction(max : largest) num_threads(threads_for((int64_t)p->nx * p->ny))
  for (int y = 0; y < p->ny; y++) {
    void *a[Q];
    populations_cells(p, 0, y, a);
    for (int x = 0; x < p->nx; x++) {
      const struct cell_moments m = moments_from(a, p->precision, x);
      const double speed = hypot(m.jx, m.jy) / fabs(1 + m.excess);
      if (isfinite(speed) && speed > largest) largest = speed;
    }
  }
  return largest;
}

void diagnostics_row(const struct populations *p, const struct fluid_force *force, int y, double *density, double *ux,
                     double *uy)
{
  void *a[Q];
  populations_cells(p, 0, y, a);
  for (int x = 0; x < p->nx; x++) {
    const struct cell_moments m = moments_from(a, p->precision, x);
    const double rho = 1 + m.excess;
    if (density) density[x] = rho;
    if (ux) ux[x] = (m.jx + (rho * force->per_mass[0] + force->uniform[0]) / 2) / rho;
    if (uy) uy[x] = (m.jy + (rho * force->per_mass[1] + force->uniform[1]) / 2) / rho;
  }
}

void diagnostics_fields(const struct populations *p, const struct fluid_force *force, double *density, double *ux,
                        double *uy)
{
#pragma omp parallel for schedule(static) num_threads(threads_for((int64_t)p->nx * p->ny))
  for (int y = 0; y < p->ny; y++) {
    const size_t at = (size_t)y * (size_t)p->nx;
    diagnostics_row(p, force, y, density ? density + at : NULL, ux ? ux + at : NULL, uy ? uy + at : NULL);
  }
}
