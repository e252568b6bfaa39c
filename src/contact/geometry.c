#include "contact/geometry.h"

#include <math.h>

static double nearest(const struct scene *scene, int axis, double d)
{
  return nearest_image(d, scene->domain.size[axis], scene_is_periodic(scene, axis));
}

static void with_side(struct kinematics *k, const struct scene *scene, const struct shape *shape, enum side_name side,
                      double x, double y)
{
  double *normal = side_axis(side) == 0 ? &k->nx : &k->ny;
  *normal = side_is_high(side) ? 1 : -1;
  k->distance = k->arm[0] = scene_distance_to_side(scene, side, (const double[2]){x, y});
  k->lens = shape->kind->overlap_half_plane(shape, k->distance);
}

/* Distances from the centres of two discs to the chord of their lens; where one disc is inside the other, to the centre of the smaller
 * one. */
static void find_arms(struct kinematics *k)
{
  const double ra = k->radius[0], rb = k->radius[1], difference = ra - rb;
  const bool inside = k->distance <= fabs(difference);
  k->arm[0] = inside ? (ra > rb ? k->distance : 0) : 0.5 * (k->distance + difference * (ra + rb) / k->distance);
  k->arm[1] = k->distance - k->arm[0];
}

static void with_disc(struct kinematics *k, const struct shape *a, const struct shape *b, double dx, double dy)
{
  k->distance = sqrt(dx * dx + dy * dy);
  k->lens = a->kind->overlap(a, b, dx, dy);
  k->nx = 1; /* coincident centres are pushed apart along x */
  if (k->distance > 0) {
    k->nx = dx / k->distance;
    k->ny = dy / k->distance;
  }
  find_arms(k);
}

struct kinematics kinematics_of(const struct scene *scene, const struct discs *d, uint32_t a, uint32_t b,
                                const struct disc_motions *at)
{
  const bool side = contact_is_with_side(b);
  struct kinematics k = {.radius = {d->radius[a], side ? INFINITY : d->radius[b]}};
  double vx = at->vx[a], vy = at->vy[a], spin = 0;
  if (side) {
    with_side(&k, scene, &d->shape[a], (enum side_name)(b - contact_sides), at->x[a], at->y[a]);
  } else {
    with_disc(&k, &d->shape[a], &d->shape[b], nearest(scene, 0, at->x[b] - at->x[a]),
              nearest(scene, 1, at->y[b] - at->y[a]));
    vx -= at->vx[b];
    vy -= at->vy[b];
    spin = at->omega[b] * k.arm[1];
  }
  k.approach_speed = vx * k.nx + vy * k.ny;
  k.slip_speed = vy * k.nx - vx * k.ny + at->omega[a] * k.arm[0] + spin;
  return k;
}

void kinematics_respond(struct kinematics *k, const struct exchange *e, uint32_t a, uint32_t b, double h)
{
  double gain = 0;
  k->compliance = 0;
  for (int end = 0; end < (contact_is_with_side(b) ? 1 : 2); end++) {
    const struct response *r = &e->response[end ? b : a];
    const double acceleration = k->nx * r->dvx + k->ny * r->dvy;
    gain += end ? -acceleration : acceleration;
    k->compliance += k->nx * k->nx * r->xx + 2 * k->nx * k->ny * r->xy + k->ny * k->ny * r->yy;
  }
  k->mean_speed = k->approach_speed + 0.5 * h * gain;
}
