#include "cli/advice.h"
#include "cli/commands.h"
#include "cli/report.h"

#include "base/memory.h"
#include "base/threads.h"
#include "case/case_keys.h"
#include "case/case_overlaps.h"
#include "case/case_tree.h"
#include "contact/substeps.h"
#include "fluid/sweep.h"
#include "sim/diagnostics.h"
#include "sim/estimate.h"
#include "sim/load.h"
#include "sim/simulation.h"
#include "sim/tuning.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { CHOICE = 32 };

/* Name of a value of an enumeration in a case. */
static const char *choice_of(const char *path, unsigned value, char text[CHOICE])
{
  int length;
  const char *name = key_choice(key_find(path), (int)value, &length);
  snprintf(text, CHOICE, "%.*s", length, name);
  return text;
}

static void print_box(const struct scene *scene)
{
  char type[CHOICE];
  printf("box          %d x %d cells;", scene->domain.size[0], scene->domain.size[1]);
  for (int k = 0; k < SIDE_COUNT; k++) {
    const struct side *side = &scene->domain.side[k];
    printf(" %s %s", side_name_text((enum side_name)k), choice_of("domain.left.type", side->type, type));
    if (side->velocity[0] != 0 || side->velocity[1] != 0) printf(" at (%g, %g)", side->velocity[0], side->velocity[1]);
  }
  printf("\n");
}

/* Converts a number with a lattice unit to SI. */
static double in_si(const struct scene *scene, double number, const char *unit)
{
  struct unit from;
  return unit_parse(unit, &scene->units, &from) ? number * (double)from.scale : NAN;
}

static void print_units(const struct scene *scene)
{
  const struct units *units = &scene->units;
  const int *size = scene->domain.size;
  if (units->dx == 0) return;
  printf("units        cell %g m, step %g s: 1 cell/step is %g m/s, 1 cell/step^2 %g m/s^2\n", units->dx, units->dt,
         in_si(scene, 1, "cells/step"), in_si(scene, 1, "cells/step^2"));
  printf("             box %g m x %g m, ", size[0] * units->dx, size[1] * units->dx);
  if (!scene->fluid.none) printf("viscosity %g m^2/s, ", in_si(scene, scene->fluid.viscosity, "cells^2/step"));
  printf("run of %g s", (double)scene->run.steps * units->dt);
  if (units->density > 0) printf(", %s %g kg/m^3", scene->fluid.none ? "density 1 is" : "fluid of", units->density);
  printf("\n");
}

/* Prints keys and values for a lattice viscosity of `wanted` at the same physical viscosity. */
static void advise_viscosity(const struct scene *scene, double wanted)
{
  const bool more = wanted > scene->fluid.viscosity;
  const char *to = more ? ">=" : "<=";
  const double factor = wanted / scene->fluid.viscosity;
  printf("fluid.viscosity %s %.3g", to, wanted);
  if (scene->units.dx > 0)
    printf(", by units.dt %s %.3g s (units.viscosity %s %.3g) or units.dx %s %.3g m", to, scene->units.dt * factor, to,
           wanted, more ? "<=" : ">=", scene->units.dx / sqrt(factor));
  printf("\n");
}

static void print_fluid(const struct scene *scene)
{
  if (scene->fluid.none) {
    printf("fluid        none: dry discs, no lattice\n");
    return;
  }
  char collision[CHOICE];
  const struct rates *rates = &scene->fluid.rates;
  const double tau = 1 / rates->s_nu;
  printf("fluid        viscosity %g, tau %.6g; %s with s_nu %.6g, s_e %.6g, s_q %.6g (magic %.4g)",
         scene->fluid.viscosity, tau, choice_of("fluid.collision", scene->fluid.collision, collision), rates->s_nu,
         rates->s_e, rates->s_q, (1 / rates->s_q - 0.5) * (tau - 0.5));
  if (rates->s_q_fast > 0)
    printf(" where |u| is far below %g cells/step, %g far above", scene->fluid.viscosity, rates->s_q_fast);
  printf("\n");
  if (scene->fluid.zero_flux)
    printf("zero flux    on: a uniform force, set every %d steps, cancels the mean momentum%s%s\n",
           zero_flux_create(scene).interval, scene_is_closed(scene, 0) ? " in x" : "",
           scene_is_closed(scene, 1) ? " in y" : "");
  if (tau > 1.5) {
    printf("  note: tau above 1.5; walls and discs lose accuracy; better: ");
    advise_viscosity(scene, (1.5 - 0.5) / 3);
  }
  if (tau < estimate_min_tau) {
    printf("  note: tau below %g, close to 1/2: errors are hardly damped, and no collision operator is "
           "reliable above Mach 0.2 (bench/STABILITY.md); better: ",
           estimate_min_tau);
    advise_viscosity(scene, (estimate_min_tau - 0.5) / 3);
  }
}

