#include "analysis/analysis.h"

#include "output/file.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* One figure of the report. */
struct figure {
  const char *part, *name;
  double value; /* NAN: left out */
  const char *unit, *meaning;
};

enum { FIGURES_MAX = 48 };

struct figures {
  size_t count;
  struct figure items[FIGURES_MAX];
};

static void add(struct figures *f, const char *part, const char *name, double value, const char *unit,
                const char *meaning)
{
  if (isfinite(value)) f->items[f->count++] = (struct figure){part, name, value, unit, meaning};
}

static void add_body(struct figures *f, const struct body *b)
{
  const bool prescribed = b->prescribed;
  if (isfinite(b->speed.mean)) {
    add(f, "body", "first_step", (double)b->first, "steps", "start of the window that means are taken over");
    add(f, "body", "last_step", (double)b->last, "steps", "end of this window");
  }
  add(f, "body", "speed", b->speed.mean, "cells/step",
      prescribed ? "U, of the fluid relative to the disc" : "terminal, U");
  if (!prescribed)
    add(f, "body", "speed_spread", b->speed.deviation, "cells/step", "standard deviation of the speed in the window");
  if (isfinite(b->fastest)) {
    add(f, "body", "fastest", b->fastest, "cells/step", "largest speed along gravity's axis");
    add(f, "body", "fastest_step", (double)b->fastest_step, "steps", "time of the largest speed");
  }
  add(f, "body", "reynolds", b->reynolds, "-", "2 U R/nu");
  add(f, "body", "drag", b->drag, "-", prescribed ? "C_D = F/(rho U^2 R)" : "C_D = pi R g (rho_s - rho)/(rho U^2)");
  add(f, "body", "drag_printed", b->drag_printed, "-", "8 R g (rho_s - rho)/(3 rho U^2), as the paper prints it");
  add(f, "body", "drag_spread", b->drag_spread, "-", "standard deviation of C_D");
  add(f, "body", "resistance", b->resistance, "-", "K = F/(rho nu U)");
  add(f, "body", "lift", b->lift.mean, "-", "C_L = F/(rho U^2 R)");
  add(f, "body", "lift_spread", b->lift.deviation, "-", "standard deviation of C_L");
  add(f, "body", "torque", b->torque.mean, "-", "C_M = T/(rho U^2 R^2)");
  add(f, "body", "spin", b->spin, "-", "omega R/U");
  add(f, "body", "strouhal", b->strouhal, "-", "2 f R/U of the shedding");
  add(f, "body", "swing", b->swing, "-", prescribed ? "amplitude of C_L" : "amplitude of the lateral velocity over U");
  add(f, "body", "swing_growth", b->growth, "-",
      "growth of the amplitude from the first to the last third; 1: shedding is developed");
}

static void add_pair(struct figures *f, const struct pair *p)
{
  add(f, "pair", "draft_time", p->draft_time, "steps", "trailing disc falls fastest before contact");
  add(f, "pair", "draft_speed", p->draft_speed, "cells/step", "velocity of the trailing disc at draft_time");
  add(f, "pair", "kiss_time", p->kiss_time, "steps", "first contact");
  add(f, "pair", "kiss_offset", p->offset, "cells", "between the centres across gravity at first contact");
  add(f, "pair", "even_time", p->even_time, "steps", "speeds equal within 2 %");
  add(f, "pair", "tumble_time", p->tumble_time, "steps", "trailing disc passes the leading one");
  add(f, "pair", "tumble_height", p->tumble_height, "cells", "height of the discs at tumble_time");
  add(f, "pair", "throw_time", p->throw_time, "steps", "leading disc fastest sideways");
  add(f, "pair", "throw_speed", p->throw_speed, "cells/step", "velocity of the leading disc at throw_time");
  add(f, "pair", "slow_time", p->slow_time, "steps", "leading disc slowest after throw_time");
  add(f, "pair", "slow_speed", p->slow_speed, "cells/step", "velocity of the leading disc at slow_time");
  add(f, "pair", "wall_time", p->wall_time, "steps", "leading disc nearest to a side wall");
  add(f, "pair", "wall_distance", p->wall_distance, "cells", "between the leading disc's centre and this wall");
}

