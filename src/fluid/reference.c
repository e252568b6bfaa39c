#include "fluid/reference.h"

#include "base/memory.h"
#include "fluid/boundary.h"
#include "lattice/moments.h"

#include <stdlib.h>

bool reference_create(struct reference *r, int nx, int ny, struct status *status)
{
  const size_t count = (size_t)nx * (size_t)ny * Q;
  *r = (struct reference){.nx = nx, .ny = ny};
  r->f = memory_allocate(count, sizeof *r->f, "the reference populations", status);
  if (r->f) r->collided = memory_allocate(count, sizeof *r->collided, "the reference populations", status);
  if (!r->f || !r->collided) {
    reference_destroy(r);
    return false;
  }
  for (size_t k = 0; k < count; k++) r->f[k] = d2q9_weight[k % Q];
  return true;
}

void reference_destroy(struct reference *r)
{
  free(r->f);
  free(r->collided);
  *r = (struct reference){0};
}

/* The rate of even moments under a drag k = B/(1 - B): of owen for the mean of a moment before and after collision, whose
 * change is -mean/(Lambda + k/2) (see sweep_kernel.c). */
static double midpoint_even(double s_nu, double b)
{
  const double lambda = 1 / s_nu - 0.5;
  return b < 1 ? 1 / (lambda + b / (1 - b) / 2 + 0.5) : 0;
}

/* What q gains, from dq = -(mean q + mean j)/Lambda - 2 k mean q, with dj = -2 B j. */
static double midpoint_odd(double s_q, double b, double q, double j)
{
  const double lambda = 1 / s_q - 0.5, k = b / (1 - b);
  return b < 1 ? -((q + j - b * j) / lambda + 2 * k * q) / (1 + 1 / (2 * lambda) + k) : -2 * q;
}

/* The rate of qx and qy at a velocity. */
static double rate_of_q(const struct rates *rates, double rho, double ux, double uy)
{
  const double viscosity = (1 / rates->nu - 0.5) / 3;
  if (rates->q_fast == 0) return rates->q;
  const double fast = rho * (ux * ux + uy * uy) / (viscosity * viscosity);
  return (rates->q + rates->q_fast * fast) / (1 + fast);
}

/* One cell: (1), (12), (17), with the force of Guo, Zheng & Shi (2002). `b`, `bv`: cover of the cell. */
static void collide(const double f[Q], const struct sweep_constants *c, enum coupling_form form, double b,
                    const double bv[2], double collided[Q])
{
  double m[Q], target[Q], force_low[Q], force_high[Q], after[Q];
  moments_from_populations(f, m);
  const double rho = m[M_RHO], Fx = rho * c->force[0] + c->uniform[0], Fy = rho * c->force[1] + c->uniform[1];
  /* equilibria are quadratic in j: their difference over +-F/2 about j + F/2 is exactly the force's moments */
  moments_equilibrium(rho, m[M_JX] + Fx / 2, m[M_JY] + Fy / 2, target);
  moments_equilibrium(rho, m[M_JX], m[M_JY], force_low);
  moments_equilibrium(rho, m[M_JX] + Fx, m[M_JY] + Fy, force_high);

  const double slow = form == FORM_MIDPOINT ? midpoint_even(c->rates.nu, b) / c->rates.nu : 1;
  const double keep = form == FORM_OWEN ? 1 - b : slow, u[2] = {(m[M_JX] + Fx / 2) / rho, (m[M_JY] + Fy / 2) / rho};
  const double s_q = rate_of_q(&c->rates, rho, u[0], u[1]);
  const double nu = keep * c->rates.nu, e = keep * c->rates.e, q = form == FORM_OWEN ? keep * s_q : s_q;
  const double rate[Q] = {0, e, e, 0, q, 0, q, nu, nu};
  double unforced[Q], force[Q], reflected[Q];
  for (int k = 0; k < Q; k++) {
    after[k] = m[k] + rate[k] * (target[k] - m[k]);
    force_high[k] = (1 - rate[k] / 2) * (force_high[k] - force_low[k]);
  }
  /* the odd part in two: collision alone, which the unified form reflects, and then the force, whose halves about the
   * collision leave -F in q whatever the rate */
  after[M_JX] = m[M_JX];
  after[M_JY] = m[M_JY];
  after[M_QX] = m[M_QX] - q * (m[M_QX] + m[M_JX]);
  after[M_QY] = m[M_QY] - q * (m[M_QY] + m[M_JY]);
  if (form == FORM_MIDPOINT) { /* all that q gains, less what the reflection below adds */
    after[M_QX] = m[M_QX] + midpoint_odd(s_q, b, m[M_QX], m[M_JX]) + 2 * b * m[M_QX];
    after[M_QY] = m[M_QY] + midpoint_odd(s_q, b, m[M_QY], m[M_JY]) + 2 * b * m[M_QY];
  }
  force_high[M_QX] = -Fx;
  force_high[M_QY] = -Fy;
  populations_from_moments(after, unforced);
  populations_from_moments(force_high, force);

  const double *from = form == FORM_UNIFIED ? unforced : f;
  for (int i = 0; i < Q; i++) {
    const double ev = d2q9_ex[i] * bv[0] + d2q9_ey[i] * bv[1];
    const double pushed = 3 * d2q9_weight[i] * (d2q9_ex[i] * Fx + d2q9_ey[i] * Fy); /* by the force, odd part */
    reflected[i] = b * (from[d2q9_opposite[i]] - from[i] - 2 * pushed) + 6 * d2q9_weight[i] * rho * ev;
    collided[i] = unforced[i] + reflected[i] + force[i];
  }
}

