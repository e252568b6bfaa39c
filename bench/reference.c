#include "reference.h"

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
  for (int s = 0; s < SIDE_COUNT; s++)
    r->ghost[s] = memory_allocate(count / Q, sizeof *r->ghost[s], "the reference outlets", status);
  if (!r->f || !r->collided || !r->ghost[0] || !r->ghost[1] || !r->ghost[2] || !r->ghost[3]) {
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
  for (int s = 0; s < SIDE_COUNT; s++) free(r->ghost[s]);
  *r = (struct reference){0};
}

/* Rate of even moments in the midpoint form: the change is -mean/(Lambda + k/2), k = B/(1 - B) (sweep_kernel.c). */
static double midpoint_even(double s_nu, double b)
{
  const double lambda = 1 / s_nu - 0.5;
  return b < 1 ? 1 / (lambda + b / (1 - b) / 2 + 0.5) : 0;
}

/* Change of q in the midpoint form: dq = -(mean q + mean j)/Lambda - 2 k mean q, with dj = -2 B j. */
static double midpoint_odd(double s_q, double b, double q, double j)
{
  const double lambda = 1 / s_q - 0.5, k = b / (1 - b);
  return b < 1 ? -((q + j - b * j) / lambda + 2 * k * q) / (1 + 1 / (2 * lambda) + k) : -2 * q;
}

/* s_q at a velocity (adaptive rates, sweep_kernel.c). */
static double rate_of_q(const struct rates *rates, double rho, double ux, double uy)
{
  const double viscosity = (1 / rates->s_nu - 0.5) / 3;
  if (rates->s_q_fast == 0) return rates->s_q;
  const double fast = rho * (ux * ux + uy * uy) / (viscosity * viscosity);
  return (rates->s_q + rates->s_q_fast * fast) / (1 + fast);
}

/* One cell: (1), (12), (17) of the paper, with the force of Guo, Zheng & Shi (2002). b = B, bv = B v. */
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

  const double slow = form == FORM_MIDPOINT ? midpoint_even(c->rates.s_nu, b) / c->rates.s_nu : 1;
  const double keep = form == FORM_OWEN ? 1 - b : slow, u[2] = {(m[M_JX] + Fx / 2) / rho, (m[M_JY] + Fy / 2) / rho};
  const double s_q = rate_of_q(&c->rates, rho, u[0], u[1]);
  const double nu = keep * c->rates.s_nu, e = keep * c->rates.s_e, q = form == FORM_OWEN ? keep * s_q : s_q;
  const double rate[Q] = {0, e, e, 0, q, 0, q, nu, nu};
  double unforced[Q], force[Q], reflected[Q];
  for (int k = 0; k < Q; k++) {
    after[k] = m[k] + rate[k] * (target[k] - m[k]);
    force_high[k] = (1 - rate[k] / 2) * (force_high[k] - force_low[k]);
  }
  /* odd moments in two parts: the collision, which the unified form reflects; then the force, which adds -F to q at
   * any rate */
  after[M_JX] = m[M_JX];
  after[M_JY] = m[M_JY];
  after[M_QX] = m[M_QX] - q * (m[M_QX] + m[M_JX]);
  after[M_QY] = m[M_QY] - q * (m[M_QY] + m[M_JY]);
  if (form == FORM_MIDPOINT) { /* the change of q, less the part that the reflection below adds */
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
    const double pushed = 3 * d2q9_weight[i] * (d2q9_ex[i] * Fx + d2q9_ey[i] * Fy); /* odd part of the force */
    reflected[i] = b * (from[d2q9_opposite[i]] - from[i] - 2 * pushed) + 6 * d2q9_weight[i] * rho * ev;
    collided[i] = unforced[i] + reflected[i] + force[i];
  }
}

static bool is_outlet(const struct side *side)
{
  return side && side->type == SIDE_OUTLET;
}

static bool is_slip(const struct side *side)
{
  return side && side->type == SIDE_SLIP;
}

/* Population i seen in a mirror that reverses x or y. */
static size_t mirrored(int i, bool in_x)
{
  static const size_t image[2][Q] = {{0, 1, 4, 3, 2, 8, 7, 6, 5}, {0, 3, 2, 1, 4, 6, 5, 8, 7}};
  return image[in_x][i];
}

static int wrap_or_clamp(int s, int n, bool periodic)
{
  if (s >= 0 && s < n) return s;
  return (s < 0) == periodic ? n - 1 : 0;
}

