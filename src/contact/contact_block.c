/* Forces of a block of contacts, compiled once per instruction set (VARIANT). Bodies a and b, n from a to b, t = (-n_y, n_x),
 * arms a_a, a_b and offsets o_a, o_b of the contact point (solid/shape.h), over a sub-step of length h.
 *
 * Kinematics, with the velocities of the contact point on both bodies:
 *   approach speed  v = (V_a - V_b) . n - omega_a o_a + omega_b o_b
 *   slip speed      u = (V_a - V_b) . t + omega_a a_a + omega_b a_b
 *   rolling speed   r = omega_a - omega_b
 * and the compliances c_n, c_t, c_r: separation, slip and rolling speed per impulse, with the response K of both bodies, hence
 * with the inertia of the coupled fluid.
 *
 * Normal impulse J_n = duration max(0, F_s + eta v), limited by the stored energy (law.h, state.h).
 *
 * Friction (Cundall & Strack 1979): a spring of force F and stiffness k_t = tangential_ratio dF_s/d delta, with a damper
 * eta_t = sqrt(tangential_ratio) eta. While the overlap grows F' = F + k_t u dt; when k_t falls, F is reduced in proportion, so
 * that the spring's energy F^2/(2 k_t) never grows by a change of k_t. Coulomb: |F + eta_t u| <= mu F_n; beyond this, the force is
 * mu F_n, and F at most that. F turns with n, since t does.
 *
 * Rolling friction (Ai, Chen, Rotter & Ooi 2011, model C): the same spring and damper for the torque, with the rolling speed r
 * in place of u, the stiffness k_r = 3 (mu_r R*)^2 dF_s/d delta, and the limit mu_r R* F_n.
 *
 * Neither spring is stiffer than its sub-step resolves: k_t <= 1/(c_t h^2); and no damper stops more than half of its motion
 * in a sub-step: eta_t <= 1/(2 c_t h).
 *
 * Loops run over whole vectors. Elements past the last entry are copies of the first and are not stored. Functions write only to
 * the entries of their block: threads need no locks. */
#include "base/variant.h"
#include "contact/contact_kernel.h"
#include "contact/place.h"

#include <math.h>
#include <string.h>

enum { BLOCK = CONTACT_BLOCK };

static inline double max_of(double a, double b)
{
  return a > b ? a : b;
}

static inline double min_of(double a, double b)
{
  return a < b ? a : b;
}

/* Velocity of a wall along itself; 0 for other sides. */
static double wall_velocity(const struct scene *scene, enum side_name side, int axis)
{
  const struct side *of = &scene->domain.side[side];
  return of->type == SIDE_WALL ? of->velocity[axis] : 0;
}

static void clear_state(struct contact_table *t, size_t e)
{
  double *const state[] = {t->stored, t->impulse,         t->spring_impulse, t->approach_speed,
                           t->shear,  t->shear_stiffness, t->moment,         t->moment_stiffness};
  for (size_t k = 0; k < sizeof state / sizeof state[0]; k++) state[k][e] = 0;
  t->live[e] = 0;
}

static void KERNEL(select)(const struct contact_pass *p, size_t block)
{
  struct contact_table *t = p->table;
  const size_t first = table_first(block);
  const int count = table_entries(t, block), n = whole_vectors(count);
  const double *restrict ra = t->radius[0] + first, *restrict rb = t->radius[1] + first;
  struct body_pairs places = {.count = n};
  double near[BLOCK];
  for (int k = 0; k < n; k++) {
    const size_t e = first + (size_t)(k < count ? k : 0);
    if (table_is_of_sides(t, block))
      place_side(p->scene, p->at.x, p->at.y, t->a[e], t->b[e], &places, k);
    else
      place_body(p->at.x, p->at.y, t->a[e], t->b[e], &places, k);
  }
  if (table_is_of_sides(t, block)) {
#pragma omp simd
    for (int k = 0; k < n; k++) near[k] = ra[k] + p->within - places.distance[k];
  } else {
    place_nearest_images(p->scene, &places);
#pragma omp simd
    for (int k = 0; k < n; k++) {
      const double reach = ra[k] + rb[k] + p->within;
      near[k] = reach * reach - (places.dx[k] * places.dx[k] + places.dy[k] * places.dy[k]);
    }
  }
  int found = 0;
  for (int k = 0; k < count; k++) {
    const bool is_near = near[k] > 0;
    t->near[first + (size_t)found] = (uint8_t)k;
    found += is_near;
    t->is_near[first + (size_t)k] = is_near;
    if (!is_near && t->live[first + (size_t)k]) clear_state(t, first + (size_t)k);
  }
  t->near_count[block] = (uint8_t)found;
  memset(t->fx + first, 0, BLOCK * sizeof *t->fx);
  memset(t->fy + first, 0, BLOCK * sizeof *t->fy);
  if (!t->has_spin) return;
  memset(t->torque_a + first, 0, BLOCK * sizeof *t->torque_a);
  memset(t->torque_b + first, 0, BLOCK * sizeof *t->torque_b);
}