/* Prints a note with keys and values if the speed is above the advised maximum. */
static void advise_speed(const struct scene *scene, const struct estimate *fastest)
{
  const double advised = scene_advised_speed;
  if (fastest->speed <= advised) return;
  printf("  note: Mach above %.2g (%g cells/step); errors grow with its square; better: %s <= %.3g %s",
         advised * sqrt(3), advised, fastest->key, fastest->advised, fastest->unit);
  if (scene->units.dx > 0) {
    const double slower = advised / fastest->speed;
    struct unit unit;
    char si[UNIT_TEXT];
    unit_parse(fastest->unit, &scene->units, &unit);
    unit_si_text(&unit, si);
    printf(" (%.3g %s), or units.dt <= %.3g s (units.viscosity <= %.3g)", in_si(scene, fastest->advised, fastest->unit),
           si, scene->units.dt * slower, scene->fluid.viscosity * slower);
  }
  printf("\n");
}

static void advise_cells(const struct scene *scene, double speed)
{
  const double grid_reynolds = speed / scene->fluid.viscosity;
  if (grid_reynolds <= estimate_max_grid_reynolds) return;
  printf("  note: grid Reynolds number (of one cell) %.3g, above %g: cells too coarse for the flow, which may become "
         "unstable; better: fluid.viscosity >= %.3g",
         grid_reynolds, estimate_max_grid_reynolds, speed / estimate_max_grid_reynolds);
  if (scene->units.dx > 0)
    printf(", by units.dx <= %.3g m", scene->units.dx * estimate_max_grid_reynolds / grid_reynolds);
  printf("\n");
}

/* Length in the Reynolds number: largest diameter or, without discs, width of the flow. */
static double reynolds_length(const struct scene *scene)
{
  const int *size = scene->domain.size;
  double length = 0;
  for (size_t i = 0; i < scene->particles.count; i++) length = fmax(length, 2 * scene->particles.discs[i].radius);
  if (length > 0) return length;
  for (int axis = 0; axis < 2; axis++)
    if (scene_is_closed(scene, axis) && !scene_is_closed(scene, !axis)) return size[axis];
  return fmin(size[0], size[1]);
}

static void print_force(const struct scene *scene)
{
  const double *force = scene->fluid.force;
  double along[2];
  for (int axis = 0; axis < 2; axis++) along[axis] = estimate_forced(scene, axis, scene->run.steps);
  if (force[0] == 0 && force[1] == 0) return;
  printf("force        (%g, %g) per unit mass", force[0], force[1]);
  if (hypot(along[0], along[1]) > 0)
    printf(": drives the fluid to about %.3g cells a step by the end of the run\n", hypot(along[0], along[1]));
  else
    printf(": along no periodic axis; its effect depends on the sides\n");
}

/* Speeds without fluid, which only the search for contacts limits. */
static void print_dry_speeds(const struct scene *scene)
{
  const struct estimate fastest = estimate_fastest(scene, scene->run.steps);
  if (fastest.speed == 0) {
    printf("speed        not determined by the case\n");
    return;
  }
  printf("speed        about %.3g cells a step (%s), where nothing stops them\n", fastest.speed, fastest.from);
  if (fastest.speed <= estimate_advised_speed(scene)) return;
  printf("  note: above %g cells/step, and the run ends at %.3g, since contacts may be missed; better: %s <= %.3g %s",
         estimate_advised_speed(scene), diagnostics_speed_limit, fastest.key, fastest.advised, fastest.unit);
  if (scene->units.dx > 0)
    printf(", or units.dt <= %.3g s", scene->units.dt * estimate_advised_speed(scene) / fastest.speed);
  printf("\n");
}

