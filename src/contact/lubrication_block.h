/* Sub-grid lubrication of a block of contacts (model: lubrication.h), included by contact_block.c.
 *
 * Three modes per contact, each a direction in the space of the motions of both bodies: V_a - V_b along g, spins w_a, w_b,
 *   approach     n, 0, 0
 *   slip         t, a_a, a_b
 *   entrainment  q t, a_a/2, -a_b/2,  q = (a_a - a_b)/(2 (a_a + a_b)), at a side -1/2
 * with the arms a of the contact point (solid/shape.h). The speed of a mode is the sum over its direction; so the slip speed
 * is that of the surfaces, and the speed of entrainment their mean in the frame that turns with the line of centres. An
 * impulse of a mode acts along the same direction on a, against it on b: forces are equal and opposite, and total angular
 * momentum is constant.
 *
 * Implicit: the impulse over a sub-step of length h is J = beta h w/(1 + (beta c + s) h), with w the speed at the end of the
 * sub-step without J and c the compliance of the mode. With s = 0, beta times the speed at the end of the sub-step. The modes
 * of a contact follow each other, each after the change of speed by those before. Contacts of one disc act at the same time:
 * s is the sum of beta c of the other contacts of both discs, so that a disc never loses more than its speed in a sub-step,
 * however stiff and many the films are. */
#ifndef DELBM_CONTACT_LUBRICATION_BLOCK_H
#define DELBM_CONTACT_LUBRICATION_BLOCK_H

#include "contact/contact_lanes.h"
#include "contact/lubrication.h"

#include <string.h>

struct film_mode {
  double x, y, a, b; /* g, w_a, w_b */
};

/* Speed of mode g by an impulse of mode f. */
static inline __attribute__((always_inline)) double film_compliance(const struct lanes *l, int k, struct film_mode f,
                                                                    struct film_mode g)
{
  const double of_a = f.a * (g.x * l->xw[0][k] + g.y * l->yw[0][k]) + g.a * (f.x * l->xw[0][k] + f.y * l->yw[0][k]);
  const double of_b = f.b * (g.x * l->xw[1][k] + g.y * l->yw[1][k]) + g.b * (f.x * l->xw[1][k] + f.y * l->yw[1][k]);
  return f.x * g.x * l->xx[k] + (f.x * g.y + f.y * g.x) * l->xy[k] + f.y * g.y * l->yy[k] + of_a - of_b +
         f.a * g.a * l->ww[0][k] + f.b * g.b * l->ww[1][k];
}

/* Speed of a mode at the end of a sub-step of length h without contacts. */
static inline __attribute__((always_inline)) double film_speed(const struct lanes *l, int k, struct film_mode g,
                                                               double h)
{
  return g.x * (l->vx[k] + h * l->ax[k]) + g.y * (l->vy[k] + h * l->ay[k]) +
         g.a * (l->omega[0][k] + h * l->domega[0][k]) + g.b * (l->omega[1][k] + h * l->domega[1][k]);
}

/* Between discs, and at walls. */
static inline bool film_exists(const struct contact_pass *p, size_t block, const struct lanes *l, int k)
{
  const uint32_t b = p->table->b[table_first(block) + l->entry[k]];
  return !l->sides || p->scene->domain.side[b - contact_sides].type == SIDE_WALL;
}

static inline __attribute__((always_inline)) struct lubrication_coefficients
film_coefficients(const struct contact_pass *p, const struct lanes *l, int k)
{
  return lubrication_at(p->lubrication, -l->overlaps.depth[k], 1 / l->pairs.radius[0][k], 1 / l->pairs.radius[1][k]);
}

/* Of the modes together: at least the sum of beta c over the modes, by translation of one disc of unit compliance. A
 * uniform disc has R^2 times the compliance of spin at twice that of translation. */
static inline __attribute__((always_inline)) double film_resistance(struct lubrication_coefficients beta)
{
  return beta.normal + 3 * beta.slip + 0.75 * beta.entrainment;
}

/* Compliance of a disc along any direction, at least. */
static inline double film_disc_compliance(const struct response *r)
{
  return max_of(r->xx, r->yy) + fabs(r->xy);
}

