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
 * Normal impulse (law.h). The damper acts on the mean of the speeds before and after the impulse, v - c J_n/2, with the compliance
 * c = 1/m_a + 1/m_b of the discs alone. With S and D, the integrals of spring force and eta over the duration,
 *   J_n = max(0, (S + D v)/(1 + D c/2)),  S = duration F_s, D = duration eta.
 * The first impulse of a contact, which began at the time delta/v before, is integrated from there to h/2 after, at the speed v:
 * with delta_1 = delta + v h/2 and t = delta_1/v, for F_s ~ delta^p,
 *   S = F_s(delta_1) t/(p + 1),  D = eta(delta_1) t, by rate (law.h) 2/(p + 1) times this.
 * With S and D as for other impulses the restitution would be up to 10 % off, since the damper's force jumps when a contact begins.
 *
 * Friction (Cundall & Strack 1979): a spring of force F and stiffness k_t = tangential_ratio dF_s/d delta, with a damper
 * eta_t = sqrt(tangential_ratio) eta at the mean slip speed, as above. F' = F + k_t u dt; when k_t falls, F is first reduced in
 * proportion, so that the spring's energy F^2/(2 k_t) never grows by a change of k_t. Coulomb: |F + eta_t u| <= mu F_n; beyond
 * this, the force is mu F_n, and F at most that. F turns with n, since t does.
 *
 * Rolling friction (Ai, Chen, Rotter & Ooi 2011, model C): the same spring and damper for the torque, with the rolling speed r
 * in place of u, the stiffness k_r = 3 (mu_r R*)^2 dF_s/d delta, and the limit mu_r R* F_n.
 *
 * Where the number of sub-steps does not follow from the contacts (table.h, `limited`), the stored energy limits J_n, no spring
 * is stiffer than a sub-step resolves, k_t <= 1/(c_t h^2), and no damper stops more than half of its motion in a sub-step,
 * eta_t <= 1/(2 c_t h); c_r likewise. The energy stored in these springs limits J_t and the rolling impulse M, one after the other,
 * J_t u - c_t J_t^2/2 >= -E: an oscillator resolved by few sub-steps has, within its period, kinetic energy beyond its total, and a
 * contact that ends then would leave the discs with it.
 *
 * Loops run over whole vectors. Elements past the last entry are copies of the first and are not stored. Functions write only to
 * the entries of their block: threads need no locks. */
#include "base/variant.h"
#include "contact/contact_kernel.h"
#include "contact/contact_lanes.h"
#include "contact/lubrication_block.h"
#include "contact/place.h"

#include <math.h>
#include <string.h>