/* The near entries of a block, in vectors. */
struct lanes {
  int count, n; /* entries; the same in whole vectors */
  bool sides;
  size_t entry[BLOCK];
  struct body_pairs pairs;
  struct body_overlaps overlaps;
  double strength[BLOCK], damper[BLOCK], touch[BLOCK];
  double vx[BLOCK], vy[BLOCK], ax[BLOCK], ay[BLOCK]; /* relative velocity, relative change of velocity by dV */
  double xx[BLOCK], xy[BLOCK], yy[BLOCK];            /* sum of both K */
  double omega[2][BLOCK], domega[2][BLOCK], xw[2][BLOCK], yw[2][BLOCK], ww[2][BLOCK]; /* if torques count */
  double approach[BLOCK], compliance[BLOCK], mean[BLOCK];
  double force[BLOCK], stiffness[BLOCK], eta[BLOCK], normal[BLOCK];
};

static inline void load_motion(const struct contact_pass *p, struct lanes *l, int k, uint32_t a, uint32_t b)
{
  const struct response *ra = &p->response[a], *rb = &p->response[b];
  l->vx[k] = p->at.vx[a] - p->at.vx[b];
  l->vy[k] = p->at.vy[a] - p->at.vy[b];
  l->ax[k] = ra->dvx - rb->dvx;
  l->ay[k] = ra->dvy - rb->dvy;
  l->xx[k] = ra->xx + rb->xx;
  l->xy[k] = ra->xy + rb->xy;
  l->yy[k] = ra->yy + rb->yy;
}

static inline void load_motion_to_side(const struct contact_pass *p, struct lanes *l, int k, uint32_t a, uint32_t b)
{
  const enum side_name side = (enum side_name)(b - contact_sides);
  const struct response *ra = &p->response[a];
  l->vx[k] = p->at.vx[a] - wall_velocity(p->scene, side, 0);
  l->vy[k] = p->at.vy[a] - wall_velocity(p->scene, side, 1);
  l->ax[k] = ra->dvx;
  l->ay[k] = ra->dvy;
  l->xx[k] = ra->xx;
  l->xy[k] = ra->xy;
  l->yy[k] = ra->yy;
}

static inline void load_spin(const struct contact_pass *p, struct lanes *l, int k, int end, uint32_t i)
{
  const bool side = contact_is_with_side(i);
  const struct response *r = side ? NULL : &p->response[i];
  l->omega[end][k] = side ? 0 : p->at.omega[i];
  l->domega[end][k] = side ? 0 : r->domega;
  l->xw[end][k] = side ? 0 : r->xw;
  l->yw[end][k] = side ? 0 : r->yw;
  l->ww[end][k] = side ? 0 : r->ww;
}

/* Loads the near entries of a block; `spin`: with what torques need. */
static inline void load(const struct contact_pass *p, size_t block, bool spin, struct lanes *l)
{
  const struct contact_table *t = p->table;
  const size_t first = table_first(block);
  l->count = t->near_count[block];
  l->n = whole_vectors(l->count);
  l->sides = table_is_of_sides(t, block);
  l->pairs.count = l->n;
  for (int k = 0; k < l->n; k++) {
    const size_t e = first + t->near[first + (size_t)(k < l->count ? k : 0)];
    l->entry[k] = e;
    l->pairs.radius[0][k] = t->radius[0][e];
    l->pairs.radius[1][k] = t->radius[1][e];
    l->strength[k] = t->strength[e];
    l->damper[k] = t->damper[e];
    if (l->sides) {
      place_side(p->scene, p->at.x, p->at.y, t->a[e], t->b[e], &l->pairs, k);
      load_motion_to_side(p, l, k, t->a[e], t->b[e]);
    } else {
      place_body(p->at.x, p->at.y, t->a[e], t->b[e], &l->pairs, k);
      load_motion(p, l, k, t->a[e], t->b[e]);
    }
    if (!spin) continue;
    load_spin(p, l, k, 0, t->a[e]);
    load_spin(p, l, k, 1, t->b[e]);
  }
}

