#include "analysis/settling.h"

#include "base/memory.h"
#include "solid/lens.h"

#include <gsl/gsl_sort.h>
#include <math.h>
#include <stdlib.h>

/* Data of the analysis in progress. */
struct work {
  const struct scene *scene;
  const struct history *history;
  struct settling *to;
  double radius;   /* mean */
  size_t *order;   /* discs by initial height, from the lowest */
  unsigned *band;  /* of each disc */
  double *zeta;    /* of each disc */
  unsigned *count; /* [layers] scratch */
  double *scratch; /* [discs] */
  size_t squares[2];
  unsigned (*band_count)[SETTLING_BANDS]; /* [squares] discs of each band */
};

bool settling_applies(const struct scene *scene)
{
  size_t free_discs = 0;
  for (size_t i = 0; i < scene->particles.count; i++) free_discs += scene->particles.discs[i].motion == DISC_FREE;
  return free_discs == scene->particles.count && free_discs >= SETTLING_MIN && scene->particles.gravity[1] < 0 &&
         scene->particles.gravity[0] == 0;
}

static double interface_of(const struct work *w, size_t snapshot)
{
  const size_t discs = w->history->discs, highest = (size_t)lround(sqrt((double)discs));
  for (size_t i = 0; i < discs; i++) w->scratch[i] = history_at(w->history, snapshot, i, HISTORY_Y);
  gsl_sort(w->scratch, 1, discs);
  return fit_spread(w->scratch + discs - highest, highest).mean;
}

/* Area of a disc below the height `level`: a circular segment. */
static double area_below(double radius, double y, double level)
{
  return lens_of_wall(radius, y - level).area;
}

/* Area of a layer of the box: the highest one is cut off. */
static double layer_area(const struct work *w, size_t layer)
{
  return fmin(w->to->layer, w->to->box - (double)layer * w->to->layer) * w->scene->domain.size[0];
}

/* Layer of a disc's centre. */
static size_t layer_of(const struct work *w, size_t snapshot, size_t disc)
{
  const double place = history_at(w->history, snapshot, disc, HISTORY_Y) / w->to->layer;
  return (size_t)fmin(fmax(place, 0), (double)(w->to->layers - 1));
}

static void add_concentration(const struct work *w, size_t snapshot)
{
  const struct settling *s = w->to;
  double *row = s->concentration + snapshot * s->layers;
  for (size_t i = 0; i < w->history->discs; i++) {
    const double r = w->scene->particles.discs[i].radius, y = history_at(w->history, snapshot, i, HISTORY_Y);
    const double first = fmax(0, floor((y - r) / s->layer));
    double below = area_below(r, y, first * s->layer);
    for (size_t k = (size_t)first; k < s->layers && (double)k * s->layer < y + r; k++) {
      const double next = area_below(r, y, (double)(k + 1) * s->layer);
      row[k] += (next - below) / layer_area(w, k);
      below = next;
    }
  }
}

/* zeta = l_0/N_l of each disc, l counted from 1. */
static void assign_zeta(struct work *w)
{
  for (size_t i = 0; i < w->history->discs; i++) w->zeta[i] = (double)(layer_of(w, 0, i) + 1) / (double)w->to->layers;
}

static void add_lambda(const struct work *w, size_t snapshot)
{
  const size_t layers = w->to->layers;
  double *row = w->to->lambda + snapshot * layers;
  for (size_t l = 0; l < layers; l++) w->count[l] = 0;
  for (size_t i = 0; i < w->history->discs; i++) {
    const size_t l = layer_of(w, snapshot, i);
    row[l] += w->zeta[i];
    w->count[l]++;
  }
  for (size_t l = 0; l < layers; l++) row[l] = w->count[l] > 0 ? row[l] / w->count[l] : NAN;
}

static void add_bands(const struct work *w, size_t snapshot)
{
  unsigned count[SETTLING_BANDS] = {0};
  double *mean = w->to->band[snapshot];
  for (size_t i = 0; i < w->history->discs; i++) {
    mean[w->band[i]] += history_at(w->history, snapshot, i, HISTORY_Y);
    count[w->band[i]]++;
  }
  for (int k = 0; k < SETTLING_BANDS; k++) mean[k] /= count[k];
}

static size_t square_of(const struct work *w, size_t snapshot, size_t disc)
{
  const double edge = 10 * w->radius;
  const double x = history_at(w->history, snapshot, disc, HISTORY_X) / edge;
  const double y = history_at(w->history, snapshot, disc, HISTORY_Y) / edge;
  const size_t i = (size_t)fmin(fmax(x, 0), (double)(w->squares[0] - 1));
  const size_t j = (size_t)fmin(fmax(y, 0), (double)(w->squares[1] - 1));
  return j * w->squares[0] + i;
}