/* The largest of n values and 0, n in whole vectors. */
static inline double largest_of(const double *v, int n)
{
  double top[VECTOR] = {0}, largest = 0;
  for (int k = 0; k < n; k += VECTOR)
    for (int j = 0; j < VECTOR; j++) top[j] = max_of(top[j], v[k + j]);
  for (int j = 0; j < VECTOR; j++) largest = max_of(largest, top[j]);
  return largest;
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

/* The margin of each entry of a block: positive if the gap is below `within`. */
static inline void find_margins(const struct contact_pass *p, size_t block, int n, double *restrict margin)
{
  const struct contact_table *t = p->table;
  const size_t first = table_first(block);
  const uint32_t *restrict a = t->a + first, *restrict b = t->b + first;
  const double *restrict x = p->at.x, *restrict y = p->at.y, within = p->within;
  const double *restrict ra = t->radius[0] + first, *restrict rb = t->radius[1] + first;
  struct body_pairs places;
  places.count = n;
  if (table_is_of_sides(t, block)) {
    for (int k = 0; k < n; k++) place_side(p->scene, x, y, a[k], b[k], &places, k);
#pragma omp simd
    for (int k = 0; k < n; k++) margin[k] = ra[k] + within - places.distance[k];
  } else {
    for (int k = 0; k < n; k++) place_body(x, y, a[k], b[k], &places, k);
    place_nearest_images(p->scene, &places);
#pragma omp simd
    for (int k = 0; k < n; k++) {
      const double reach = ra[k] + rb[k] + within, dx = places.dx[k], dy = places.dy[k];
      margin[k] = reach * reach - (dx * dx + dy * dy);
    }
  }
}

static void KERNEL(select)(const struct contact_pass *p, size_t block)
{
  struct contact_table *t = p->table;
  const size_t first = table_first(block);
  const int count = table_entries(t, block);
  double margin[BLOCK];
  uint8_t near[BLOCK], is_near[BLOCK];
  int found = 0;
  find_margins(p, block, whole_vectors(count), margin);
  for (int k = 0; k < count; k++) {
    is_near[k] = margin[k] > 0;
    near[found] = (uint8_t)k;
    found += is_near[k];
  }
  for (int k = 0; k < count; k++)
    if (t->live[first + (size_t)k] > is_near[k]) clear_state(t, first + (size_t)k);
  memcpy(t->is_near + first, is_near, (size_t)count);
  memcpy(t->near + first, near, (size_t)found);
  t->near_count[block] = (uint8_t)found;
  memset(t->fx + first, 0, BLOCK * sizeof *t->fx);
  memset(t->fy + first, 0, BLOCK * sizeof *t->fy);
  if (!t->has_spin) return;
  memset(t->torque_a + first, 0, BLOCK * sizeof *t->torque_a);
  memset(t->torque_b + first, 0, BLOCK * sizeof *t->torque_b);
}

/* Element k of the relative motion of discs a and b. */
static inline void load_motion(const struct disc_motions *at, struct lanes *restrict l, int k, uint32_t a, uint32_t b)
{
  l->vx[k] = at->vx[a] - at->vx[b];
  l->vy[k] = at->vy[a] - at->vy[b];
}

static inline void load_motion_to_side(const struct contact_pass *p, struct lanes *restrict l, int k, uint32_t a,
                                       uint32_t b)
{
  const enum side_name side = (enum side_name)(b - contact_sides);
  l->vx[k] = p->at.vx[a] - wall_velocity(p->scene, side, 0);
  l->vy[k] = p->at.vy[a] - wall_velocity(p->scene, side, 1);
}

/* Element k of the sum of the responses; without b for a side. */
static inline void load_response(const struct response *a, const struct response *b, struct lanes *restrict l, int k)
{
  l->ax[k] = a->dvx - b->dvx;
  l->ay[k] = a->dvy - b->dvy;
  l->xx[k] = a->xx + b->xx;
  l->xy[k] = a->xy + b->xy;
  l->yy[k] = a->yy + b->yy;
}

static inline void load_spin_response(const struct response *r, struct lanes *restrict l, int end, int k)
{
  l->domega[end][k] = r->domega;
  l->xw[end][k] = r->xw;
  l->yw[end][k] = r->yw;
  l->ww[end][k] = r->ww;
}

/* Responses of the bodies: a side has none. */
static inline void load_responses(const struct contact_pass *p, bool spin, const uint32_t *a, const uint32_t *b,
                                  struct lanes *l)
{
  static const struct response none = {0};
  for (int k = 0; k < l->n; k++) {
    const struct response *ra = &p->response[a[k]], *rb = l->sides ? &none : &p->response[b[k]];
    load_response(ra, rb, l, k);
    if (!spin) continue;
    load_spin_response(ra, l, 0, k);
    load_spin_response(rb, l, 1, k);
  }
}

/* Loads the near entries of a block; `spin`: with what torques need, `responds`: with the responses. */
static inline void load(const struct contact_pass *p, size_t block, bool spin, bool responds, struct lanes *restrict l)
{
  const struct contact_table *t = p->table;
  const size_t first = table_first(block);
  const double *restrict ra = t->radius[0] + first, *restrict rb = t->radius[1] + first;
  const double *restrict strength = t->strength + first, *restrict damper = t->damper + first;
  const double *restrict inverse_mass = t->inverse_mass + first;
  const uint32_t *restrict all_a = t->a + first, *restrict all_b = t->b + first;
  const struct disc_motions at = p->at;
  uint32_t a[BLOCK], b[BLOCK];
  l->count = t->near_count[block];
  l->n = whole_vectors(l->count);
  l->sides = table_is_of_sides(t, block);
  l->pairs.count = l->n;
  memcpy(l->entry, t->near + first, (size_t)l->count);
  memset(l->entry + l->count, l->entry[0], (size_t)(l->n - l->count));
  for (int k = 0; k < l->n; k++) {
    const uint8_t e = l->entry[k];
    a[k] = all_a[e];
    b[k] = all_b[e];
    l->pairs.radius[0][k] = ra[e];
    l->pairs.radius[1][k] = rb[e];
    l->strength[k] = strength[e];
    l->damper[k] = damper[e];
    l->inverse_mass[k] = inverse_mass[e];
  }
  for (int k = 0; l->sides && k < l->n; k++) {
    place_side(p->scene, at.x, at.y, a[k], b[k], &l->pairs, k);
    load_motion_to_side(p, l, k, a[k], b[k]);
  }
  for (int k = 0; !l->sides && k < l->n; k++) {
    place_body(at.x, at.y, a[k], b[k], &l->pairs, k);
    load_motion(&at, l, k, a[k], b[k]);
  }
  for (int k = 0; spin && k < l->n; k++) {
    l->omega[0][k] = at.omega[a[k]];
    l->omega[1][k] = l->sides ? 0 : at.omega[b[k]];
  }
  if (responds) load_responses(p, spin, a, b, l);
}

/* Overlaps and approach speeds. Areas by cells replace those of lenses. */
static inline void find_overlaps(const struct contact_pass *p, size_t block, bool spin, bool with_area, struct lanes *l)
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
  if (spin && p->kind->round) memset(o->offset, 0, sizeof o->offset);
#pragma omp simd
  for (int k = 0; k < n; k++) {
    const double turn = spin ? o->offset[1][k] * l->omega[1][k] - o->offset[0][k] * l->omega[0][k] : 0;
    l->approach[k] = o->nx[k] * l->vx[k] + o->ny[k] * l->vy[k] + turn;
    l->touch[k] = o->depth[k];
  }
  for (int k = 0; p->has_cells && !l->sides && k < n; k++)
    l->touch[k] = o->area[k] = p->table->cells_area[table_first(block) + l->entry[k]];
}