static void print_speeds(const struct scene *scene)
{
  const struct estimate fastest = estimate_fastest(scene, scene->run.steps);
  const double length = reynolds_length(scene);
  print_force(scene);
  if (fastest.speed == 0) {
    printf("speed        not determined by the case: no Reynolds number\n");
    return;
  }
  printf("speed        about %.3g cells a step (%s): Mach %.3g, Reynolds number %.3g over %g cells\n", fastest.speed,
         fastest.from, fastest.speed * sqrt(3), fastest.speed * length / scene->fluid.viscosity, length);
  advise_speed(scene, &fastest);
  advise_cells(scene, fastest.speed);
}

static void print_discs(const struct scene *scene)
{
  char solve[CHOICE];
  static const char *const forms[] = {"unified (17)-(18)", "owen (12)-(13)", "midpoint"};
  double smallest = INFINITY, largest = 0, area = 0;
  size_t motions[3] = {0};
  for (size_t i = 0; i < scene->particles.count; i++) {
    const struct disc_spec *disc = &scene->particles.discs[i];
    smallest = fmin(smallest, disc->radius);
    largest = fmax(largest, disc->radius);
    area += disc_spec_area(disc);
    motions[disc->motion]++;
  }
  const double box = (double)scene->domain.size[0] * scene->domain.size[1], part = scene->coupling.hydraulic_radius;
  printf("discs        %zu (%zu free, %zu fixed, %zu driven), radius %g to %g, solid fraction %.4g\n",
         scene->particles.count, motions[DISC_FREE], motions[DISC_FIXED], motions[DISC_DRIVEN], smallest, largest,
         area / box);
  if (part < 1)
    printf("hydraulic    radius %g to %g for the fluid, solid fraction %.4g\n", part * smallest, part * largest,
           part * part * area / box);
  if (part * smallest < 2)
    printf("  note: %sradius below 2 cells; forces on so small a disc are rough; better: radius >= %.2g\n",
           part < 1 ? "hydraulic " : "", 2 / part);
  if (!scene->fluid.none)
    printf("coupling     %s, %s\n", forms[scene->coupling.form],
           choice_of("coupling.solve", scene->coupling.solve, solve));
}

/* Prints the first few initial overlaps, and the number of further ones. */
static bool print_overlaps(const struct scene *scene, struct status *status)
{
  enum { SHOWN = 5 };
  struct case_overlaps found;
  const bool ok = case_overlaps_find(scene, scene->particles.count, &found, status);
  if (ok && found.count > 0)
    printf("  note: %zu overlap%s at the start, which contacts push apart:", found.count, found.count == 1 ? "" : "s");
  for (size_t k = 0; ok && k < found.count && k < SHOWN; k++) {
    const struct case_overlap *overlap = &found.list[k];
    printf("%s disc %zu and ", k ? ";" : "", overlap->a);
    if (case_overlap_is_with_side(overlap))
      printf("the %s side", side_name_text((enum side_name)(overlap->b - overlap_sides)));
    else
      printf("disc %zu", overlap->b);
    printf(", %.3g cells", overlap->depth);
  }
  if (ok && found.count > SHOWN) printf("; and %zu more", found.count - SHOWN);
  if (ok && found.count > 0) printf("\n");
  case_overlaps_clear(&found);
  return ok;
}

/* The bodies of a load: "radius 5 on radius 3". */
static void print_bodies(const struct load *load, const char *between)
{
  printf("radius %g %s ", load->radius[0], between);
  if (isinf(load->radius[1]))
    printf("a side");
  else
    printf("radius %g", load->radius[1]);
}

/* Prints the expected loads of contacts, the overlap under each, and the sub-steps that each needs. */
static void print_loads(const struct scene *scene)
{
  const double many_substeps = 50;
  const struct loads loads = loads_of(scene);
  const char *before = "loads        ";
  int substeps = 1;
  if (loads.at_rest.force > 0) {
    printf("%sat rest %.3g, ", before, loads.at_rest.force);
    print_bodies(&loads.at_rest, "on");
    printf(": overlap %.2g %% of the smaller radius\n", 100 * load_overlap(scene, &loads.at_rest));
    before = "             ";
  }
  if (loads.impact.energy > 0) {
    printf("%simpact at up to %.3g cells/step, ", before, loads.impact.speed);
    print_bodies(&loads.impact, "against");
    substeps = load_substeps(scene, &loads.impact);
    printf(": overlap up to %.2g %%, about %d sub-step%s a step\n", 100 * load_overlap(scene, &loads.impact), substeps,
           substeps == 1 ? "" : "s");
  }
  if (substeps > many_substeps)
    printf(
        "  note: so many sub-steps take longer than the fluid; better: contact.overlap >= %.2g, or contact.stiffness "
        "<= %.2g\n",
        fmin(0.1, scene->contact.overlap * substeps / many_substeps),
        scene->contact.stiffness * pow(many_substeps / substeps, 2.5));
}

