#include "sim/meeting.h"

#include <math.h>

double distance_to_side(const struct scene *scene, enum side_name side, double x, double y)
{
  switch (side) {
  case SIDE_LEFT:
    return x;
  case SIDE_RIGHT:
    return scene->domain.size[0] - x;
  case SIDE_BOTTOM:
    return y;
  default:
    return scene->domain.size[1] - y;
  }
}

static double nearest(const struct scene *scene, int axis, double d)
{
  return nearest_image(d, scene->domain.size[axis], scene_is_periodic(scene, axis));
}

static struct meeting with_side(const struct scene *scene, const struct contact *c, const struct places *at,
                                double radius)
{
  static const double normal[SIDE_COUNT][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
  const enum side_name side = (enum side_name)(c->b - contact_sides);
  const double *n = normal[side];
  const double distance = distance_to_side(scene, side, at->x[c->a], at->y[c->a]);
  return (struct meeting){.lens = lens_of_wall(radius, distance),
                          .distance = distance,
                          .nx = n[0],
                          .ny = n[1],
                          .arm = {distance, 0},
                          .closing = at->vx[c->a] * n[0] + at->vy[c->a] * n[1]};
}

/* Distances from the centres of two discs to the chord of their lens, which sum to the distance of centres; where one disc
 * is inside the other, the contact point is the centre of the smaller one. */
static void find_arms(double ra, double rb, double distance, double arm[2])
{
  const double difference = ra - rb;
  const bool inside = distance <= fabs(difference);
  arm[0] = inside ? (ra > rb ? distance : 0) : 0.5 * (distance + difference * (ra + rb) / distance);
  arm[1] = distance - arm[0];
}

struct meeting meeting_of(const struct scene *scene, const struct discs *d, const struct contact *c,
                          const struct places *at)
{
  const uint32_t a = c->a, b = c->b;
  if (contact_is_with_side(c)) return with_side(scene, c, at, d->radius[a]);
  const double dx = nearest(scene, 0, at->x[b] - at->x[a]), dy = nearest(scene, 1, at->y[b] - at->y[a]);
  const double distance = sqrt(dx * dx + dy * dy);
  struct meeting meeting = {.lens = lens_of_discs(d->radius[a], d->radius[b], distance), .distance = distance, .nx = 1};
  if (distance > 0) { /* coincident centres are pushed apart along x */
    meeting.nx = dx / distance;
    meeting.ny = dy / distance;
  }
  find_arms(d->radius[a], d->radius[b], distance, meeting.arm);
  meeting.closing = (at->vx[a] - at->vx[b]) * meeting.nx + (at->vy[a] - at->vy[b]) * meeting.ny;
  if (scene->contact.area == AREA_CELLS)
    meeting.lens.area = c->touch > 0 ? lens_small_area(c->small, fmax(0, c->touch - distance)) : c->cells_area;
  return meeting;
}

double meeting_compliance(const struct meeting *at, const struct contact *c, const struct exchange *e)
{
  double sum = 0;
  for (int end = 0; end < (contact_is_with_side(c) ? 1 : 2); end++) {
    const struct response *r = &e->response[end ? c->b : c->a];
    sum += at->nx * at->nx * r->xx + 2 * at->nx * at->ny * r->xy + at->ny * at->ny * r->yy;
  }
  return sum;
}

double meeting_gain(const struct meeting *at, const struct contact *c, const struct exchange *e)
{
  const struct response *a = &e->response[c->a];
  if (contact_is_with_side(c)) return at->nx * a->dvx + at->ny * a->dvy;
  const struct response *b = &e->response[c->b];
  return at->nx * (a->dvx - b->dvx) + at->ny * (a->dvy - b->dvy);
}