/* Overlaps and normal kinematics. Areas by cells replace those of lenses. */
static inline void find_kinematics(const struct contact_pass *p, bool spin, bool with_area, struct lanes *l)
{
  struct body_overlaps *o = &l->overlaps;
  const int n = l->n;
  l->pairs.with_area = with_area;
  if (l->sides) {
    p->kind->overlaps_half_plane(&l->pairs, o);
  } else {
    place_nearest_images(p->scene, &l->pairs);
    p->kind->overlaps(&l->pairs, o);
  }
#pragma omp simd
  for (int k = 0; k < n; k++) {
    const double nx = o->nx[k], ny = o->ny[k];
    const double acceleration = nx * l->ax[k] + ny * l->ay[k];
    l->approach[k] = nx * l->vx[k] + ny * l->vy[k];
    l->mean[k] = l->approach[k] + 0.5 * p->h * acceleration;
    l->compliance[k] = nx * nx * l->xx[k] + 2 * nx * ny * l->xy[k] + ny * ny * l->yy[k];
    l->touch[k] = o->depth[k];
  }
  for (int k = 0; p->has_cells && !l->sides && k < n; k++) l->touch[k] = o->area[k] = p->table->cells_area[l->entry[k]];
  if (!spin || p->kind->round) {
    if (spin) memset(o->offset, 0, sizeof o->offset);
    return;
  }
#pragma omp simd
  for (int k = 0; k < n; k++) {
    const double nx = o->nx[k], ny = o->ny[k], oa = o->offset[0][k], ob = o->offset[1][k];
    l->approach[k] += ob * l->omega[1][k] - oa * l->omega[0][k];
    l->mean[k] +=
        ob * l->omega[1][k] - oa * l->omega[0][k] + 0.5 * p->h * (ob * l->domega[1][k] - oa * l->domega[0][k]);
    l->compliance[k] -= oa * (2 * (nx * l->xw[0][k] + ny * l->yw[0][k]) - oa * l->ww[0][k]) +
                        ob * (2 * (nx * l->xw[1][k] + ny * l->yw[1][k]) - ob * l->ww[1][k]);
  }
}

/* c_t of a contact. */
static inline double shear_compliance(const struct lanes *l, int k)
{
  const struct body_overlaps *o = &l->overlaps;
  const double tx = -o->ny[k], ty = o->nx[k], aa = o->arm[0][k], ab = o->arm[1][k];
  return tx * tx * l->xx[k] + 2 * tx * ty * l->xy[k] + ty * ty * l->yy[k] +
         aa * (2 * (tx * l->xw[0][k] + ty * l->yw[0][k]) + aa * l->ww[0][k]) -
         ab * (2 * (tx * l->xw[1][k] + ty * l->yw[1][k]) - ab * l->ww[1][k]);
}

static inline double reduced_radius(const struct lanes *l, int k)
{
  return 1 / (1 / l->pairs.radius[0][k] + 1 / l->pairs.radius[1][k]);
}

static inline void find_rates(const struct contact_pass *p, bool spin, enum contact_spring_law law, struct lanes *l,
                              struct contact_rates *max)
{
  const bool by_rate = p->law->by_rate;
  const double ratio = p->law->tangential_ratio;
  double spring = 0, damper = 0;
#pragma omp simd reduction(max : spring, damper)
  for (int k = 0; k < l->n; k++) {
    const double depth = max_of(0, l->overlaps.depth[k]) + max_of(0, l->approach[k]);
    const double stiffness = spring_max_stiffness(law, l->strength[k], depth, reduced_radius(l, k));
    const double eta = by_rate ? l->damper[k] * sqrt(stiffness) : l->damper[k];
    const double shear = spin ? ratio * shear_compliance(l, k) : 0;
    const double of_spring = stiffness * max_of(l->compliance[k], shear), of_damper = eta * l->compliance[k];
    spring = of_spring > spring ? of_spring : spring;
    damper = of_damper > damper ? of_damper : damper;
  }
  max->any = true;
  if (spring > max->spring) max->spring = spring;
  if (damper > max->damper) max->damper = damper;
}