/* Sets the resistance of the near entries. */
static void find_films(const struct contact_pass *p, size_t block, const struct lanes *l)
{
  double film[BLOCK];
#pragma omp simd
  for (int k = 0; k < l->n; k++) film[k] = film_resistance(film_coefficients(p, l, k));
  for (int k = 0; k < l->count; k++)
    p->table->film[table_first(block) + l->entry[k]] = film_exists(p, block, l, k) ? film[k] : 0;
}

/* The films of the near entries: beta h of the modes, s h, and q. */
struct films {
  double normal[BLOCK], slip[BLOCK], entrainment[BLOCK], others[BLOCK], q[BLOCK];
};

/* Sets s h, and in `normal` 1 where there is a film. */
static void load_films(const struct contact_pass *p, size_t block, const struct lanes *l, struct films *films)
{
  for (int k = 0; k < l->n; k++) {
    const size_t e = table_first(block) + l->entry[k];
    const uint32_t body[2] = {p->table->a[e], p->table->b[e]};
    double others = 0;
    for (int end = 0; end < (l->sides ? 1 : 2); end++)
      others += film_disc_compliance(&p->response[body[end]]) * max_of(0, p->films[body[end]] - p->table->film[e]);
    films->others[k] = p->h * others;
    films->normal[k] = film_exists(p, block, l, k) ? 1 : 0;
  }
}

/* Sets beta h and q. */
static void find_resistances(const struct contact_pass *p, const struct lanes *l, struct films *films)
{
  const double *aa = l->overlaps.arm[0], *ab = l->overlaps.arm[1], side = l->sides ? 1 : 0;
#pragma omp simd
  for (int k = 0; k < l->n; k++) {
    const struct lubrication_coefficients c = film_coefficients(p, l, k);
    const double factor = p->h * films->normal[k];
    films->normal[k] = factor * c.normal;
    films->slip[k] = factor * c.slip;
    films->entrainment[k] = factor * c.entrainment;
    films->q[k] = -0.5 * side + (1 - side) * 0.5 * (aa[k] - ab[k]) / (aa[k] + ab[k]);
  }
}

/* Adds the impulses of lubrication to those of the entries; torques count. */
static void add_lubrication(const struct contact_pass *p, size_t block, const struct lanes *l)
{
  const struct contact_table *t = p->table;
  const struct body_overlaps *o = &l->overlaps;
  const double h = p->h;
  struct films films;
  double fx[BLOCK], fy[BLOCK], ta[BLOCK], tb[BLOCK];
  load_films(p, block, l, &films);
  find_resistances(p, l, &films);
#pragma omp simd
  for (int k = 0; k < l->n; k++) {
    const double nx = o->nx[k], ny = o->ny[k], aa = o->arm[0][k], ab = o->arm[1][k];
    const double q = films.q[k], bn = films.normal[k], bs = films.slip[k], be = films.entrainment[k];
    const struct film_mode normal = {nx, ny, 0, 0}, slip = {-ny, nx, aa, ab},
                           entrained = {-q * ny, q * nx, 0.5 * aa, -0.5 * ab};
    const double rest = 1 + films.others[k];
    const double jn = bn * film_speed(l, k, normal, h) / (rest + bn * film_compliance(l, k, normal, normal));
    const double us = film_speed(l, k, slip, h) - jn * film_compliance(l, k, normal, slip);
    const double js = bs * us / (rest + bs * film_compliance(l, k, slip, slip));
    const double ue = film_speed(l, k, entrained, h) - jn * film_compliance(l, k, normal, entrained) -
                      js * film_compliance(l, k, slip, entrained);
    const double je = be * ue / (rest + be * film_compliance(l, k, entrained, entrained));
    const double jt = js + q * je;
    fx[k] = jn * nx - jt * ny;
    fy[k] = jn * ny + jt * nx;
    ta[k] = -aa * (js + 0.5 * je);
    tb[k] = -ab * (js - 0.5 * je);
  }
  for (int k = 0; k < l->count; k++) {
    const size_t e = table_first(block) + l->entry[k];
    t->fx[e] += fx[k];
    t->fy[e] += fy[k];
    t->torque_a[e] += ta[k];
    t->torque_b[e] += tb[k];
  }
}

#endif