static void add_settling(struct figures *f, const struct settling *s)
{
  const size_t last = s->snapshots - 1;
  add(f, "settling", "interface_speed", -s->fall.slope, "cells/step",
      "fall of the interface, from 10 to 70 % of its way");
  add(f, "settling", "interface_r2", s->fall.r2, "-", "R^2 of the linear fit of interface_speed");
  add(f, "settling", "front_speed", s->rise.slope, "cells/step", "rise of the sediment's surface in the same time");
  add(f, "settling", "front_r2", s->rise.r2, "-", "R^2 of the linear fit of front_speed");
  /* flux of discs through the front (Kynch): phi0 (u + s) = phi_bed s */
  add(f, "settling", "front_speed_kynch", -s->fall.slope * s->initial / (s->bed - s->initial), "cells/step",
      "of a jump from the initial concentration to the bed's");
  add(f, "settling", "front_width", s->sharpness, "cells",
      "height over which half of the change between these concentrations occurs");
  add(f, "settling", "concentration", s->initial, "-", "initial concentration");
  add(f, "settling", "bed", s->bed, "-", "concentration of the bed at the end");
  add(f, "settling", "interface_start", s->interface[0], "cells", "height of the interface at the start");
  add(f, "settling", "interface_end", s->interface[last], "cells", "height of the interface at the end");
  add(f, "settling", "mixing_start", s->mixing[0], "-", "Lacey's mixing index of five bands at the start");
  add(f, "settling", "mixing_end", s->mixing[last], "-", "Lacey's mixing index of five bands at the end");
  add(f, "settling", "lambda_bed_slope", s->lambda_bed.slope, "-",
      "mixing index (25) over height/box height in the sediment at the end");
  add(f, "settling", "lambda_bed_r2", s->lambda_bed.r2, "-", "R^2 of the linear fit of lambda_bed_slope");
  add(f, "settling", "lambda_above_slope", s->lambda_above.slope, "-",
      "mixing index (25) over height/box height above the sediment, at half of the interface's way");
  add(f, "settling", "fastest_end", s->restless, "cells/step", "fastest disc at the end");
}

static struct figures figures_of(const struct analysis *a)
{
  struct figures figures = {0};
  if (a->has_body) add_body(&figures, &a->body);
  if (a->has_pair) add_pair(&figures, &a->pair);
  if (a->has_settling) add_settling(&figures, &a->settling);
  return figures;
}

static bool analyse_parts(struct analysis *a, const double mean[2], struct status *status)
{
  const struct scene *scene = a->scene;
  bool ok = true;
  if (body_applies(scene)) {
    a->has_body = true;
    ok = body_analyse(&a->body, scene, mean, &a->history, status);
  }
  if (ok && pair_applies(scene)) {
    a->has_pair = true;
    a->pair = pair_analyse(scene, &a->history);
  }
  if (ok && settling_applies(scene)) a->has_settling = ok = settling_create(&a->settling, scene, &a->history, status);
  return ok;
}

bool analysis_create(struct analysis *a, const struct scene *scene, const char *directory, struct status *status)
{
  double mean[2];
  *a = (struct analysis){.scene = scene};
  char *table = file_join(directory, "particles.csv", status);
  const bool ok = table && history_read(&a->history, table, scene->particles.count, status) &&
                  ambient_read_mean(directory, mean, status) && analyse_parts(a, mean, status);
  free(table);
  if (!ok) analysis_destroy(a);
  return ok;
}

void analysis_destroy(struct analysis *a)
{
  if (a->has_settling) settling_destroy(&a->settling);
  history_clear(&a->history);
  *a = (struct analysis){0};
}

/* Warning to the reader of the settling figures; may be empty. */
static const char *settling_note(const struct settling *s)
{
  return s->settled ? "" : "no sediment: the interface still falls at the end of the run";
}

static void print_remarks(const struct analysis *a, FILE *stream)
{
  if (a->has_body) fprintf(stream, "# body: speed is relative to %s\n", ambient_name(a->body.relative));
  if (a->has_body && *a->body.note) fprintf(stream, "# body: %s\n", a->body.note);
  if (a->has_settling && *settling_note(&a->settling)) fprintf(stream, "# settling: %s\n", settling_note(&a->settling));
}

