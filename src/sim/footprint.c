#include "sim/footprint.h"

#include "base/threads.h"
#include "fluid/populations.h"
#include "sim/contacts.h"
#include "sim/sample.h"

#include <math.h>

static const double gib = 1 << 30;

/* Arrays of numbers, one for each disc, of state, exchange and sub-steps. */
enum { NUMBERS = 64 };

/* Lists that grow hold up to half as much again as they need, and exist twice while they are copied. */
static const double growth = 2.5;

/* Discs of one size have at most six neighbours, each shared by two; and some touch a side. */
enum { PAIRS = 3, CONTACTS = 4 };

/* Cells of the grid that linked cells sort discs into. */
static double linked_cells(const struct scene *scene, double reach)
{
  double edge = scene->contact.edge;
  if (!(edge > 0)) {
    double radius = 0;
    for (size_t i = 0; i < scene->particles.count; i++) radius = fmax(radius, scene->particles.discs[i].radius);
    edge = 2 * radius + reach;
  }
  return (scene->domain.size[0] / edge + 1) * (scene->domain.size[1] / edge + 1);
}

/* What two discs have in common is noted once; with areas by cells in each row that they share, which are no more than the
 * rows of the smaller one. */
static double bytes_of_contacts(const struct scene *scene, const struct stages *stages)
{
  const double count = (double)scene->particles.count, pair = sizeof(struct near_pair);
  const bool linked = scene->contact.search == SEARCH_LINKED_CELL, by_cells = scene->contact.area == AREA_CELLS;
  if (!stages->pairs && !stages->walls) return 0;
  double bytes = CONTACTS * count * growth * sizeof(struct contact);
  if (!stages->pairs) return bytes;
  double notes = PAIRS * count;
  for (size_t i = 0; by_cells && i < scene->particles.count; i++)
    notes += PAIRS * (2 * scene->particles.discs[i].radius + 2);
  bytes += growth * pair * (PAIRS * count + 2 * notes); /* the list; as found, and sorted */
  if (linked) bytes += linked_cells(scene, stages->reach) * (sizeof(size_t) + sizeof(struct pair_batch));
  return bytes;
}

static double bytes_of_fields(const struct scene *scene)
{
  enum { VALUES = 7, POINT = 10 };
  if (scene->output.fields.every == 0) return 0;
  const struct sample_grid grid = sample_grid_of(scene);
  const double rows = (double)threads_for(scene_cells(scene)) * scene->domain.size[0];
  return sizeof(double) *
         (VALUES * ((double)sample_points(&grid) + rows) + growth * POINT * (double)scene->particles.count);
}

/* Measured with nothing to simulate; the rest is for chunks of HDF5, and for a picture and libpng. */
static double bytes_of_program(const struct scene *scene)
{
  const double mib = 1 << 20;
  return 16 * mib + (scene->output.fields.every > 0 ? 12 * mib : 0) + (scene->output.frames.every > 0 ? 8 * mib : 0);
}

struct footprint footprint_of(const struct scene *scene)
{
  const int *size = scene->domain.size;
  const struct stages stages = stages_of(scene);
  const double tables = stages.occupation == OCCUPATION_EVERY_STEP ? 2 : 1;
  const double disc = sizeof(struct disc_spec) + NUMBERS * sizeof(double), velocity = 2 * sizeof(double);
  return (struct footprint){
      .fluid = (double)populations_bytes(size[0], size[1], scene->fluid.precision),
      .discs = tables * occupation_bytes(scene) + disc * (double)scene->particles.count,
      .contacts = bytes_of_contacts(scene, &stages),
      .fields = bytes_of_fields(scene),
      .frames = scene->output.frames.every > 0 ? velocity * (double)scene_cells(scene) : 0,
      .program = bytes_of_program(scene),
  };
}

double footprint_total(const struct footprint *f)
{
  return f->fluid + f->discs + f->contacts + f->fields + f->frames + f->program;
}

/* The key of the largest part. */
static const char *key_to_blame(const struct footprint *f)
{
  const double discs = f->discs + f->contacts;
  if (f->fields > fmax(f->fluid, discs)) return "output.fields";
  return discs > f->fluid ? "particles" : "domain.size";
}

bool footprint_check(const struct scene *scene, double available, struct status *status)
{
  const struct footprint f = footprint_of(scene);
  if (footprint_total(&f) <= available) return true;
  return status_fail(status, DELBM_INVALID,
                     "%s: the run would take %.3g GiB of memory (fluid %.3g, discs %.3g, contacts %.3g, fields %.3g, "
                     "frames %.3g, program %.3g), and this machine has %.3g",
                     key_to_blame(&f), footprint_total(&f) / gib, f.fluid / gib, f.discs / gib, f.contacts / gib,
                     f.fields / gib, f.frames / gib, f.program / gib, available / gib);
}
