#include "contact/geometry.h"

#include <math.h>

static double nearest(const struct scene *scene, int axis, double d)
{
  return nearest_image(d, scene->domain.size[axis], scene_is_periodic(scene, axis));
}

static struct pose pose_at(const struct disc_motions *at, uint32_t i)
{
  return (struct pose){at->x[i], at->y[i], at->angle[i]};
}

static struct body_overlap with_side(const struct scene *scene, const struct shape *shape, enum side_name side,
                                     const struct pose *pose)
{
  double normal[2] = {0, 0};
  normal[side_axis(side)] = side_is_high(side) ? 1 : -1;
  const double distance = scene_distance_to_side(scene, side, (const double[2]){pose->x, pose->y});
  return shape->kind->overlap_half_plane(shape, pose, distance, normal[0], normal[1]);
}

/* Seen from body a, so that the poses differ by the nearest image. */
static struct body_overlap with_body(const struct scene *scene, const struct shape *shape, const struct pose *pose,
                                     const struct shape *other, struct pose other_pose)
{
  const struct pose origin = {.angle = pose->angle};
  other_pose.x = nearest(scene, 0, other_pose.x - pose->x);
  other_pose.y = nearest(scene, 1, other_pose.y - pose->y);
  return shape->kind->overlap(shape, &origin, other, &other_pose);
}

struct kinematics kinematics_of(const struct scene *scene, const struct discs *d, uint32_t a, uint32_t b,
                                const struct disc_motions *at)
{
  const struct pose pose = pose_at(at, a);
  const struct shape *shape = &d->shape[a];
  struct kinematics k = {0};
  struct body_overlap *o = &k.overlap;
  double vx = at->vx[a], vy = at->vy[a], along_n = 0, along_t = 0; /* by the spin of b */
  if (contact_is_with_side(b)) {
    *o = with_side(scene, shape, (enum side_name)(b - contact_sides), &pose);
  } else {
    *o = with_body(scene, shape, &pose, &d->shape[b], pose_at(at, b));
    vx -= at->vx[b];
    vy -= at->vy[b];
    along_n = at->omega[b] * o->offset[1];
    along_t = at->omega[b] * o->arm[1];
  }
  k.approach_speed = vx * o->nx + vy * o->ny - at->omega[a] * o->offset[0] + along_n;
  k.slip_speed = vy * o->nx - vx * o->ny + at->omega[a] * o->arm[0] + along_t;
  return k;
}

void kinematics_respond(struct kinematics *k, const struct exchange *e, uint32_t a, uint32_t b, double h)
{
  const double nx = k->overlap.nx, ny = k->overlap.ny;
  double gain = 0;
  k->compliance = 0;
  for (int end = 0; end < (contact_is_with_side(b) ? 1 : 2); end++) {
    const struct response *r = &e->response[end ? b : a];
    const double offset = k->overlap.offset[end];
    const double acceleration = nx * r->dvx + ny * r->dvy - offset * r->domega;
    gain += end ? -acceleration : acceleration;
    k->compliance += nx * nx * r->xx + 2 * nx * ny * r->xy + ny * ny * r->yy -
                     offset * (2 * (nx * r->xw + ny * r->yw) - offset * r->ww);
  }
  k->mean_speed = k->approach_speed + 0.5 * h * gain;
}