void analysis_print(const struct analysis *a, FILE *stream)
{
  const struct figures figures = figures_of(a);
  const struct history *h = &a->history;
  fprintf(stream, "# %zu discs, %zu snapshots, steps %" PRId64 " to %" PRId64 "\n", h->discs, h->snapshots, h->step[0],
          h->step[h->snapshots - 1]);
  print_remarks(a, stream);
  for (const struct figure *k = figures.items; k < figures.items + figures.count; k++) {
    char name[64];
    snprintf(name, sizeof name, "%s.%s", k->part, k->name);
    fprintf(stream, "%-27s %14.8g  %-10s  %s\n", name, k->value, k->unit, k->meaning);
  }
}

static void json_number(double value, FILE *stream)
{
  if (isfinite(value))
    fprintf(stream, "%.17g", value);
  else
    fputs("null", stream);
}

static void json_array(const char *name, const double *values, size_t count, FILE *stream)
{
  fprintf(stream, ",\n    \"%s\": [", name);
  for (size_t k = 0; k < count; k++) {
    if (k) fputs(", ", stream);
    json_number(values[k], stream);
  }
  fputs("]", stream);
}

static void json_series(const struct settling *s, FILE *stream)
{
  fputs(",\n    \"step\": [", stream);
  for (size_t n = 0; n < s->snapshots; n++) fprintf(stream, "%s%" PRId64, n ? ", " : "", s->step[n]);
  fputs("]", stream);
  json_array("interface", s->interface, s->snapshots, stream);
  json_array("front", s->front, s->snapshots, stream);
  json_array("mixing", s->mixing, s->snapshots, stream);
  json_array("layers", s->band[0], s->snapshots * SETTLING_BANDS, stream);
  json_array("profile", s->concentration + (s->snapshots - 1) * s->layers, s->layers, stream);
  json_array("lambda", s->lambda + (s->snapshots - 1) * s->layers, s->layers, stream);
}

/* Opens the object of a part and writes its figures. */
static void json_figures(const struct figures *figures, const char *part, bool first, const char *note, FILE *stream)
{
  bool starts = true;
  fprintf(stream, "%s\n  \"%s\": {", first ? "" : ",", part);
  for (const struct figure *k = figures->items; k < figures->items + figures->count; k++) {
    if (strcmp(k->part, part) != 0) continue;
    fprintf(stream, "%s\n    \"%s\": ", starts ? "" : ",", k->name);
    json_number(k->value, stream);
    starts = false;
  }
  fprintf(stream, "%s\n    \"note\": \"%s\"", starts ? "" : ",", note);
}

void analysis_json(const struct analysis *a, FILE *stream)
{
  const struct figures figures = figures_of(a);
  fputs("{", stream);
  if (a->has_body) {
    json_figures(&figures, "body", true, a->body.note, stream);
    fputs("\n  }", stream);
  }
  if (a->has_pair) {
    json_figures(&figures, "pair", !a->has_body, "", stream);
    fputs("\n  }", stream);
  }
  if (a->has_settling) {
    json_figures(&figures, "settling", !a->has_pair && !a->has_body, settling_note(&a->settling), stream);
    json_series(&a->settling, stream);
    fputs("\n  }", stream);
  }
  fputs("\n}\n", stream);
}

void analysis_settling_csv(const struct settling *s, FILE *stream)
{
  fputs("step,interface,front,mixing", stream);
  for (int k = 1; k <= SETTLING_BANDS; k++) fprintf(stream, ",layer%d", k);
  fputs("\n", stream);
  for (size_t n = 0; n < s->snapshots; n++) {
    fprintf(stream, "%" PRId64 ",%.17g,", s->step[n], s->interface[n]);
    if (!isnan(s->front[n])) fprintf(stream, "%.17g", s->front[n]);
    fprintf(stream, ",%.17g", s->mixing[n]);
    for (int k = 0; k < SETTLING_BANDS; k++) fprintf(stream, ",%.17g", s->band[n][k]);
    fputs("\n", stream);
  }
}

void analysis_profile_csv(const struct settling *s, FILE *stream)
{
  fputs("step,height,concentration,lambda\n", stream);
  for (size_t n = 0; n < s->snapshots; n++)
    for (size_t l = 0; l < s->layers; l++) {
      const double lambda = s->lambda[n * s->layers + l];
      fprintf(stream, "%" PRId64 ",%.17g,%.17g,", s->step[n], settling_height(s, l),
              s->concentration[n * s->layers + l]);
      if (!isnan(lambda)) fprintf(stream, "%.17g", lambda);
      fputs("\n", stream);
    }
}
