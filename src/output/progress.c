#include "output/progress.h"

#include "base/clock.h"

#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

static const double bar_interval = 0.1, line_interval = 10; /* seconds */

enum { LINE_MAX_LENGTH = 160, BAR_MAX = 30, BAR_MIN = 5 };

enum progress_style progress_style(FILE *stream)
{
  return isatty(fileno(stream)) ? PROGRESS_BAR : PROGRESS_LINES;
}

void progress_time(char text[PROGRESS_TIME], double seconds)
{
  if (!(seconds >= 0 && seconds < 1e9)) {
    snprintf(text, PROGRESS_TIME, "-");
    return;
  }
  long left = lround(seconds), days = left / 86400, hours = left / 3600 % 24, minutes = left / 60 % 60;
  if (days)
    snprintf(text, PROGRESS_TIME, "%ldd %02ld:%02ld:%02ld", days, hours, minutes, left % 60);
  else if (hours)
    snprintf(text, PROGRESS_TIME, "%ld:%02ld:%02ld", hours, minutes, left % 60);
  else
    snprintf(text, PROGRESS_TIME, "%ld:%02ld", minutes, left % 60);
}

static double fraction_done(const struct progress *progress, int64_t step)
{
  return progress->steps > 0 ? (double)step / (double)progress->steps : 1;
}

/* "42 %  4200/10000  512 MLUPS  0:12 left", with the time taken in place of the time left at the end; without cells
 * steps/s in place of MLUPS. */
static void format_figures(const struct progress *progress, int64_t step, double now, char text[LINE_MAX_LENGTH])
{
  double elapsed = now - progress->start;
  double rate = elapsed > 0 ? (double)(step - progress->first) / elapsed : 0, mlups = rate * progress->cells * 1e-6;
  bool ended = step >= progress->steps;
  char time[PROGRESS_TIME];
  const bool lattice = progress->cells > 0;
  const double speed = lattice ? mlups : rate;
  progress_time(time, ended ? elapsed : (double)(progress->steps - step) / rate);
  snprintf(text, LINE_MAX_LENGTH, "%3d %%  %" PRId64 "/%" PRId64 "  %.*f %s  %s %s",
           (int)(100 * fraction_done(progress, step)), step, progress->steps, speed < 100, speed,
           lattice ? "MLUPS" : "steps/s", time, ended ? "taken" : "left");
}

/* Cells of the bar that fit on the terminal beside `used` characters; 0 if fewer than BAR_MIN. */
static int bar_room(FILE *stream, size_t used)
{
  struct winsize window = {0};
  bool known = ioctl(fileno(stream), TIOCGWINSZ, &window) == 0 && window.ws_col > 0;
  int room = (known ? window.ws_col : 80) - (int)used - (int)sizeof "[]  ";
  return room < BAR_MIN ? 0 : room < BAR_MAX ? room : BAR_MAX;
}

static void show_bar(const struct progress *progress, int64_t step, const char *figures)
{
  static const char full[] = "==============================", empty[] = "                              ";
  int room = bar_room(progress->stream, strlen(figures));
  int done = (int)(room * fraction_done(progress, step));
  fputs("\r", progress->stream);
  if (room) fprintf(progress->stream, "[%.*s%.*s] ", done, full, room - done, empty);
  fprintf(progress->stream, "%s\033[K", figures);
  fflush(progress->stream);
}

static void show(struct progress *progress, int64_t step, double now)
{
  char figures[LINE_MAX_LENGTH];
  format_figures(progress, step, now, figures);
  if (progress->style == PROGRESS_BAR)
    show_bar(progress, step, figures);
  else
    fprintf(progress->stream, "delbm: %s\n", figures);
  progress->shown = now;
  progress->shown_step = step;
}

static int quarter(const struct progress *progress, int64_t step)
{
  return (int)(4 * fraction_done(progress, step));
}

void progress_start(struct progress *progress, enum progress_style style, FILE *stream, int64_t first, int64_t steps,
                    double cells)
{
  *progress = (struct progress){
      .style = style, .stream = stream, .first = first, .steps = steps, .cells = cells, .start = clock_now()};
  if (style != PROGRESS_NONE) show(progress, first, progress->start);
}

void progress_update(struct progress *progress, int64_t step)
{
  if (progress->style == PROGRESS_NONE) return;
  double now = clock_now(), since = now - progress->shown;
  bool due = progress->style == PROGRESS_BAR
                 ? since >= bar_interval
                 : since >= line_interval || quarter(progress, step) > quarter(progress, progress->shown_step);
  if (due) show(progress, step, now);
}

void progress_finish(struct progress *progress, int64_t step)
{
  if (progress->style == PROGRESS_NONE) return;
  if (progress->style == PROGRESS_BAR || step != progress->shown_step) show(progress, step, clock_now());
  if (progress->style == PROGRESS_BAR) fputc('\n', progress->stream);
}