/* Population i of cell (x, y) after streaming from (sx, sy), which lies inside, beyond one side, or beyond two. */
static double streamed(const struct reference *r, const struct side side[SIDE_COUNT], int x, int y, int i)
{
  const int sx = x - d2q9_ex[i], sy = y - d2q9_ey[i];
  const bool periodic_x = side[SIDE_LEFT].type == SIDE_PERIODIC, periodic_y = side[SIDE_BOTTOM].type == SIDE_PERIODIC;
  const struct side *past_x = periodic_x ? NULL : sx < 0 ? &side[SIDE_LEFT] : sx >= r->nx ? &side[SIDE_RIGHT] : NULL;
  const struct side *past_y = periodic_y ? NULL : sy < 0 ? &side[SIDE_BOTTOM] : sy >= r->ny ? &side[SIDE_TOP] : NULL;
  const size_t own = (size_t)y * (size_t)r->nx + (size_t)x;
  const size_t from =
      (size_t)wrap_or_clamp(sy, r->ny, periodic_y) * (size_t)r->nx + (size_t)wrap_or_clamp(sx, r->nx, periodic_x);
  const bool all_out = (past_x || past_y) && (!past_x || is_outlet(past_x)) && (!past_y || is_outlet(past_y));
  if (!past_x && !past_y) return r->collided[from * Q + (size_t)i];
  const struct side *other = is_slip(past_x) ? past_y : past_x; /* beside a slip side */
  if (is_slip(past_x) != is_slip(past_y) && (!other || is_outlet(other))) {
    const double cut = other ? r->ghost[other - side][from].cut : 0;
    return r->collided[from * Q + mirrored(i, is_slip(past_x))] - d2q9_weight[i] * cut;
  }
  if (all_out) {
    const double cut_x = past_x ? r->ghost[past_x - side][from].cut : r->ghost[past_y - side][from].cut;
    const double cut_y = past_y ? r->ghost[past_y - side][from].cut : cut_x;
    return r->collided[from * Q + (size_t)i] - d2q9_weight[i] * (cut_x + cut_y) / 2;
  }
  double u[2];
  for (int d = 0; d < 2; d++) {
    if (!past_y || is_outlet(past_y))
      u[d] = past_x->velocity[d];
    else if (!past_x || is_outlet(past_x))
      u[d] = past_y->velocity[d];
    else
      u[d] = d == 0 ? past_x->velocity[0] : past_y->velocity[1];
  }
  return r->collided[own * Q + (size_t)d2q9_opposite[i]] + d2q9_wall_momentum(i, u);
}

/* 3 (rho - j), j the momentum against (ex, ey). */
static double less_momentum(const double *f, int ex, int ey)
{
  double sum = 0;
  for (int i = 0; i < Q; i++) sum += 3 * f[i] * (1 + d2q9_ex[i] * ex + d2q9_ey[i] * ey);
  return sum;
}

static double density_of(const double *f)
{
  double sum = 0;
  for (int i = 0; i < Q; i++) sum += f[i];
  return sum;
}

/* Advances an outlet's ghost cell (fluid/boundary.c) beside a cell; (ex, ey) is the direction into the box. */
static void update_ghost(struct reference *r, enum side_name name, size_t cell, int ex, int ey)
{
  const double h = boundary_outlet_rate(r->nx, r->ny), *f = r->collided + cell * Q;
  const double now = less_momentum(f, ex, ey), rho = density_of(f);
  struct reference_ghost *ghost = &r->ghost[name][cell];
  if (!r->stepped) ghost->last = less_momentum(r->f + cell * Q, ex, ey);
  ghost->drift += h / 6 * (now - ghost->last + ghost->cut - ghost->drift);
  ghost->cut = h * (rho - 1 - ghost->cut / 2) + ghost->drift;
  ghost->last = now;
}

static void update_ghosts(struct reference *r, const struct side side[SIDE_COUNT])
{
  const size_t nx = (size_t)r->nx, ny = (size_t)r->ny;
  for (size_t y = 0; y < ny; y++) {
    if (is_outlet(&side[SIDE_LEFT])) update_ghost(r, SIDE_LEFT, y * nx, 1, 0);
    if (is_outlet(&side[SIDE_RIGHT])) update_ghost(r, SIDE_RIGHT, y * nx + nx - 1, -1, 0);
  }
  for (size_t x = 0; x < nx; x++) {
    if (is_outlet(&side[SIDE_BOTTOM])) update_ghost(r, SIDE_BOTTOM, x, 0, 1);
    if (is_outlet(&side[SIDE_TOP])) update_ghost(r, SIDE_TOP, (ny - 1) * nx + x, 0, -1);
  }
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
  update_ghosts(r, side);
  r->stepped = true;
  for (int y = 0; y < r->ny; y++)
    for (int x = 0; x < r->nx; x++)
      for (int i = 0; i < Q; i++)
        r->f[((size_t)y * (size_t)r->nx + (size_t)x) * Q + (size_t)i] = streamed(r, side, x, y, i);
}
