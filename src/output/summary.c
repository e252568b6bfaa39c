#include "output/summary.h"

#include "base/memory.h"
#include "output/file.h"
#include "output/json.h"

#include <assert.h>
#include <inttypes.h>
#include <math.h>
#include <string.h>

enum figure_kind { FIGURE_TEXT, FIGURE_INTEGER, FIGURE_REAL };

/* One entry of the summary. A NULL text is left out. */
struct figure {
  const char *name;
  enum figure_kind kind;
  const char *group; /* object in run.json; NULL: the outermost */
  bool json_only;    /* not in the line: may contain spaces */
  const char *text;
  int64_t integer;
  double real;
};

enum { FIGURES_MAX = 30 + STAGE_COUNT };

struct figures {
  size_t count;
  struct figure items[FIGURES_MAX];
};

static const char *outcome_name(enum outcome outcome)
{
  static const char *const names[] = {"done", "diverged", "interrupted", "failed"};
  return names[outcome];
}

static struct figure *add(struct figures *figures, const char *name, enum figure_kind kind)
{
  assert(figures->count < FIGURES_MAX);
  struct figure *figure = &figures->items[figures->count++];
  *figure = (struct figure){.name = name, .kind = kind};
  return figure;
}

static struct figure *add_text(struct figures *figures, const char *name, const char *text)
{
  struct figure *figure = add(figures, name, FIGURE_TEXT);
  figure->text = text;
  return figure;
}

static void add_integer(struct figures *figures, const char *name, int64_t integer)
{
  add(figures, name, FIGURE_INTEGER)->integer = integer;
}

static struct figure *add_real(struct figures *figures, const char *name, double real)
{
  struct figure *figure = add(figures, name, FIGURE_REAL);
  figure->real = real;
  return figure;
}

/* Only units that are known. */
static void add_units(struct figures *figures, const struct units *units)
{
  const struct {
    const char *name;
    double value;
  } all[] = {{"dx_m", units->dx}, {"dt_s", units->dt}, {"density_kg_m3", units->density}};
  for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) {
    if (all[k].value == 0) continue;
    struct figure *figure = add_real(figures, all[k].name, all[k].value);
    figure->group = "units";
    figure->json_only = true;
  }
}

/* 0 without fluid. */
static double mlups(const struct summary *summary)
{
  const int *size = summary->scene->domain.size;
  double updates = (double)size[0] * size[1] * (double)summary->steps;
  return summary->seconds > 0 && !summary->scene->fluid.none ? updates / summary->seconds * 1e-6 : 0;
}

static struct figures figures_of(const struct summary *summary)
{
  const struct simulation_report *report = &summary->report;
  bool single = summary->scene->fluid.precision == PRECISION_SINGLE;
  struct figures figures = {0};
  add_text(&figures, "status", outcome_name(summary->outcome));
  add_text(&figures, "message", summary->message)->json_only = true;
  add_text(&figures, "reason", summary->reason)->json_only = true;
  add_text(&figures, "warning", summary->warning)->json_only = true;
  add_integer(&figures, "steps", summary->steps);
  add_real(&figures, "seconds", summary->seconds);
  add_real(&figures, "mlups", mlups(summary));
  add_integer(&figures, "threads", report->threads);
  add_text(&figures, "binding", report->binding)->json_only = true;
  add_text(&figures, "kernel", report->kernel);
  add_text(&figures, "plan", report->blocking);
  add_text(&figures, "precision", single ? "single" : "double");
  for (int stage = 0; stage < STAGE_COUNT; stage++)
    add_real(&figures, stage_name((enum stage)stage), report->times.seconds[stage])->group = "stages";
  add_real(&figures, "mass_drift", report->mass_drift);
  add_real(&figures, "momentum_drift", report->momentum_drift);
  add_real(&figures, "mean_ux", report->mean_velocity[0]);
  add_real(&figures, "mean_uy", report->mean_velocity[1]);
  add_real(&figures, "max_mach", report->max_mach);
  add_integer(&figures, "max_substeps", report->max_substeps);
  add_real(&figures, "max_overlap", report->max_overlap);
  add_real(&figures, "peak_rss_mib", memory_peak_mib());
  add_units(&figures, &summary->scene->units);
  add_text(&figures, "version", DELBM_VERSION)->json_only = true;
  add_text(&figures, "title", summary->scene->title)->json_only = true;
  return figures;
}

static void json_figure(const struct figure *figure, FILE *stream)
{
  fprintf(stream, "\"%s\": ", figure->name);
  if (figure->kind == FIGURE_TEXT)
    json_text(figure->text, stream);
  else if (figure->kind == FIGURE_INTEGER)
    fprintf(stream, "%" PRId64, figure->integer);
  else if (isfinite(figure->real))
    fprintf(stream, "%.17g", figure->real);
  else
    fputs("null", stream);
}

static bool is_absent(const struct figure *figure)
{
  return figure->kind == FIGURE_TEXT && !figure->text;
}

static void json_figures(const struct figures *figures, FILE *stream)
{
  const char *separator = "{\n", *group = NULL;
  for (const struct figure *figure = figures->items; figure < figures->items + figures->count; figure++) {
    if (is_absent(figure)) continue;
    const bool changes = figure->group != group && !(group && figure->group && strcmp(group, figure->group) == 0);
    if (changes && group) fputs("\n  }", stream);
    fputs(separator, stream);
    if (changes && figure->group) fprintf(stream, "  \"%s\": {\n", figure->group);
    group = figure->group;
    fputs(group ? "    " : "  ", stream);
    json_figure(figure, stream);
    separator = ",\n";
  }
  fputs("\n}\n", stream);
}

bool summary_write(const struct summary *summary, const char *path, struct status *status)
{
  struct figures figures = figures_of(summary);
  struct replacement file;
  if (!replacement_begin(&file, path, status)) return false;
  json_figures(&figures, file.stream);
  return replacement_commit(&file, status);
}

void summary_print(const struct summary *summary, FILE *stream)
{
  struct figures figures = figures_of(summary);
  fputs("delbm:", stream);
  for (const struct figure *figure = figures.items; figure < figures.items + figures.count; figure++) {
    if (figure->json_only || is_absent(figure)) continue;
    fprintf(stream, " %s=", figure->name);
    if (figure->kind == FIGURE_TEXT)
      fputs(figure->text, stream);
    else if (figure->kind == FIGURE_INTEGER)
      fprintf(stream, "%" PRId64, figure->integer);
    else if (isfinite(figure->real))
      fprintf(stream, "%.6g", figure->real);
    else
      fputc('-', stream);
  }
  fputc('\n', stream);
}