static void print_contacts(const struct scene *scene, const struct stages *stages)
{
  static const char *const sources[] = {[STIFFNESS_GIVEN] = "",
                                        [STIFFNESS_AT_REST] = " (auto: load at rest)",
                                        [STIFFNESS_IMPACT] = " (auto: impacts)",
                                        [STIFFNESS_START] =
                                            " (auto: overlaps at the start, which are to part at 0.1 cells/step)",
                                        [STIFFNESS_SUBSTEPS] = " (auto: the number of sub-steps)",
                                        [STIFFNESS_LEAST] = " (auto: the least)"};
  if (!stages->pairs && !stages->walls) return;
  char area[CHOICE], law[CHOICE];
  printf("contacts     law %s, area by %s, stiffness %g%s, ", choice_of("contact.law", scene->contact.law, law),
         choice_of("contact.area", scene->contact.area, area), scene->contact.stiffness,
         sources[scene->contact.stiffness_source]);
  if (scene->contact.alpha > 0)
    printf("alpha %g, ", scene->contact.alpha);
  else
    printf("alpha of the radii, ");
  if (scene->contact.restitution > 0)
    printf("restitution %g\n", scene->contact.restitution);
  else
    printf("damping %g (%s)\n", scene->contact.damping,
           scene->contact.damping_form == DAMPING_CRITICAL ? "critical" : "as printed");
  if (scene->contact.friction > 0 || scene->contact.rolling_friction > 0)
    printf("friction     %g, tangential stiffness %g of the normal; rolling friction %g\n", scene->contact.friction,
           scene->contact.tangential_ratio, scene->contact.rolling_friction);
  if (scene->contact.substeps > 0)
    printf("sub-steps    %d a step, as the case says\n", scene->contact.substeps);
  else if (stages->substeps)
    printf("sub-steps    chosen each step for %g of them a contact; %d at an overlap of one cell\n",
           scene->contact.steps_per_contact, substeps_by_lens(scene));
  else if (substeps_by_lens(scene) > 1)
    printf("sub-steps    1: areas by cells are known once a step\n"
           "  note: with contact.area: lens, contacts of this stiffness take up to %d; with one, their damping and "
           "overlap are inaccurate; better: contact.area: lens, or a smaller contact.stiffness\n",
           substeps_by_lens(scene));
  else
    printf("sub-steps    1: a contact lasts more than %g steps\n", scene->contact.steps_per_contact);
  print_loads(scene);
}

static void print_plan(const struct scene *scene)
{
  if (scene->fluid.none) return;
  struct tuning tuning;
  tuning_start(&tuning, scene, stages_threads(scene));
  if (!tuning.decided)
    printf("blocking     in time, depth by trial in the first steps (run.json has it); fix it by --plan\n");
  else if (tuning.best.depth <= 1)
    printf("blocking     off\n");
  else if (scene->particles.count > 0)
    printf("blocking     in time, %d steps deep, of rows that no disc can reach\n", tuning.best.depth);
  else
    printf("blocking     in time, %d steps deep, tiles of %d cells (0: whole rows)\n", tuning.best.depth,
           tuning.best.width);
}

/* Memory for output: velocities of a frame, values of a snapshot, and measured 8 MiB of libpng and 12 MiB of HDF5. */
static double bytes_of_output(const struct scene *scene)
{
  enum { VALUES = 7 };
  const double mib = 1 << 20;
  double bytes = 0;
  const double velocities = scene->fluid.none ? 0 : 2 * sizeof(double) * (double)scene_cells(scene);
  if (scene->output.frames.every > 0) bytes += velocities + 8 * mib;
  if (scene->output.fields.every > 0) {
    const struct sample_grid grid = sample_grid_of(scene);
    bytes += VALUES * sizeof(double) * (double)sample_points(&grid) + 12 * mib;
  }
  return bytes;
}