/* c_n of body `end` beyond the response of its translation. */
static inline double turning_compliance(const struct lanes *l, int end, int k)
{
  const double nx = l->overlaps.nx[k], ny = l->overlaps.ny[k], offset = l->overlaps.offset[end][k];
  return offset * (offset * l->ww[end][k] - 2 * (nx * l->xw[end][k] + ny * l->yw[end][k]));
}

/* Compliances, and mean approach speeds over the sub-step without impulses. */
static inline void find_compliances(const struct contact_pass *p, bool spin, struct lanes *l)
{
  const struct body_overlaps *o = &l->overlaps;
#pragma omp simd
  for (int k = 0; k < l->n; k++) {
    const double nx = o->nx[k], ny = o->ny[k];
    const double turn = spin ? o->offset[1][k] * l->domega[1][k] - o->offset[0][k] * l->domega[0][k] : 0;
    l->mean[k] = l->approach[k] + 0.5 * p->h * (nx * l->ax[k] + ny * l->ay[k] + turn);
    l->compliance[k] = nx * nx * l->xx[k] + 2 * nx * ny * l->xy[k] + ny * ny * l->yy[k] +
                       (spin ? turning_compliance(l, 0, k) + turning_compliance(l, 1, k) : 0);
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

/* The largest compliance of a contact per normal stiffness. */
static inline void find_softest(const struct contact_pass *p, const struct lanes *l, double *restrict compliance)
{
  const double ratio = p->law->tangential_ratio, rolling = p->law->rolling_friction;
#pragma omp simd
  for (int k = 0; k < l->n; k++) {
    const double arm = rolling * reduced_radius(l, k), turn = 3 * arm * arm * (l->ww[0][k] + l->ww[1][k]);
    compliance[k] = max_of(l->compliance[k], max_of(ratio * shear_compliance(l, k), turn));
  }
}

static inline __attribute__((always_inline)) void find_rates(const struct contact_pass *p, bool spin,
                                                             enum contact_spring_law law, struct lanes *l,
                                                             struct contact_rates *max)
{
  const bool by_rate = p->law->by_rate;
  double softest[BLOCK], spring[BLOCK], damper[BLOCK];
  memcpy(softest, l->compliance, sizeof softest);
  if (spin) find_softest(p, l, softest);
#pragma omp simd
  for (int k = 0; k < l->n; k++) {
    const double depth = max_of(0, l->overlaps.depth[k]) + max_of(0, l->approach[k]);
    const double stiffness = spring_max_stiffness(law, l->strength[k], depth, reduced_radius(l, k));
    spring[k] = stiffness * softest[k];
    damper[k] = l->damper[k] * (by_rate ? sqrt(stiffness) : 1) * l->compliance[k];
  }
  max->any = true;
  max->spring = max_of(max->spring, largest_of(spring, l->n));
  max->damper = max_of(max->damper, largest_of(damper, l->n));
}

static void KERNEL(rates)(const struct contact_pass *p, size_t block, struct contact_rates *max)
{
  struct lanes l;
  const bool spin = p->table->has_spin;
  if (p->table->near_count[block] == 0) return;
  load(p, block, spin, true, &l);
  find_overlaps(p, block, spin, false, &l);
  find_compliances(p, spin, &l);
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

/* Normal impulses of springs and dampers. */
static inline __attribute__((always_inline)) void find_normal(const struct contact_pass *p, enum contact_spring_law law,
                                                              struct lanes *l)
{
  const bool by_rate = p->law->by_rate, can_begin = !p->has_cells || l->sides;
  const double duration = p->duration, moved = p->moved, half = 0.5 * p->h, exponent = spring_exponent(law);
#pragma omp simd
  for (int k = 0; k < l->n; k++) {
    const double v = l->approach[k], depth = max_of(0, l->overlaps.depth[k]), strength = l->strength[k];
    const double stiffness = spring_stiffness(law, strength, depth, l->overlaps.chord[k]);
    const double force = spring_force(law, strength, depth, l->overlaps.area[k]);
    const double eta = l->damper[k] * (by_rate ? sqrt(stiffness) : 1);
    const double first = depth + half * v, time = first / v; /* of the first impulse of a contact */
    const double first_force = spring_small_force(law, strength, max_of(0, first), reduced_radius(l, k));
    const double first_eta = l->damper[k] * (by_rate ? sqrt(exponent * first_force / first) * 2 / (exponent + 1) : 1);
    const bool begins = can_begin && depth <= v * moved;
    l->eta[k] = eta;
    l->stiffness[k] = stiffness;
    l->moved[k] = begins ? depth / v : moved;
    l->spring[k] = begins ? first_force * time / (exponent + 1) : duration * force;
    const double damped = begins ? first_eta * time : duration * eta;
    const double impulse = (l->spring[k] + damped * v) / (1 + 0.5 * damped * l->inverse_mass[k]);
    l->normal[k] = l->touch[k] > 0 ? max_of(0, impulse) : 0;
  }
}

/* Limits the normal impulses by the stored energies; updates these states. */
static void limit_normal(const struct contact_pass *p, size_t block, struct lanes *l)
{
  const struct contact_table *t = p->table;
  const size_t first = table_first(block);
  const double duration = p->duration;
  double stored[BLOCK], impulse[BLOCK], spring_impulse[BLOCK], before[BLOCK];
  for (int k = 0; k < l->n; k++) {
    const size_t e = first + l->entry[k];
    stored[k] = t->stored[e];
    impulse[k] = t->impulse[e];
    spring_impulse[k] = t->spring_impulse[e];
    before[k] = t->approach_speed[e];
  }
#pragma omp simd
  for (int k = 0; k < l->n; k++) {
    const double left = state_stored(stored[k], impulse[k], spring_impulse[k], before[k], l->approach[k]);
    const double max = state_max_impulse(left, l->mean[k], l->compliance[k], duration * l->eta[k]);
    const bool touches = l->touch[k] > 0;
    stored[k] = touches ? left : 0;
    l->normal[k] = min_of(l->normal[k], max);
    spring_impulse[k] = touches ? min_of(l->spring[k], max) : 0;
  }
  for (int k = 0; k < l->count; k++) {
    const size_t e = first + l->entry[k];
    t->stored[e] = stored[k];
    t->impulse[e] = l->normal[k];
    t->spring_impulse[e] = spring_impulse[k];
    t->approach_speed[e] = l->approach[k];
  }
}

/* A spring with history and its damper, limited to `max`: the force; updates the spring. */
struct slider {
  double force, stiffness;
};

/* `share`: duration times compliance, with which the damper acts on the mean speed. */
static inline double slide(struct slider *spring, double stiffness, double eta, double speed, double moved,
                           double share, double max)
{
  const double kept = spring->stiffness > stiffness ? spring->force * (stiffness / spring->stiffness) : spring->force;
  const double force = kept + stiffness * speed * moved, wanted = (force + eta * speed) / (1 + 0.5 * share * eta);
  spring->stiffness = stiffness;
  spring->force = max_of(-max, min_of(max, force));
  return max_of(-max, min_of(max, wanted));
}

/* Energy E of the spring between two sub-steps, F F'/(2 k) with F' = F + k speed moved: a leapfrog with constant k keeps the sum of
 * kinetic energy and E. */
static inline double stored_energy(struct slider spring, double speed, double moved)
{
  const double next = spring.force + spring.stiffness * speed * moved;
  return spring.stiffness > 0 ? max_of(0, 0.5 * spring.force * next / spring.stiffness) : 0;
}

/* The force, limited to the `stored` energy: the impulse J does the work J (speed - c J/2) >= -stored, c the compliance. */
static inline double limit_by_energy(struct slider *spring, double force, double stored, double speed,
                                     double compliance, double duration)
{
  const double root = sqrt(speed * speed + 2 * compliance * stored), scale = 1 / (compliance * duration);
  const double low = scale * (speed - root), high = scale * (speed + root);
  spring->force = max_of(low, min_of(high, spring->force));
  return max_of(low, min_of(high, force));
}

/* Tangential impulses and rolling moments, and the wrenches on both bodies. */
static inline __attribute__((always_inline)) void find_friction(const struct contact_pass *p, size_t block,
                                                                bool limited, const struct lanes *l)
{
  const struct contact_table *t = p->table;
  const struct body_overlaps *o = &l->overlaps;
  const size_t first = table_first(block);
  const double ratio = p->law->tangential_ratio, root = sqrt(ratio), h = p->h, duration = p->duration;
  double force[BLOCK], force_stiffness[BLOCK], moment[BLOCK], moment_stiffness[BLOCK], friction[BLOCK], arm[BLOCK];
  double rolling_damper[BLOCK], slip_compliance[BLOCK], roll_compliance[BLOCK], fx[BLOCK], fy[BLOCK], ta[BLOCK],
      tb[BLOCK];
  for (int k = 0; k < l->n; k++) {
    const size_t e = first + l->entry[k];
    force[k] = t->shear[e];
    force_stiffness[k] = t->shear_stiffness[e];
    moment[k] = t->moment[e];
    moment_stiffness[k] = t->moment_stiffness[e];
    friction[k] = t->friction[e];
    arm[k] = t->max_moment[e];
    rolling_damper[k] = t->rolling_damper[e];
    slip_compliance[k] = t->slip_compliance[e];
    roll_compliance[k] = t->roll_compliance[e];
  }
#pragma omp simd
  for (int k = 0; k < l->n; k++) {
    const double nx = o->nx[k], ny = o->ny[k], aa = o->arm[0][k], ab = o->arm[1][k], j = l->normal[k];
    const double slip = nx * l->vy[k] - ny * l->vx[k] + aa * l->omega[0][k] + ab * l->omega[1][k];
    const double roll = l->omega[0][k] - l->omega[1][k], normal = j / duration, kn = l->stiffness[k];
    const double ct = limited ? shear_compliance(l, k) : 0, cr = limited ? l->ww[0][k] + l->ww[1][k] : 0;
    const bool acts = j > 0;
    struct slider shear = {force[k], force_stiffness[k]}, turn = {moment[k], moment_stiffness[k]};
    const double sheared = limited ? stored_energy(shear, slip, l->moved[k]) : 0;
    const double turned = limited ? stored_energy(turn, roll, l->moved[k]) : 0;
    double kt = ratio * kn, et = root * l->eta[k], kr = 3 * arm[k] * arm[k] * kn, er = rolling_damper[k] * sqrt(kn);
    if (limited) {
      kt = min_of(kt, 1 / (ct * h * h));
      et = min_of(et, 1 / (2 * ct * h));
      kr = min_of(kr, 1 / (cr * h * h));
      er = min_of(er, 1 / (2 * cr * h));
    }
    double along = slide(&shear, kt, et, slip, l->moved[k], duration * slip_compliance[k], friction[k] * normal);
    double torque = slide(&turn, kr, er, roll, l->moved[k], duration * roll_compliance[k], arm[k] * normal);
    if (limited) {
      along = limit_by_energy(&shear, along, sheared, slip, ct, duration);
      const double after = roll + duration * along * (ab * l->ww[1][k] - aa * l->ww[0][k]);
      torque = limit_by_energy(&turn, torque, turned, after, cr, duration);
    }
    const double jt = acts ? duration * along : 0, jr = acts ? duration * torque : 0;
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
    const size_t e = first + l->entry[k];
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

static inline void store_normal(const struct contact_pass *p, size_t block, struct lanes *l)
{
  double *restrict fx = p->table->fx + table_first(block), *restrict fy = p->table->fy + table_first(block);
  for (int k = 0; k < l->count; k++) {
    const uint8_t e = l->entry[k];
    fx[e] = l->normal[k] * l->overlaps.nx[k];
    fy[e] = l->normal[k] * l->overlaps.ny[k];
  }
}

/* Marks the entries with a state to be kept. */
static void note_live(const struct contact_pass *p, size_t block, bool limited, const struct lanes *l)
{
  const struct contact_table *t = p->table;
  const size_t first = table_first(block);
  for (int k = 0; k < l->count; k++) {
    const size_t e = first + l->entry[k];
    t->live[e] = l->normal[k] > 0 || (limited && t->stored[e] > 0);
  }
}

/* The largest overlap over the smaller radius. */
static double largest_overlap(const struct lanes *l)
{
  double part[BLOCK];
#pragma omp simd
  for (int k = 0; k < l->n; k++) part[k] = l->overlaps.depth[k] / min_of(l->pairs.radius[0][k], l->pairs.radius[1][k]);
  return largest_of(part, l->n);
}

static inline __attribute__((always_inline)) void find_impulses(const struct contact_pass *p, size_t block, bool spin,
                                                                bool limited, enum contact_spring_law law,
                                                                double *max_overlap)
{
  struct lanes l;
  const bool lubricated = spin && p->lubrication;
  load(p, block, spin, limited || lubricated, &l);
  find_overlaps(p, block, spin, law == SPRING_OVERLAP, &l);
  find_normal(p, law, &l);
  if (limited) {
    find_compliances(p, spin, &l);
    limit_normal(p, block, &l);
  }
  if (spin)
    find_friction(p, block, limited, &l);
  else
    store_normal(p, block, &l);
  if (lubricated) add_lubrication(p, block, &l);
  if (spin || limited) note_live(p, block, limited, &l);
  *max_overlap = max_of(*max_overlap, largest_overlap(&l));
}

static inline __attribute__((always_inline)) void find_impulses_by(const struct contact_pass *p, size_t block,
                                                                   enum contact_spring_law law, double *max_overlap)
{
  const struct contact_table *t = p->table;
  if (t->has_spin)
    t->limited ? find_impulses(p, block, true, true, law, max_overlap)
               : find_impulses(p, block, true, false, law, max_overlap);
  else
    t->limited ? find_impulses(p, block, false, true, law, max_overlap)
               : find_impulses(p, block, false, false, law, max_overlap);
}

static void KERNEL(films)(const struct contact_pass *p, size_t block)
{
  struct lanes l;
  memset(p->table->film + table_first(block), 0, BLOCK * sizeof *p->table->film);
  if (p->table->near_count[block] == 0) return;
  load(p, block, false, false, &l);
  find_overlaps(p, block, false, false, &l);
  find_films(p, block, &l);
}

static void KERNEL(impulses)(const struct contact_pass *p, size_t block, double *max_overlap)
{
  if (p->table->near_count[block] == 0) return;
  switch (p->law->spring) {
  case SPRING_OVERLAP:
    find_impulses_by(p, block, SPRING_OVERLAP, max_overlap);
    break;
  case SPRING_HERTZ:
    find_impulses_by(p, block, SPRING_HERTZ, max_overlap);
    break;
  case SPRING_LINEAR:
    find_impulses_by(p, block, SPRING_LINEAR, max_overlap);
    break;
  }
}

extern const struct contact_kernel KERNEL(contact_kernel);
const struct contact_kernel KERNEL(contact_kernel) = {
    .select = KERNEL(select), .rates = KERNEL(rates), .films = KERNEL(films), .impulses = KERNEL(impulses)};