static double mixing_of(const struct work *w, size_t snapshot)
{
  const size_t squares = w->squares[0] * w->squares[1];
  const double discs = (double)w->history->discs, p = 1.0 / SETTLING_BANDS;
  double variance = 0, filled = 0;
  for (size_t q = 0; q < squares; q++)
    for (int k = 0; k < SETTLING_BANDS; k++) w->band_count[q][k] = 0;
  for (size_t i = 0; i < w->history->discs; i++) w->band_count[square_of(w, snapshot, i)][w->band[i]]++;
  for (size_t q = 0; q < squares; q++) {
    unsigned all = 0;
    for (int k = 0; k < SETTLING_BANDS; k++) all += w->band_count[q][k];
    if (all == 0) continue;
    filled++;
    for (int k = 0; k < SETTLING_BANDS; k++)
      variance += all / discs * (w->band_count[q][k] / (double)all - p) * (w->band_count[q][k] / (double)all - p) /
                  SETTLING_BANDS;
  }
  /* a random square of n_q discs has variance p (1 - p)/n_q and weight n_q/N: in all p (1 - p) filled/N */
  const double apart = p * (1 - p), chance = apart * filled / discs;
  return chance < apart ? (apart - variance) / (apart - chance) : 1;
}

/* Height at which a profile first reaches `level`, searched from the interface downwards. */
static double height_of(const struct settling *s, size_t snapshot, double level)
{
  const double *row = s->concentration + snapshot * s->layers;
  size_t k = (size_t)fmin(s->interface[snapshot] / s->layer, (double)(s->layers - 1));
  while (k > 0 && row[k] < level) k--;
  if (row[k] < level) return 0;
  if (k + 1 >= s->layers) return s->box;
  const double share = row[k] > row[k + 1] ? (row[k] - level) / (row[k] - row[k + 1]) : 0;
  return settling_height(s, k) + fmin(fmax(share, 0), 1) * s->layer;
}

static double bed_of(const struct settling *s)
{
  const double *row = s->concentration + (s->snapshots - 1) * s->layers;
  const double top = s->interface[s->snapshots - 1] / s->layer;
  const size_t first = (size_t)(0.25 * top), end = (size_t)fmax(ceil(0.75 * top), (double)(first + 1));
  return fit_spread(row + first, end - first).mean;
}

static bool is_fitted(const struct settling *s, size_t snapshot)
{
  const double whole = s->interface[0] - s->interface[s->snapshots - 1];
  const double fallen = s->interface[0] - s->interface[snapshot];
  return whole > 0 && fallen >= 0.1 * whole && fallen <= 0.7 * whole;
}

/* The line through the interface, and whether it has come to rest. `columns` has room for two numbers a snapshot. */
static void fit_interface(struct settling *s, double *columns)
{
  double *step = columns, *height = columns + s->snapshots;
  const size_t last = s->snapshots - 1, tenth = s->snapshots > 20 ? s->snapshots / 10 : 2;
  size_t count = 0;
  for (size_t n = 0; n < s->snapshots; n++) {
    if (!is_fitted(s, n)) continue;
    step[count] = (double)s->step[n];
    height[count++] = s->interface[n];
  }
  s->fall = fit_line(step, height, count);
  for (size_t n = 0; n < s->snapshots; n++) step[n] = (double)s->step[n];
  const size_t from = s->snapshots > tenth ? s->snapshots - tenth : 0;
  const double end = -fit_line(step + from, s->interface + from, s->snapshots - from).slope;
  const double mean = (s->interface[0] - s->interface[last]) / (step[last] - step[0]);
  s->settled = !(end > settling_rest * (isnan(s->fall.slope) ? mean : -s->fall.slope));
}

/* The surface of the sediment and the line through it. */
static void fit_front(struct settling *s, double *columns)
{
  double *step = columns, *rise = columns + s->snapshots, width = 0;
  const double between = s->bed - s->initial;
  size_t count = 0;
  for (size_t n = 0; n < s->snapshots; n++) {
    s->front[n] = height_of(s, n, s->initial + 0.5 * between);
    if (!is_fitted(s, n)) continue;
    step[count] = (double)s->step[n];
    rise[count++] = s->front[n];
    width += height_of(s, n, s->initial + 0.25 * between) - height_of(s, n, s->initial + 0.75 * between);
  }
  s->rise = fit_line(step, rise, count);
  s->sharpness = count ? width / (double)count : NAN;
}

/* The lines through the interface and, once the bed is at rest, through the surface of the sediment. */
static bool fit_fronts(struct settling *s, struct status *status)
{
  double *columns = memory_allocate(2 * s->snapshots, sizeof *columns, "the fits", status);
  if (!columns) return false;
  fit_interface(s, columns);
  s->bed = s->sharpness = NAN;
  s->rise = (struct line){NAN, NAN, NAN};
  for (size_t n = 0; n < s->snapshots; n++) s->front[n] = NAN;
  if (s->settled) {
    s->bed = bed_of(s);
    fit_front(s, columns);
  }
  free(columns);
  return true;
}

/* Line through Lambda over height/box height, of the layers with middles between two heights. */
static struct line lambda_line(const struct settling *s, size_t snapshot, double low, double high, double *columns)
{
  double *height = columns, *lambda = columns + s->layers;
  size_t count = 0;
  for (size_t l = 0; l < s->layers; l++) {
    const double middle = settling_height(s, l), value = s->lambda[snapshot * s->layers + l];
    if (isnan(value) || middle < low || middle > high) continue;
    height[count] = middle / s->box;
    lambda[count++] = value;
  }
  return fit_line(height, lambda, count);
}

