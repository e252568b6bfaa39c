#include "sim/footprint.h"

#include "fluid/populations.h"
#include "sim/plan.h"
#include "solid/occupation.h"

static const double gib = 1 << 30;

/* Arrays of numbers, one for each disc, of state, exchange and contacts. */
enum { NUMBERS = 64 };

struct footprint footprint_of(const struct scene *scene)
{
  const int *size = scene->domain.size;
  const double tables = plan_of(scene).occupation == OCCUPATION_EVERY_STEP ? 2 : 1;
  const double disc = sizeof(struct disc_spec) + NUMBERS * sizeof(double), fields = 2 * sizeof(double);
  return (struct footprint){
      .fluid = (double)populations_bytes(size[0], size[1], scene->fluid.precision),
      .discs = tables * occupation_bytes(scene) + disc * (double)scene->particles.count,
      .frames = scene->output.frames.every > 0 ? fields * (double)scene_cells(scene) : 0,
  };
}

double footprint_total(const struct footprint *f)
{
  return f->fluid + f->discs + f->frames;
}

bool footprint_check(const struct scene *scene, double available, struct status *status)
{
  const struct footprint f = footprint_of(scene);
  if (footprint_total(&f) <= available) return true;
  return status_fail(
      status, DELBM_INVALID,
      "%s: the run would take %.3g GiB of memory (fluid %.3g, discs %.3g, frames %.3g), and this machine has %.3g",
      f.discs > f.fluid ? "particles" : "domain.size", footprint_total(&f) / gib, f.fluid / gib, f.discs / gib,
      f.frames / gib, available / gib);
}