static void KERNEL(rates)(const struct contact_pass *p, size_t block, struct contact_rates *max)
{
  struct lanes l;
  const bool spin = p->table->has_spin;
  if (p->table->near_count[block] == 0) return;
  load(p, block, spin, &l);
  find_kinematics(p, spin, false, &l);
  switch (p->law->spring) {
  case SPRING_OVERLAP:
    find_rates(p, spin, SPRING_OVERLAP, &l, max);
    break;
  case SPRING_HERTZ:
    find_rates(p, spin, SPRING_HERTZ, &l, max);
    break;
  case SPRING_LINEAR:
    find_rates(p, spin, SPRING_LINEAR, &l, max);
    break;
  }
}

static inline void find_springs(const struct contact_pass *p, enum contact_spring_law law, struct lanes *l)
{
  const bool by_rate = p->law->by_rate;
#pragma omp simd
  for (int k = 0; k < l->n; k++) {
    const double depth = max_of(0, l->overlaps.depth[k]);
    const double stiffness = spring_stiffness(law, l->strength[k], depth, l->overlaps.chord[k]);
    l->force[k] = spring_force(law, l->strength[k], depth, l->overlaps.area[k]);
    l->stiffness[k] = stiffness;
    l->eta[k] = by_rate ? l->damper[k] * sqrt(stiffness) : l->damper[k];
  }
}

/* Normal impulses; updates the states. */
static void find_normal(const struct contact_pass *p, struct lanes *l)
{
  const struct contact_table *t = p->table;
  const double duration = p->duration;
  double stored[BLOCK], impulse[BLOCK], spring_impulse[BLOCK], before[BLOCK];
  for (int k = 0; k < l->n; k++) {
    const size_t e = l->entry[k];
    stored[k] = t->stored[e];
    impulse[k] = t->impulse[e];
    spring_impulse[k] = t->spring_impulse[e];
    before[k] = t->approach_speed[e];
  }
#pragma omp simd
  for (int k = 0; k < l->n; k++) {
    const double approach = l->approach[k], eta = l->eta[k];
    const double left = state_stored(stored[k], impulse[k], spring_impulse[k], before[k], approach);
    const double max = state_max_impulse(left, l->mean[k], l->compliance[k], duration * eta);
    const double wanted = duration * max_of(0, l->force[k] + eta * approach), spring = duration * l->force[k];
    const bool touches = l->touch[k] > 0;
    stored[k] = touches ? left : 0;
    l->normal[k] = touches ? min_of(wanted, max) : 0;
    spring_impulse[k] = touches ? min_of(spring, max) : 0;
  }
  for (int k = 0; k < l->count; k++) {
    const size_t e = l->entry[k];
    t->stored[e] = stored[k];
    t->impulse[e] = l->normal[k];
    t->spring_impulse[e] = spring_impulse[k];
    t->approach_speed[e] = l->approach[k];
    t->live[e] = stored[k] > 0 || l->normal[k] > 0;
  }
}

/* A spring with history and its damper, limited to `max`: the force; updates the spring. */
struct slider {
  double force, stiffness;
};

static inline double slide(struct slider *spring, double stiffness, double eta, double speed, double moved, double max)
{
  const double kept = spring->stiffness > stiffness ? spring->force * (stiffness / spring->stiffness) : spring->force;
  const double force = kept + stiffness * speed * moved, wanted = force + eta * speed;
  spring->stiffness = stiffness;
  spring->force = max_of(-max, min_of(max, force));
  return max_of(-max, min_of(max, wanted));
}

