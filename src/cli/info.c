#include "cli/advice.h"
#include "cli/commands.h"
#include "cli/options.h"

#include "base/memory.h"
#include "base/threads.h"
#include "contact/law.h"
#include "fluid/sweep.h"
#include "scene/scene_tree.h"
#include "sim/blocked.h"
#include "sim/footprint.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Where a note is due: rules of thumb. */
static const double least_tau = 0.503, most_mach = 0.3, most_grid_reynolds = 10;

enum { OPTION_SET = OPTION_OWN };

const struct option info_options[] = {
    {"set", required_argument, NULL, OPTION_SET}, {"help", no_argument, NULL, OPTION_HELP}, {0}};

static void print_help(void)
{
  puts("usage: delbm info CASE [--set key=value]...\n"
       "\n"
       "Shows what a case means, without running it: relaxation, expected speeds and Reynolds numbers, contacts, "
       "memory,\n"
       "and which stages of the step will run.\n"
       "\n"
       "  --set key=value  replaces a value of the case, as for `delbm run`\n"
       "  --help           this text");
}

static void print_box(const struct scene *scene)
{
  static const char *const types[] = {"wall", "periodic", "inlet", "outlet"};
  static const char *const sides[] = {"left", "right", "bottom", "top"};
  printf("box          %d x %d cells;", scene->domain.size[0], scene->domain.size[1]);
  for (int k = 0; k < SIDE_COUNT; k++) {
    const struct side *side = &scene->domain.side[k];
    printf(" %s %s", sides[k], types[side->type]);
    if (side->velocity[0] != 0 || side->velocity[1] != 0) printf(" at (%g, %g)", side->velocity[0], side->velocity[1]);
  }
  printf("\n");
}

/* A number in the unit that it has on the lattice, in SI. */
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
  printf("             box %g m x %g m, viscosity %g m^2/s, run of %g s", size[0] * units->dx, size[1] * units->dx,
         in_si(scene, scene->fluid.viscosity, "cells^2/step"), (double)scene->run.steps * units->dt);
  if (units->density > 0) printf(", fluid of %g kg/m^3", units->density);
  printf("\n");
}

/* What to change so that the lattice viscosity becomes `wanted`, the physical one staying as it is. */
static void advise_viscosity(const struct scene *scene, double wanted)
{
  const bool more = wanted > scene->fluid.viscosity;
  const char *to = more ? ">=" : "<=";
  const double factor = wanted / scene->fluid.viscosity;
  printf("fluid.viscosity %s %.3g", to, wanted);
  if (scene->units.dx > 0)
    printf(", by units.dt %s %.3g s or units.dx %s %.3g m", to, scene->units.dt * factor,
           more ? "<=" : ">=", scene->units.dx / sqrt(factor));
  printf("\n");
}

static void print_fluid(const struct scene *scene)
{
  static const char *const collisions[] = {"bgk", "trt", "mrt", "adaptive"};
  const struct rates *rates = &scene->fluid.rates;
  const double tau = 1 / rates->nu;
  printf("fluid        viscosity %g, tau %.6g; %s with s_nu %.6g, s_e %.6g, s_q %.6g (magic %.4g)",
         scene->fluid.viscosity, tau, collisions[scene->fluid.collision], rates->nu, rates->e, rates->q,
         (1 / rates->q - 0.5) * (tau - 0.5));
  if (rates->q_fast > 0)
    printf(" where |u| is far below %g cells/step, %g far above", scene->fluid.viscosity, rates->q_fast);
  printf("\n");
  if (scene->fluid.zero_flux)
    printf("zero flux    on: a uniform force cancels the mean momentum%s%s\n", scene_is_closed(scene, 0) ? " in x" : "",
           scene_is_closed(scene, 1) ? " in y" : "");
  if (tau > 1.5) {
    printf("  note: tau above 1.5; walls and discs lose accuracy; better: ");
    advise_viscosity(scene, (1.5 - 0.5) / 3);
  }
  if (tau < least_tau) {
    printf("  note: tau below %g, close to 1/2: hardly any damping of what goes wrong, and no collision operator is "
           "reliable above Mach 0.2 (bench/README.md, stability); better: ",
           least_tau);
    advise_viscosity(scene, (least_tau - 0.5) / 3);
  }
}

/* Speed at which a disc settles alone in unbounded fluid, from its weight and the drag of a cylinder: C_D = 8 pi/(Re
 * ln(7.4/Re)) (Lamb) at small Re, and the fit 1 + 10 Re^(-2/3) of measured drag beyond Re = 1. Within a factor of two;
 * for orientation. */
static double settling_speed(double radius, double viscosity, double weight)
{
  double low = 0, high = 10;
  for (int k = 0; k < 100; k++) {
    const double u = (low + high) / 2, re = 2 * u * radius / viscosity;
    const double cd = re < 1 ? 8 * M_PI / (re * log(7.4 / re)) : 1 + 10 * pow(re, -2.0 / 3);
    if (cd * u * u * radius < weight)
      low = u;
    else
      high = u;
  }
  return low;
}

