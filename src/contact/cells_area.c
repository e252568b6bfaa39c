#include "contact/cells_area.h"

#include <math.h>

enum { ROWS = 8 }; /* evaluated in one call */

static size_t scratch_of(double radius)
{
  return ROWS * ((size_t)ceil(2 * radius) + 3) + SHAPE_PAD;
}

size_t cells_area_scratch(const struct discs *d)
{
  double radius = 0;
  for (size_t i = 0; i < d->count; i++) radius = fmax(radius, d->radius[i]);
  return 2 * scratch_of(radius);
}

/* One of the two bodies, at its image nearest to the other body, and the fractions eps of up to ROWS rows. */
struct body {
  const struct shape *shape;
  struct pose pose;
  struct shape_box box;
  struct row_extents extents;
  double *eps;
};

static void find_fractions(struct body *c, int row, int rows)
{
  c->shape->kind->extents(c->shape, &c->pose, row, rows, &c->extents);
  c->shape->kind->fractions(c->shape, &c->pose, row, 0, rows, &c->extents, c->eps);
}

static int larger(int a, int b)
{
  return a > b ? a : b;
}

static int smaller(int a, int b)
{
  return a < b ? a : b;
}

/* (23) over row k of the extents; `a` and `b`: fractions of its cells. */
static double row_area(const struct scene *scene, const struct body c[2], int k, const double *a, const double *b)
{
  const int first_a = c[0].box.column + c[0].extents.first[k], first_b = c[1].box.column + c[1].extents.first[k];
  int first = larger(first_a, first_b);
  int end = smaller(c[0].box.column + c[0].extents.end[k], c[1].box.column + c[1].extents.end[k]);
  double area = 0;
  if (!scene_is_periodic(scene, 0)) {
    first = larger(first, 0);
    end = smaller(end, scene->domain.size[0]);
  }
  for (int x = first; x < end; x++) {
    const double eps_a = a[x - first_a], eps_b = b[x - first_b];
    if (eps_a > 0 && eps_b > 0) area += fmax(0, eps_a + eps_b - cells_area_minimum);
  }
  return area;
}

double cells_area(const struct scene *scene, const struct discs *d, uint32_t a, uint32_t b, double *scratch)
{
  struct body c[2] = {{.shape = &d->shape[a], .pose = discs_pose(d, a), .eps = scratch},
                      {.shape = &d->shape[b], .pose = discs_pose(d, b), .eps = scratch + scratch_of(d->radius[a])}};
  const int *size = scene->domain.size;
  c[1].pose.x = c[0].pose.x + nearest_image(c[1].pose.x - c[0].pose.x, size[0], scene_is_periodic(scene, 0));
  c[1].pose.y = c[0].pose.y + nearest_image(c[1].pose.y - c[0].pose.y, size[1], scene_is_periodic(scene, 1));
  for (int k = 0; k < 2; k++) c[k].box = c[k].shape->kind->box(c[k].shape, &c[k].pose);
  int first = larger(c[0].box.row, c[1].box.row);
  int end = smaller(c[0].box.row + c[0].box.rows, c[1].box.row + c[1].box.rows);
  if (!scene_is_periodic(scene, 1)) {
    first = larger(first, 0);
    end = smaller(end, size[1]);
  }
  double area = 0;
  for (int row = first; row < end; row += ROWS) {
    const int rows = smaller(ROWS, end - row);
    const double *eps[2] = {c[0].eps, c[1].eps};
    for (int k = 0; k < 2; k++) find_fractions(&c[k], row, rows);
    for (int k = 0; k < rows; k++) {
      area += row_area(scene, c, k, eps[0], eps[1]);
      for (int n = 0; n < 2; n++) eps[n] += c[n].extents.end[k] - c[n].extents.first[k];
    }
  }
  return area;
}