/* The lines through Lambda in the final sediment, and above the sediment when the interface has fallen half of its
 * way. */
static bool fit_lambda(struct settling *s, struct status *status)
{
  s->lambda_bed = s->lambda_above = (struct line){NAN, NAN, NAN};
  if (!s->settled) return true;
  double *columns = memory_allocate(2 * s->layers, sizeof *columns, "the fits", status);
  if (!columns) return false;
  const size_t last = s->snapshots - 1;
  const double half = 0.5 * (s->interface[0] + s->interface[last]);
  size_t n = 0;
  while (n < last && s->interface[n] > half) n++;
  s->lambda_bed = lambda_line(s, last, 0, s->interface[last], columns);
  s->lambda_above = lambda_line(s, n, s->front[n], s->interface[n], columns);
  free(columns);
  return true;
}

static double fastest(const struct history *h)
{
  double max = 0;
  for (size_t i = 0; i < h->discs; i++)
    max = fmax(max,
               hypot(history_at(h, h->snapshots - 1, i, HISTORY_VX), history_at(h, h->snapshots - 1, i, HISTORY_VY)));
  return max;
}

/* Sorts the discs into bands by their height at the first snapshot. */
static void assign_bands(struct work *w)
{
  const size_t discs = w->history->discs;
  for (size_t i = 0; i < discs; i++) w->scratch[i] = history_at(w->history, 0, i, HISTORY_Y);
  gsl_sort_index(w->order, w->scratch, 1, discs);
  for (size_t k = 0; k < discs; k++) w->band[w->order[k]] = (unsigned)(k * SETTLING_BANDS / discs);
}

static double initial_of(const struct scene *scene)
{
  double area = 0;
  for (size_t i = 0; i < scene->particles.count; i++) area += disc_spec_area(&scene->particles.discs[i]);
  const double *region = scene->particles.fill.region;
  const bool filled = scene->particles.fill.present && scene->particles.listed == 0;
  return area / (filled ? (region[2] - region[0]) * (region[3] - region[1]) : (double)scene_cells(scene));
}

static bool allocate(struct work *w, struct status *status)
{
  struct settling *s = w->to;
  const size_t n = s->snapshots, discs = w->history->discs;
  return (s->interface = memory_allocate(n, sizeof *s->interface, "the interface", status)) &&
         (s->front = memory_allocate(n, sizeof *s->front, "the sediment's surface", status)) &&
         (s->mixing = memory_allocate(n, sizeof *s->mixing, "the mixing", status)) &&
         (s->band = memory_allocate(n, sizeof *s->band, "the bands", status)) &&
         (s->concentration = memory_allocate(n * s->layers, sizeof(double), "the profiles", status)) &&
         (s->lambda = memory_allocate(n * s->layers, sizeof(double), "the profiles", status)) &&
         (w->order = memory_allocate(discs, sizeof *w->order, "the bands", status)) &&
         (w->band = memory_allocate(discs, sizeof *w->band, "the bands", status)) &&
         (w->zeta = memory_allocate(discs, sizeof *w->zeta, "the layers", status)) &&
         (w->count = memory_allocate(s->layers, sizeof *w->count, "the layers", status)) &&
         (w->scratch = memory_allocate(discs, sizeof *w->scratch, "the heights", status)) &&
         (w->band_count = memory_allocate(w->squares[0] * w->squares[1], sizeof *w->band_count, "the mixing", status));
}

bool settling_create(struct settling *s, const struct scene *scene, const struct history *history,
                     struct status *status)
{
  *s = (struct settling){.snapshots = history->snapshots, .step = history->step, .initial = initial_of(scene)};
  struct work w = {.scene = scene, .history = history, .to = s, .radius = scene_mean_radius(scene)};
  s->layer = 4 * w.radius;
  s->box = scene->domain.size[1];
  s->layers = (size_t)ceil(s->box / s->layer);
  for (int axis = 0; axis < 2; axis++) w.squares[axis] = (size_t)ceil(scene->domain.size[axis] / (10 * w.radius));
  bool ok = allocate(&w, status);
  if (ok) {
    assign_bands(&w);
    assign_zeta(&w);
  }
  for (size_t n = 0; ok && n < s->snapshots; n++) {
    s->interface[n] = interface_of(&w, n);
    s->mixing[n] = mixing_of(&w, n);
    add_bands(&w, n);
    add_concentration(&w, n);
    add_lambda(&w, n);
  }
  if (ok) {
    s->restless = fastest(history);
    ok = fit_fronts(s, status) && fit_lambda(s, status);
  }
  free(w.order);
  free(w.band);
  free(w.zeta);
  free(w.count);
  free(w.scratch);
  free(w.band_count);
  if (!ok) settling_destroy(s);
  return ok;
}

void settling_destroy(struct settling *s)
{
  free(s->interface);
  free(s->front);
  free(s->mixing);
  free(s->band);
  free(s->concentration);
  free(s->lambda);
  *s = (struct settling){0};
}