static void print_speeds(const struct scene *scene)
{
  double speed = 0, length = 0;
  const char *from = NULL;
  const double gravity = hypot(scene->particles.gravity[0], scene->particles.gravity[1]);
  for (int k = 0; k < SIDE_COUNT; k++) {
    const double u = hypot(scene->domain.side[k].velocity[0], scene->domain.side[k].velocity[1]);
    if (u > speed) speed = u, from = "the sides";
  }
  for (size_t i = 0; i < scene->particles.count; i++) {
    const struct disc_spec *disc = &scene->particles.discs[i];
    const double weight = M_PI * disc->radius * disc->radius * fabs(disc->density - 1) * gravity;
    double u = hypot(disc->velocity[0], disc->velocity[1]) + fabs(disc->spin) * disc->radius;
    if (disc->motion == DISC_FREE && weight > 0)
      u = fmax(u, settling_speed(disc->radius, scene->fluid.viscosity, weight));
    if (u > speed) speed = u, from = "the discs";
    length = fmax(length, 2 * disc->radius);
  }
  const double force = hypot(scene->fluid.force[0], scene->fluid.force[1]);
  if (force > 0)
    printf("force        %g per unit mass: a free acceleration; speeds follow from what resists it\n", force);
  if (!from) {
    printf("speed        none is given by the case: no Reynolds number\n");
    return;
  }
  if (length == 0) length = fmin(scene->domain.size[0], scene->domain.size[1]);
  printf("speed        about %.3g cells a step (%s): Mach %.3g, Reynolds number %.3g over %g cells\n", speed, from,
         speed * sqrt(3), speed * length / scene->fluid.viscosity, length);
  if (speed * sqrt(3) > most_mach) {
    printf("  note: Mach above %g; errors grow with its square; better: speeds <= %.3g", most_mach,
           most_mach / sqrt(3));
    if (scene->units.dx > 0) printf(", by units.dt <= %.3g s", scene->units.dt * most_mach / (speed * sqrt(3)));
    printf("\n");
  }
  const double grid_reynolds = speed / scene->fluid.viscosity;
  if (grid_reynolds > most_grid_reynolds) {
    printf("  note: grid Reynolds number (of one cell) %.3g, above %g: cells too coarse for the flow, which may become "
           "unstable; better: fluid.viscosity >= %.3g",
           grid_reynolds, most_grid_reynolds, speed / most_grid_reynolds);
    if (scene->units.dx > 0) printf(", by units.dx <= %.3g m", scene->units.dx * most_grid_reynolds / grid_reynolds);
    printf("\n");
  }
}

static void print_discs(const struct scene *scene)
{
  static const char *const forms[] = {"unified (17)-(18)", "owen (12)-(13)", "midpoint"};
  double smallest = INFINITY, largest = 0, area = 0;
  size_t motions[3] = {0};
  for (size_t i = 0; i < scene->particles.count; i++) {
    const struct disc_spec *disc = &scene->particles.discs[i];
    smallest = fmin(smallest, disc->radius);
    largest = fmax(largest, disc->radius);
    area += M_PI * disc->radius * disc->radius;
    motions[disc->motion]++;
  }
  const double box = (double)scene->domain.size[0] * scene->domain.size[1];
  printf("discs        %zu (%zu free, %zu fixed, %zu driven), radius %g to %g, solid fraction %.4g\n",
         scene->particles.count, motions[DISC_FREE], motions[DISC_FIXED], motions[DISC_DRIVEN], smallest, largest,
         area / box);
  if (smallest < 2) printf("  note: radius below 2 cells; forces on so small a disc are rough\n");
  printf("coupling     %s, %s\n", forms[scene->coupling.form],
         scene->coupling.solve == SOLVE_IMPLICIT ? "implicit" : "explicit-averaged");
}

static void print_contacts(const struct scene *scene, const struct plan *plan)
{
  if (!plan->pairs && !plan->walls) return;
  printf("contacts     area by %s, stiffness %g, alpha %g, damping %g (%s)\n",
         scene->contact.area == AREA_LENS ? "lens" : "cells", scene->contact.stiffness, scene->contact.alpha,
         scene->contact.damping, scene->contact.damping_form == DAMPING_CRITICAL ? "critical" : "as printed");
  if (scene->contact.substeps > 0)
    printf("sub-steps    %d a step, as the case says\n", scene->contact.substeps);
  else if (plan->substeps)
    printf("sub-steps    chosen each step for %g of them a contact; %d at an overlap of one cell\n",
           scene->contact.steps_per_contact, plan_largest_substeps(scene));
  else
    printf("sub-steps    1: a contact lasts more than %g steps\n", scene->contact.steps_per_contact);
}

