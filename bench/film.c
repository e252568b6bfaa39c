#include "film.h"

#include "scenes.h"
#include "sim/simulation.h"
#include "steady.h"

#include <math.h>

/* cells/step: within a run a disc moves by less than 1e-6 cells, so that the force is steady */
static const double speed = 1e-12;

enum { HEAVY = 1000000000 }; /* density of discs that keep their velocity; contacts act on free discs only */

static bool is_wall(const struct film *f)
{
  return isinf(f->radius[1]);
}

/* Walls around a pair at 6 R; above a wall at 10 R, periodic along it over 16 R. */
static struct scene film_scene(const struct film *f, double place[2])
{
  const double big = is_wall(f) ? f->radius[0] : fmax(f->radius[0], f->radius[1]);
  const int nx = (int)lround((is_wall(f) ? 16 : 12) * big), ny = (int)lround((is_wall(f) ? 10 : 12) * big);
  const int middle[2] = {nx / 2, ny / 2};
  struct scene scene = scene_box(nx, ny, f->viscosity, SIDES_CLOSED);
  if (is_wall(f)) scene.domain.side[SIDE_LEFT].type = scene.domain.side[SIDE_RIGHT].type = SIDE_PERIODIC;
  scene.contact.lubrication.cutoff = f->cutoff;
  place[0] = middle[0] + f->offset[0];
  place[1] = is_wall(f) ? f->radius[0] + f->gap : middle[1] + f->offset[1];
  return scene;
}

/* Adds the discs; `together`: both with the velocity of a. */
static void add_discs(const struct film *f, enum film_motion motion, bool together, const double place[2],
                      struct scene *scene)
{
  const double n[2] = {is_wall(f) ? 0 : cos(f->angle), is_wall(f) ? -1 : sin(f->angle)}, t[2] = {-n[1], n[0]};
  const double *along = motion == FILM_APPROACH ? n : t;
  const bool translates = motion == FILM_APPROACH || motion == FILM_SLIDE || together;
  const double distance = f->radius[0] + f->radius[1] + f->gap, part = is_wall(f) || together ? 1 : 0.5;
  for (int k = 0; k < (is_wall(f) ? 1 : 2); k++) {
    const double from = is_wall(f) ? 0 : (k ? 0.5 : -0.5) * distance, sign = k && !together ? -1 : 1;
    struct disc_spec *disc = scene_add_disc(scene, f->radius[k], HEAVY, place[0] + from * n[0], place[1] + from * n[1]);
    for (int axis = 0; axis < 2 && translates; axis++) disc->velocity[axis] = sign * part * speed * along[axis];
    if (!translates) disc->spin = speed / f->radius[k] * (k && motion == FILM_ENTRAINMENT ? -1 : 1);
  }
}

/* Force along the mode and torque of disc a on the fluid, over viscosity and speed, the mean of two steps. */
static bool sample(struct simulation *simulation, const double along[2], double viscosity, double loads[2],
                   struct status *status)
{
  const struct discs *d = simulation_discs(simulation);
  loads[0] = loads[1] = 0;
  for (int k = 0; k < 2; k++) {
    if (!simulation_advance(simulation, 1, status)) return false;
    const double fx = d->fx[0] + d->contact_fx[0], fy = d->fy[0] + d->contact_fy[0];
    loads[0] -= (fx * along[0] + fy * along[1]) / (2 * viscosity * speed);
    loads[1] -= (d->torque[0] + d->contact_torque[0]) / (2 * viscosity * speed * d->radius[0]);
  }
  return true;
}

/* Steady force [0] and torque over R_a [1]. */
static bool run(const struct film *f, enum film_motion motion, bool together, double loads[2], struct status *status)
{
  double place[2];
  struct scene scene = film_scene(f, place);
  struct simulation *simulation = NULL;
  const double n[2] = {is_wall(f) ? 0 : cos(f->angle), is_wall(f) ? -1 : sin(f->angle)}, t[2] = {-n[1], n[0]};
  const int64_t interval = (int64_t)(0.025 * scene.domain.size[1] * scene.domain.size[1] / f->viscosity) + 50;
  const int of = motion == FILM_APPROACH || motion == FILM_SLIDE || together ? 0 : 1;
  struct steady steady[2] = {{.enough = 1e-3}, {.enough = 1e-3}};
  add_discs(f, motion, together, place, &scene);
  bool ok = simulation_create(&simulation, &scene, status), known = false;
  for (int k = 0; ok && !known && k < 200; k++) {
    ok = simulation_advance(simulation, interval - 2, status) &&
         sample(simulation, motion == FILM_APPROACH ? n : t, f->viscosity, loads, status);
    for (int load = 0; ok && load < 2; load++) {
      const bool steady_now = steady_add(&steady[load], loads[load]);
      known |= load == of && steady_now;
    }
  }
  if (ok && !known) ok = status_fail(status, DELBM_FAILED, "the force at a gap of %g does not become steady", f->gap);
  if (ok) loads[of] = steady[of].limit;
  simulation_destroy(simulation);
  scene_clear(&scene);
  return ok;
}

bool film_loads(const struct film *f, enum film_motion motion, double loads[2], struct status *status)
{
  return run(f, motion, false, loads, status);
}

bool film_force(const struct film *f, enum film_motion motion, double *force, struct status *status)
{
  double loads[2], common[2];
  if (!run(f, motion, false, loads, status)) return false;
  *force = loads[motion == FILM_SPIN || motion == FILM_ENTRAINMENT];
  if (motion != FILM_ENTRAINMENT) return true;
  if (!run(f, motion, true, common, status)) return false;
  *force -= common[1] * loads[0] / common[0];
  return true;
}

static double exact_at_wall(const struct film *f, enum film_motion motion)
{
  const double s = acosh(1 + f->gap / f->radius[0]);
  if (motion == FILM_APPROACH) return 4 * M_PI / (s - tanh(s));
  return 4 * M_PI / (motion == FILM_SLIDE ? s : tanh(s));
}

bool film_exact(const struct film *f, enum film_motion motion, double *force)
{
  const bool spins = motion == FILM_SPIN || motion == FILM_ENTRAINMENT;
  struct two_discs discs = {.radius = {f->radius[0], f->radius[1]},
                            .gap = f->gap,
                            .approach = motion == FILM_APPROACH,
                            .slide = motion == FILM_SLIDE,
                            .spin = {spins / f->radius[0], (motion == FILM_SPIN ? 1 : -1) * spins / f->radius[1]}};
  struct two_discs_force of;
  if (is_wall(f)) {
    *force = exact_at_wall(f, motion);
    return true;
  }
  if (!two_discs_force(&discs, &of)) return false;
  *force = motion == FILM_APPROACH ? of.normal : motion == FILM_SLIDE ? of.tangential : of.torque[0] / f->radius[0];
  return true;
}

static bool difference(const struct film *f, enum film_motion motion, double *of, double *exact, struct status *status)
{
  if (!film_force(f, motion, of, status)) return false;
  if (!film_exact(f, motion, exact))
    return status_fail(status, DELBM_FAILED, "memory runs out in the solution of two discs");
  *of -= *exact;
  return true;
}

bool film_far(const struct film *f, enum film_motion motion, double *excess, struct status *status)
{
  struct film far = *f;
  double exact;
  far.gap = 4;
  return difference(&far, motion, excess, &exact, status);
}

bool film_error(const struct film *f, enum film_motion motion, double excess, double *error, struct status *status)
{
  double exact;
  if (!difference(f, motion, error, &exact, status)) return false;
  *error = (*error - excess) / exact;
  return true;
}
