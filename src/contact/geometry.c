#include "contact/geometry.h"

#include <math.h>

static double nearest(const struct scene *scene, int axis, double d)
{
  return nearest_image(d, scene->domain.size[axis], scene_is_periodic(scene, axis));
}

static struct body_overlap with_side(const struct scene *scene, const struct shape *shape, enum side_name side,
                                     double x, double y)
{
  double normal[2] = {0, 0};
  normal[side_axis(side)] = side_is_high(side) ? 1 : -1;
  const double distance = scene_distance_to_side(scene, side, (const double[2]){x, y});
  return shape->kind->overlap_half_plane(shape, distance, normal[0], normal[1]);
}

struct kinematics kinematics_of(const struct scene *scene, const struct discs *d, uint32_t a, uint32_t b,
                                const struct disc_motions *at)
{
  const bool side = contact_is_with_side(b);
  const struct shape *shape = &d->shape[a];
  struct kinematics k = {.radius = {d->radius[a], side ? INFINITY : d->radius[b]}};
  struct body_overlap *o = &k.overlap;
  double vx = at->vx[a], vy = at->vy[a], spin = 0;
  if (side) {
    *o = with_side(scene, shape, (enum side_name)(b - contact_sides), at->x[a], at->y[a]);
  } else {
    *o = shape->kind->overlap(shape, &d->shape[b], nearest(scene, 0, at->x[b] - at->x[a]),
                              nearest(scene, 1, at->y[b] - at->y[a]));
    vx -= at->vx[b];
    vy -= at->vy[b];
    spin = at->omega[b] * o->arm[1];
  }
  k.approach_speed = vx * o->nx + vy * o->ny;
  k.slip_speed = vy * o->nx - vx * o->ny + at->omega[a] * o->arm[0] + spin;
  return k;
}

void kinematics_respond(struct kinematics *k, const struct exchange *e, uint32_t a, uint32_t b, double h)
{
  const double nx = k->overlap.nx, ny = k->overlap.ny;
  double gain = 0;
  k->compliance = 0;
  for (int end = 0; end < (contact_is_with_side(b) ? 1 : 2); end++) {
    const struct response *r = &e->response[end ? b : a];
    const double acceleration = nx * r->dvx + ny * r->dvy;
    gain += end ? -acceleration : acceleration;
    k->compliance += nx * nx * r->xx + 2 * nx * ny * r->xy + ny * ny * r->yy;
  }
  k->mean_speed = k->approach_speed + 0.5 * h * gain;
}