static void print_plan(const struct scene *scene)
{
  if (!blocked_possible(scene))
    printf("blocking     off: zero_flux sums over the box each step\n");
  else if (scene->particles.count > 0)
    printf("blocking     in time, %d steps deep, of rows that no disc can reach\n",
           scene->run.plan.depth > 0 ? scene->run.plan.depth : BLOCKED_AHEAD);
  else if (scene->run.plan.depth == 0)
    printf("blocking     in time, depth by trial in the first steps (run.json has it); fix it by --plan\n");
  else
    printf("blocking     in time, %d steps deep, tiles of %d cells (0: whole rows)\n", scene->run.plan.depth,
           scene->run.plan.width);
}

static void print_memory(const struct scene *scene)
{
  const struct footprint footprint = footprint_of(scene);
  const double mib = 1 << 20, most = memory_physical();
  printf("memory       fluid %.4g MiB (%.1f bytes a cell)", footprint.fluid / mib,
         footprint.fluid / (double)scene_cells(scene));
  if (scene->particles.count > 0)
    printf(", discs %.4g MiB (%.0f bytes a disc)", footprint.discs / mib,
           footprint.discs / (double)scene->particles.count);
  if (footprint.contacts > 0) printf(", contacts %.4g MiB", footprint.contacts / mib);
  if (footprint.fields > 0) printf(", fields %.4g MiB", footprint.fields / mib);
  if (footprint.frames > 0) printf(", frames %.4g MiB", footprint.frames / mib);
  printf(", in all %.4g MiB\n", footprint_total(&footprint) / mib);
  if (footprint_total(&footprint) > most)
    printf("  note: more than the %.4g MiB of this machine; it would not be run here\n", most / mib);
}

static void print_stages(const struct scene *scene, const struct plan *plan)
{
  static const char *const occupation[] = {"left out: no discs", "once, before the first step: no disc moves",
                                           "every step"};
  printf("stages\n");
  printf("  occupation %s\n", occupation[plan->occupation]);
  printf("  exchange   %s\n", !plan->exchange                       ? "left out: no discs"
                              : plan->occupation == OCCUPATION_ONCE ? "gather only, for the forces: no disc is free"
                                                                    : "gather, solve, move");
  printf("  contact    %s\n", plan->pairs && plan->walls ? "pairs and sides"
                              : plan->pairs              ? "pairs; no sides: the box is periodic"
                              : plan->walls              ? "sides; no pairs: one disc"
                                                         : "left out: nothing can meet");
  printf("  boundary   %s\n", scene_is_periodic(scene, 0) && scene_is_periodic(scene, 1)
                                  ? "periodic images, every other step"
                                  : "every other step");
  printf("  sweep      every step, %s%s\n", plan->exchange ? "with discs in the rows that have any" : "fluid alone",
         plan->force ? ", with force" : ", no force");
}

static int print_case(const struct scene *scene, struct scene_errors *notes)
{
  struct status status;
  const struct plan plan = plan_of(scene);
  const struct sweep_kernel *kernel = sweep_find(scene->fluid.kernel, scene->fluid.precision, &status);
  if (!kernel) return report_error(&status);
  char title[TREE_TEXT]; /* whatever a case holds, a terminal is not to obey it */
  tree_show(scene->title, title);
  printf("case         %s%s%s\n", scene->name, *title ? ": " : "", title);
  print_box(scene);
  print_units(scene);
  notes_print(notes, "  note: ", stdout);
  print_fluid(scene);
  print_speeds(scene);
  if (plan.exchange) print_discs(scene);
  print_contacts(scene, &plan);
  print_advice(scene);
  char binding[THREADS_TEXT];
  threads_binding(binding);
  printf("run          %" PRId64 " steps, %d threads (%s), kernel %s\n", scene->run.steps,
         threads_for(scene_cells(scene)), binding, kernel->name);
  print_plan(scene);
  print_memory(scene);
  print_stages(scene, &plan);
  return DELBM_OK;
}

int command_info(int argc, char **argv)
{
  struct settings settings = {0};
  struct scene scene = {0};
  for (int option; (option = option_next(argc, argv, info_options)) != OPTION_END;) {
    const int code = option == OPTION_SET    ? settings_add(&settings, optarg, argc, argv)
                     : option == OPTION_HELP ? DELBM_OK
                                             : DELBM_USAGE;
    if (option == OPTION_SET && code == DELBM_OK) continue;
    if (option == OPTION_HELP) print_help();
    free(settings.items);
    return code;
  }
  struct scene_errors notes = {0};
  const char *path = option_operand(argc, argv, "CASE");
  int code = path ? case_read(&scene, path, &settings, &notes) : DELBM_USAGE;
  if (code == DELBM_OK) code = print_case(&scene, &notes);
  scene_errors_clear(&notes);
  scene_clear(&scene);
  free(settings.items);
  return code;
}