/* Tangential impulses and rolling moments, and the wrenches on both bodies. */
static void find_friction(const struct contact_pass *p, const struct lanes *l)
{
  const struct contact_table *t = p->table;
  const struct body_overlaps *o = &l->overlaps;
  const double ratio = p->law->tangential_ratio, root = sqrt(ratio), h = p->h, duration = p->duration, moved = p->moved;
  const double rolling = p->law->rolling_friction, eta_0 = p->law->damping;
  double force[BLOCK], force_stiffness[BLOCK], moment[BLOCK], moment_stiffness[BLOCK], friction[BLOCK], arm[BLOCK];
  double fx[BLOCK], fy[BLOCK], ta[BLOCK], tb[BLOCK];
  for (int k = 0; k < l->n; k++) {
    const size_t e = l->entry[k];
    force[k] = t->shear[e];
    force_stiffness[k] = t->shear_stiffness[e];
    moment[k] = t->moment[e];
    moment_stiffness[k] = t->moment_stiffness[e];
    friction[k] = t->friction[e];
    arm[k] = t->max_moment[e];
  }
#pragma omp simd
  for (int k = 0; k < l->n; k++) {
    const double nx = o->nx[k], ny = o->ny[k], aa = o->arm[0][k], ab = o->arm[1][k], j = l->normal[k];
    const double ct = shear_compliance(l, k), cr = l->ww[0][k] + l->ww[1][k];
    const double slip = nx * l->vy[k] - ny * l->vx[k] + aa * l->omega[0][k] + ab * l->omega[1][k];
    const double roll = l->omega[0][k] - l->omega[1][k], normal = j / duration;
    const bool acts = j > 0;
    struct slider shear = {force[k], force_stiffness[k]}, turn = {moment[k], moment_stiffness[k]};
    const double kt = min_of(ratio * l->stiffness[k], 1 / (ct * h * h));
    const double et = min_of(root * l->eta[k], 1 / (2 * ct * h));
    const double kr = min_of(3 * arm[k] * arm[k] * l->stiffness[k], 1 / (cr * h * h));
    const double er = min_of(2 * eta_0 * sqrt(kr / cr), 1 / (2 * cr * h));
    const double along = slide(&shear, kt, et, slip, moved, friction[k] * normal);
    const double torque = slide(&turn, kr, er, roll, moved, arm[k] * normal);
    const double jt = acts ? duration * along : 0, jr = acts && rolling > 0 ? duration * torque : 0;
    force[k] = acts ? shear.force : 0;
    force_stiffness[k] = acts ? shear.stiffness : 0;
    moment[k] = acts ? turn.force : 0;
    moment_stiffness[k] = acts ? turn.stiffness : 0;
    fx[k] = j * nx - jt * ny;
    fy[k] = j * ny + jt * nx;
    ta[k] = o->offset[0][k] * j - aa * jt - jr;
    tb[k] = jr - o->offset[1][k] * j - ab * jt;
  }
  for (int k = 0; k < l->count; k++) {
    const size_t e = l->entry[k];
    t->shear[e] = force[k];
    t->shear_stiffness[e] = force_stiffness[k];
    t->moment[e] = moment[k];
    t->moment_stiffness[e] = moment_stiffness[k];
    t->fx[e] = fx[k];
    t->fy[e] = fy[k];
    t->torque_a[e] = ta[k];
    t->torque_b[e] = tb[k];
  }
}

static void store_normal(const struct contact_pass *p, const struct lanes *l)
{
  for (int k = 0; k < l->count; k++) {
    p->table->fx[l->entry[k]] = l->normal[k] * l->overlaps.nx[k];
    p->table->fy[l->entry[k]] = l->normal[k] * l->overlaps.ny[k];
  }
}

static double largest_overlap(const struct lanes *l)
{
  double largest = 0;
#pragma omp simd reduction(max : largest)
  for (int k = 0; k < l->n; k++) {
    const double part = l->overlaps.depth[k] / min_of(l->pairs.radius[0][k], l->pairs.radius[1][k]);
    largest = part > largest ? part : largest;
  }
  return largest;
}

static inline void find_impulses(const struct contact_pass *p, size_t block, bool spin, enum contact_spring_law law,
                                 double *max_overlap)
{
  struct lanes l;
  load(p, block, spin, &l);
  find_kinematics(p, spin, law == SPRING_OVERLAP, &l);
  find_springs(p, law, &l);
  find_normal(p, &l);
  if (spin)
    find_friction(p, &l);
  else
    store_normal(p, &l);
  *max_overlap = max_of(*max_overlap, largest_overlap(&l));
}

static void KERNEL(impulses)(const struct contact_pass *p, size_t block, double *max_overlap)
{
  const bool spin = p->table->has_spin;
  if (p->table->near_count[block] == 0) return;
  switch (p->law->spring) {
  case SPRING_OVERLAP:
    find_impulses(p, block, spin, SPRING_OVERLAP, max_overlap);
    break;
  case SPRING_HERTZ:
    find_impulses(p, block, spin, SPRING_HERTZ, max_overlap);
    break;
  case SPRING_LINEAR:
    find_impulses(p, block, spin, SPRING_LINEAR, max_overlap);
    break;
  }
}

extern const struct contact_kernel KERNEL(contact_kernel);
const struct contact_kernel KERNEL(contact_kernel) = {
    .select = KERNEL(select), .rates = KERNEL(rates), .impulses = KERNEL(impulses)};