static bool print_memory(const struct scene *scene, struct status *status)
{
  const double mib = 1 << 20, physical = memory_physical();
  struct simulation_memory memory;
  const double program = 10 * mib; /* measured with an empty box: code, libraries, stacks */
  if (!simulation_measure(scene, &memory, status)) {
    if (status->code == DELBM_INVALID) printf("memory       %s\n", status->message);
    return status->code == DELBM_INVALID;
  }
  const double output = bytes_of_output(scene), all = program + memory.populations + memory.tables + output;
  printf("memory       program %.4g MiB", program / mib);
  if (!scene->fluid.none)
    printf(", fluid %.4g MiB (%.1f bytes a cell)", memory.populations / mib,
           memory.populations / (double)scene_cells(scene));
  if (scene->particles.count > 0) printf(", discs %.4g MiB", memory.tables / mib);
  if (output > 0) printf(", output %.4g MiB", output / mib);
  printf(", in all about %.4g MiB\n", all / mib);
  if (all > physical)
    printf("  note: more than the %.4g MiB of this machine; it would not be run here\n", physical / mib);
  return true;
}

static void print_stages(const struct scene *scene, const struct stages *stages)
{
  static const char *const occupation[] = {"left out: no discs", "once, before the first step: no disc moves",
                                           "every step"};
  printf("stages\n");
  printf("  occupation %s\n", !stages->fluid ? "left out: no fluid" : occupation[stages->occupation]);
  printf("  exchange   %s\n", !stages->fluid                          ? "left out: no fluid; move alone"
                              : !stages->exchange                     ? "left out: no discs"
                              : stages->occupation == OCCUPATION_ONCE ? "gather only, for the forces: no disc is free"
                                                                      : "gather, solve, move");
  printf("  contact    %s\n", stages->pairs && stages->walls ? "pairs and sides"
                              : stages->pairs                ? "pairs; no sides: the box is periodic"
                              : stages->walls                ? "sides; no pairs: one disc"
                                                             : "left out: no contact is possible");
  if (!stages->fluid) {
    printf("  boundary   left out: no fluid\n  sweep      left out: no fluid\n");
    return;
  }
  printf("  boundary   %s\n", scene_is_periodic(scene, 0) && scene_is_periodic(scene, 1)
                                  ? "periodic images, with the sweep of each row"
                                  : "with the sweep of each row");
  printf("  sweep      every step, %s%s\n", stages->exchange ? "with discs in the rows that have any" : "fluid alone",
         stages->force ? ", with force" : ", no force");
}

static int print_case(struct arguments *arguments)
{
  const struct scene *scene = &arguments->scene;
  struct status status;
  const struct stages stages = stages_of(scene);
  const struct sweep_kernel *kernel = NULL;
  if (stages.fluid && !(kernel = sweep_find(scene->fluid.kernel, scene->fluid.precision, &status)))
    return report_error(&status);
  char title[TREE_TEXT]; /* without control characters, which a terminal would execute */
  tree_show(scene->title, title);
  printf("case         %s%s%s\n", scene->name, *title ? ": " : "", title);
  print_box(scene);
  print_units(scene);
  notes_print(&arguments->notes, "  note: ", stdout);
  print_fluid(scene);
  if (stages.fluid)
    print_speeds(scene);
  else
    print_dry_speeds(scene);
  if (stages.discs) print_discs(scene);
  print_contacts(scene, &stages);
  if (stages.discs && !print_overlaps(scene, &status)) return report_error(&status);
  print_advice(scene);
  char binding[THREADS_TEXT];
  threads_binding(binding);
  printf("run          %" PRId64 " steps, %d threads (%s)%s%s\n", scene->run.steps, stages_threads(scene), binding,
         kernel ? ", kernel " : "", kernel ? kernel->name : "");
  print_plan(scene);
  if (!print_memory(scene, &status)) return report_error(&status);
  print_stages(scene, &stages);
  return DELBM_OK;
}

const struct command command_info = {
    .name = "info",
    .purpose = "show a case and the plan of its run",
    .operand_name = "CASE",
    .operand = OPERAND_CASE,
    .about = "Describes a case without running it: relaxation, expected speeds and Reynolds numbers, contacts, "
             "memory,\n"
             "and which stages of the step will run.",
    .options = {{"set", "key=value", "replaces a value of the case, as for `delbm run`", .kind = OPTION_SETTING},
                {"help", NULL, "this text", .kind = OPTION_HELP}},
    .run = print_case,
};