/* The side that rules the link from outside; corners as in boundary.h. */
static const struct side *ruling_side(const struct side side[SIDE_COUNT], int sx, int sy, int nx, int ny)
{
  static const int order[] = {[SIDE_PERIODIC] = 0, [SIDE_OUTLET] = 1, [SIDE_INLET] = 2, [SIDE_WALL] = 3};
  const struct side *x = sx < 0 ? &side[SIDE_LEFT] : sx >= nx ? &side[SIDE_RIGHT] : NULL;
  const struct side *y = sy < 0 ? &side[SIDE_BOTTOM] : sy >= ny ? &side[SIDE_TOP] : NULL;
  if (!x || !y) return x ? x : y;
  return order[y->type] >= order[x->type] ? y : x;
}

static int wrap_or_clamp(int s, int n, bool periodic)
{
  if (s >= 0 && s < n) return s;
  return (s < 0) == periodic ? n - 1 : 0;
}

static double streamed(const struct reference *r, const struct side side[SIDE_COUNT], int x, int y, int i)
{
  const int sx = x - d2q9_ex[i], sy = y - d2q9_ey[i];
  const struct side *ruling = ruling_side(side, sx, sy, r->nx, r->ny);
  if (ruling && (ruling->type == SIDE_WALL || ruling->type == SIDE_INLET)) {
    const size_t own = ((size_t)y * (size_t)r->nx + (size_t)x) * Q;
    return r->collided[own + (size_t)d2q9_opposite[i]] + d2q9_wall_momentum(i, ruling->velocity);
  }
  const int fx = wrap_or_clamp(sx, r->nx, side[SIDE_LEFT].type == SIDE_PERIODIC);
  const int fy = wrap_or_clamp(sy, r->ny, side[SIDE_BOTTOM].type == SIDE_PERIODIC);
  const double *from = r->collided + ((size_t)fy * (size_t)r->nx + (size_t)fx) * Q;
  double excess = -1;
  for (int k = 0; k < Q; k++) excess += from[k];
  const bool outlet = ruling && ruling->type == SIDE_OUTLET;
  return from[i] - (outlet ? boundary_outlet_hold(r->nx, r->ny) * d2q9_weight[i] * excess : 0);
}

void reference_step(struct reference *r, const struct side side[SIDE_COUNT], const struct sweep_constants *constants,
                    const struct reference_cover *cover)
{
  const size_t cells = (size_t)r->nx * (size_t)r->ny;
  for (size_t k = 0; k < cells; k++) {
    const double b = cover->b ? cover->b[k] : 0;
    const double bv[2] = {cover->b ? cover->bvx[k] : 0, cover->b ? cover->bvy[k] : 0};
    collide(r->f + k * Q, constants, cover->form, b, bv, r->collided + k * Q);
  }
  for (int y = 0; y < r->ny; y++)
    for (int x = 0; x < r->nx; x++)
      for (int i = 0; i < Q; i++)
        r->f[((size_t)y * (size_t)r->nx + (size_t)x) * Q + (size_t)i] = streamed(r, side, x, y, i);
}
