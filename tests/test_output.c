/* Results of a run: particles.csv, pictures, run.json, its line on stdout, and their folder. */
#include "output/csv.h"
#include "output/file.h"
#include "output/picture.h"
#include "output/progress.h"
#include "output/recorder.h"
#include "output/summary.h"
#include "scenes.h"

#include <criterion/criterion.h>
#include <ftw.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { DISCS = 2 };

static char scratch[] = "/tmp/delbm-test-XXXXXX";
static struct status status;

static void make_scratch(void)
{
  cr_assert_not_null(mkdtemp(scratch));
}

static int remove_entry(const char *path, const struct stat *info, int type, struct FTW *walk)
{
  (void)info;
  (void)type;
  (void)walk;
  return remove(path);
}

static void remove_scratch(void)
{
  nftw(scratch, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}

TestSuite(csv, .init = make_scratch, .fini = remove_scratch);
TestSuite(summary, .init = make_scratch, .fini = remove_scratch);
TestSuite(picture, .init = make_scratch, .fini = remove_scratch);
TestSuite(recorder, .init = make_scratch, .fini = remove_scratch);

static char *in_scratch(const char *name)
{
  char *path = file_join(scratch, name, &status);
  cr_assert_not_null(path);
  return path;
}

/* All of a file, ended by a zero. */
static char *contents(const char *path, size_t *length)
{
  FILE *file = fopen(path, "rb");
  cr_assert_not_null(file, "%s is there", path);
  char *text = calloc(1, 1 << 24);
  *length = fread(text, 1, (1 << 24) - 1, file);
  fclose(file);
  return text;
}

static void write_file(const char *path, const char *text)
{
  FILE *file = fopen(path, "wb");
  cr_assert_not_null(file);
  fputs(text, file);
  fclose(file);
}

/* Quantities of DISCS discs, all 0 but the radius of 10, in the order of the columns of particles.csv. */
struct some_discs {
  double columns[12][DISCS];
  double radius[DISCS];
  struct discs discs;
};

static struct discs *some_discs(struct some_discs *some)
{
  memset(some, 0, sizeof *some);
  for (int k = 0; k < DISCS; k++) some->radius[k] = 10;
  some->discs.count = DISCS;
  some->discs.radius = some->radius;
  double **arrays[] = {&some->discs.x,          &some->discs.y,          &some->discs.vx,
                       &some->discs.vy,         &some->discs.omega,      &some->discs.angle,
                       &some->discs.fx,         &some->discs.fy,         &some->discs.torque,
                       &some->discs.contact_fx, &some->discs.contact_fy, &some->discs.contact_torque};
  for (int k = 0; k < 12; k++) *arrays[k] = some->columns[k];
  return &some->discs;
}

Test(csv, starts_with_the_header_that_scripts_rely_on)
{
  struct table *csv;
  size_t length;
  char *path = in_scratch("particles.csv");
  cr_assert(table_open(&csv, path, &csv_layout, &(struct units){0}, &status), "%s", status.message);
  cr_assert(table_close(&csv, &status));
  cr_assert_null(csv);
  cr_assert_str_eq(contents(path, &length),
                   "step,id,x,y,vx,vy,omega,angle,fx,fy,torque,contact_fx,contact_fy,contact_torque\n");
}

Test(csv, numbers_read_back_as_they_were)
{
  struct some_discs some;
  struct discs *discs = some_discs(&some);
  const double awkward[] = {0.1,
                            -1. / 3,
                            2.2250738585072014e-308,
                            -1.7976931348623157e308,
                            4.9406564584124654e-324,
                            0,
                            -0.,
                            1e22,
                            123456789.123456789,
                            -5e-324,
                            1,
                            M_PI};
  for (int k = 0; k < 12; k++) some.columns[k][1] = awkward[k];
  struct table *csv;
  char *path = in_scratch("particles.csv");
  cr_assert(table_open(&csv, path, &csv_layout, &(struct units){0}, &status));
  cr_assert(csv_write(csv, INT64_MAX, discs, &status), "%s", status.message);
  cr_assert(table_close(&csv, &status));
  size_t length;
  char *row = strstr(contents(path, &length), "\n9223372036854775807,1,");
  cr_assert_not_null(row);
  row = strchr(row, ',') + 2;
  for (int k = 0; k < 12; k++) {
    cr_assert_eq(*row, ',');
    double back = strtod(row + 1, &row);
    cr_assert(memcmp(&back, &awkward[k], sizeof back) == 0, "column %d: %.17g is not %.17g", k, back, awkward[k]);
  }
  cr_assert_str_eq(row, "\n");
}

/* With a cell of 2 m, a step of 0.5 s and a fluid of 3 kg/m^3 two scales are equal only for equal units. */
Test(csv, every_column_has_one_in_si_with_its_unit_and_scale)
{
  static const struct {
    const char *name;
    int column; /* of the lattice value, from 0 for x; -1: time */
    double scale;
  } si[] = {{"t[s]", -1, 0.5},
            {"x[m]", 0, 2},
            {"y[m]", 1, 2},
            {"vx[m/s]", 2, 4},
            {"vy[m/s]", 3, 4},
            {"omega[1/s]", 4, 2},
            {"fx[kg/s^2]", 6, 96},
            {"fy[kg/s^2]", 7, 96},
            {"torque[kg*m/s^2]", 8, 192},
            {"contact_fx[kg/s^2]", 9, 96},
            {"contact_fy[kg/s^2]", 10, 96},
            {"contact_torque[kg*m/s^2]", 11, 192}};
  enum { COUNT = sizeof si / sizeof si[0] };
  const struct units units = {2, 0.5, 3};
  struct some_discs some;
  struct discs *discs = some_discs(&some);
  for (int k = 0; k < 12; k++) some.columns[k][0] = 10 + k;
  struct table *csv;
  size_t length;
  char *path = in_scratch("particles.csv");
  cr_assert(table_open(&csv, path, &csv_layout, &units, &status));
  cr_assert(csv_write(csv, 7, discs, &status));
  table_close(&csv, &status);
  char *header = strstr(contents(path, &length), "contact_torque,") + strlen("contact_torque");
  char *row = strchr(header, '\n') + 1;
  for (int k = 0; k < 14; k++) row = strchr(row, ',') + 1;
  row--; /* at the comma before the first in SI */
  for (int k = 0; k < COUNT; k++) {
    cr_assert_eq(strncmp(header + 1, si[k].name, strlen(si[k].name)), 0, "%s: %.40s", si[k].name, header);
    header += 1 + strlen(si[k].name);
    const double value = si[k].column < 0 ? 7 : 10 + si[k].column;
    cr_assert_eq(*row, ',');
    cr_expect_eq(strtod(row + 1, &row), value * si[k].scale, "%s", si[k].name);
  }
  cr_expect(*header == '\n' && *row == '\n');
}

Test(csv, without_a_density_of_the_fluid_has_no_forces_in_si)
{
  struct table *csv;
  size_t length;
  char *path = in_scratch("particles.csv");
  cr_assert(table_open(&csv, path, &csv_layout, &(struct units){2, 0.5, 0}, &status));
  table_close(&csv, &status);
  cr_expect_str_eq(strstr(contents(path, &length), "contact_torque,"),
                   "contact_torque,t[s],x[m],y[m],vx[m/s],vy[m/s],omega[1/s]\n");
}

Test(csv, what_was_written_is_in_the_file_before_it_is_closed)
{
  struct some_discs some;
  struct table *csv;
  size_t length;
  char *path = in_scratch("particles.csv");
  cr_assert(table_open(&csv, path, &csv_layout, &(struct units){0}, &status));
  cr_assert(csv_write(csv, 3, some_discs(&some), &status));
  cr_assert_str_eq(strchr(contents(path, &length), '\n'),
                   "\n3,0,0,0,0,0,0,0,0,0,0,0,0,0\n3,1,0,0,0,0,0,0,0,0,0,0,0,0\n");
  table_close(&csv, &status);
}

Test(csv, a_number_that_is_not_finite_is_refused_with_its_whole_snapshot)
{
  struct some_discs some;
  struct discs *discs = some_discs(&some);
  discs->omega[1] = NAN;
  struct table *csv;
  size_t length;
  char *path = in_scratch("particles.csv");
  cr_assert(table_open(&csv, path, &csv_layout, &(struct units){0}, &status));
  cr_assert_not(csv_write(csv, 7, discs, &status));
  cr_assert_eq(status.code, DELBM_FAILED);
  cr_assert_str_eq(status.message, "step 7, disc 1: omega is nan");
  discs->omega[1] = 0;
  cr_assert(csv_write(csv, 8, discs, &status));
  table_close(&csv, &status);
  cr_assert_eq(strncmp(strchr(contents(path, &length), '\n'), "\n8,0,", 5), 0);
}

Test(csv, an_unwritable_place_is_an_input_output_error)
{
  struct table *csv;
  write_file(in_scratch("file"), "");
  cr_assert_not(table_open(&csv, in_scratch("file/particles.csv"), &csv_layout, &(struct units){0}, &status));
  cr_assert_eq(status.code, DELBM_IO);
  cr_assert_not_null(strstr(status.message, "file/particles.csv: Not a directory"), "%s", status.message);
  cr_assert_null(csv);
}

Test(csv, a_full_disk_is_an_input_output_error)
{
  struct table *csv;
  cr_assert_not(table_open(&csv, "/dev/full", &csv_layout, &(struct units){0}, &status));
  cr_assert_eq(status.code, DELBM_IO);
  cr_assert_not_null(strstr(status.message, "/dev/full: No space left on device"), "%s", status.message);
}

static struct scene some_scene(void)
{
  struct scene scene = {.title = "Title", .name = "name"};
  scene.domain.size[0] = 20;
  scene.domain.size[1] = 10;
  scene.run.steps = 100;
  return scene;
}

static struct summary some_summary(const struct scene *scene)
{
  return (struct summary){.scene = scene,
                          .steps = 50,
                          .seconds = 2,
                          .report = {.threads = 3,
                                     .kernel = "plain",
                                     .blocking = "16",
                                     .binding = "unbound",
                                     .mass_drift = 0.5,
                                     .momentum_drift = NAN}};
}

static char *run_json(const struct summary *summary)
{
  size_t length;
  char *path = in_scratch("run.json");
  cr_assert(summary_write(summary, path, &status), "%s", status.message);
  return contents(path, &length);
}

static char *line_of(const struct summary *summary)
{
  char *line;
  size_t length;
  FILE *stream = open_memstream(&line, &length);
  summary_print(summary, stream);
  fclose(stream);
  return line;
}

static void assert_holds(const char *text, const char *part)
{
  cr_assert_not_null(strstr(text, part), "'%s' is in: %s", part, text);
}

static void assert_starts(const char *text, const char *start)
{
  cr_assert_eq(strncmp(text, start, strlen(start)), 0, "'%s' starts: %s", start, text);
}

Test(summary, run_json_has_the_figures)
{
  struct scene scene = some_scene();
  struct summary summary = some_summary(&scene);
  summary.report.times.seconds[STAGE_OUTPUT] = 0.25;
  char *json = run_json(&summary);
  assert_starts(json, "{\n  \"status\": \"done\",\n  \"steps\": 50,\n");
  assert_holds(json, "\n  \"mlups\": 0.0050000000000000001,\n");
  assert_holds(json, "\n  \"threads\": 3,\n  \"binding\": \"unbound\",\n  \"kernel\": \"plain\",\n  \"plan\": "
                     "\"16\",\n  \"precision\": "
                     "\"double\",\n  \"stages\": {\n");
  assert_holds(json, "\n    \"output\": 0.25\n  },\n  \"mass_drift\": 0.5,\n");
  assert_holds(json, "\n  \"title\": \"Title\"\n}\n");
}

Test(summary, a_figure_that_is_not_known_is_null_and_a_dash)
{
  struct scene scene = some_scene();
  struct summary summary = some_summary(&scene);
  assert_holds(run_json(&summary), "\"momentum_drift\": null,\n");
  assert_holds(line_of(&summary), " momentum_drift=- ");
}

Test(summary, only_a_run_that_is_not_done_has_a_message)
{
  struct scene scene = some_scene();
  struct summary summary = some_summary(&scene);
  cr_assert_null(strstr(run_json(&summary), "message"));
  summary.outcome = OUTCOME_DIVERGED;
  summary.message = "density is nan";
  assert_holds(run_json(&summary), "\"status\": \"diverged\",\n  \"message\": \"density is nan\",\n");
}

Test(summary, run_json_has_the_reason_for_every_end_and_a_warning_where_there_is_one)
{
  struct scene scene = some_scene();
  struct summary summary = some_summary(&scene);
  summary.reason = "all of run.steps are done";
  char *json = run_json(&summary);
  assert_holds(json, "\"status\": \"done\",\n  \"reason\": \"all of run.steps are done\",\n  \"steps\"");
  cr_assert_null(strstr(json, "warning"));
  summary.warning = "too fast";
  assert_holds(run_json(&summary), "\"reason\": \"all of run.steps are done\",\n  \"warning\": \"too fast\",\n");
  cr_assert_null(strstr(line_of(&summary), "too fast"));
}

Test(summary, text_is_escaped_for_json)
{
  struct scene scene = some_scene();
  struct summary summary = some_summary(&scene);
  scene.title = "a \"b\" \\ c/d\n\t\x01 µ € 😀";
  assert_holds(run_json(&summary), "\"title\": \"a \\\"b\\\" \\\\ c/d\\u000a\\u0009\\u0001 µ € 😀\"\n");
  scene.title = "\xff[\xc3]\xe0\x80\x80\xed\xa0\x80\xf4\x90\x80\x80\xc3";
  assert_holds(run_json(&summary),
               "\"title\": \"\\ufffd[\\ufffd]\\ufffd\\ufffd\\ufffd\\ufffd\\ufffd\\ufffd\\ufffd\\ufffd"
               "\\ufffd\\ufffd\\ufffd\"\n");
}

Test(summary, the_line_is_one_line_of_pairs)
{
  struct scene scene = some_scene();
  struct summary summary = some_summary(&scene);
  summary.outcome = OUTCOME_INTERRUPTED;
  summary.message = "two\nlines";
  char *line = line_of(&summary);
  const char *start =
      "delbm: status=interrupted steps=50 seconds=2 mlups=0.005 threads=3 kernel=plain plan=16 precision=double "
      "occupation=0 contact=0 exchange=0 sweep=0 boundary=0 output=0 mass_drift=0.5 momentum_drift=- ";
  assert_starts(line, start);
  cr_assert_eq(strchr(line, '\n'), line + strlen(line) - 1);
}

Test(summary, a_failed_write_keeps_the_earlier_file_and_leaves_no_other)
{
  struct scene scene = some_scene();
  struct summary summary = some_summary(&scene);
  write_file(in_scratch("file"), "");
  cr_assert_not(summary_write(&summary, in_scratch("file/run.json"), &status));
  cr_assert_eq(status.code, DELBM_IO);
  cr_assert(file_make_directory(in_scratch("run.json/in the way"), &status));
  cr_assert_not(summary_write(&summary, in_scratch("run.json"), &status));
  cr_assert_eq(status.code, DELBM_IO);
  cr_assert_neq(access(in_scratch("run.json/in the way"), F_OK), -1);
  cr_assert_eq(access(in_scratch("run.json.tmp"), F_OK), -1);
}

Test(progress, time_left_is_told_in_the_unit_that_suits_it)
{
  const struct {
    double seconds;
    const char *text;
  } cases[] = {{0, "0:00"},         {65.4, "1:05"},          {59.6, "1:00"},  {3599, "59:59"}, {7200, "2:00:00"},
               {86399, "23:59:59"}, {273906, "3d 04:05:06"}, {INFINITY, "-"}, {NAN, "-"},      {-1, "-"},
               {1e300, "-"}};
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
    char text[PROGRESS_TIME];
    progress_time(text, cases[k].seconds);
    cr_expect_str_eq(text, cases[k].text);
  }
}

/* Progress of a run of 1000 steps in steps of `chunk`. */
static char *lines_of_progress(enum progress_style style, int chunk)
{
  char *text;
  size_t length;
  FILE *stream = open_memstream(&text, &length);
  struct progress progress;
  progress_start(&progress, style, stream, 0, 1000, 1e4);
  for (int step = chunk; step <= 1000; step += chunk) progress_update(&progress, step);
  progress_finish(&progress, 1000);
  fclose(stream);
  return text;
}

Test(progress, lines_come_at_the_quarters)
{
  char *text = lines_of_progress(PROGRESS_LINES, 1);
  int count = 0;
  for (char *c = text; (c = strchr(c, '\n')); c++) count++;
  cr_assert_eq(count, 5, "%s", text);
  const char *const shares[] = {"  0 %  0/1000 ", " 25 %  250/", " 50 %  500/", " 75 %  750/", "100 %  1000/1000 "};
  for (int k = 0; k < 5; k++) assert_holds(text, shares[k]);
}

/* A resumed run counts only its own steps. */
Test(progress, speed_is_of_the_steps_since_the_start)
{
  char *text, *speed;
  size_t length;
  FILE *stream = open_memstream(&text, &length);
  struct progress progress;
  progress_start(&progress, PROGRESS_LINES, stream, 1000, 2000, 1e6);
  usleep(20000);
  progress_finish(&progress, 1001);
  fclose(stream);
  cr_assert((speed = strstr(text, "1001/2000  ")), "%s", text);
  const double mlups = strtod(speed + strlen("1001/2000  "), NULL); /* at most 1e6 cells in 0.02 s */
  cr_expect(mlups > 0 && mlups <= 50, "%s", text);
  free(text);
}

Test(progress, quiet_says_nothing)
{
  cr_assert_str_empty(lines_of_progress(PROGRESS_NONE, 10));
}

Test(progress, the_bar_stays_on_its_line_until_the_end)
{
  char *text = lines_of_progress(PROGRESS_BAR, 10);
  cr_assert_eq(strchr(text, '\n'), text + strlen(text) - 1);
  assert_holds(text, "\r[==============================] 100 %  1000/1000 ");
}

Test(recorder, the_next_step_is_the_first_that_is_due)
{
  struct scene scene = some_scene();
  struct recorder *recorder;
  bool replaced;
  scene.output.every = 15;
  cr_assert(recorder_open(&recorder, &scene, in_scratch("new/deep"), &replaced, &status), "%s", status.message);
  cr_assert_not(replaced);
  cr_assert_eq(recorder_next(recorder, 0), 15);
  cr_assert_eq(recorder_next(recorder, 14), 15);
  cr_assert_eq(recorder_next(recorder, 15), 30);
  cr_assert_eq(recorder_next(recorder, 90), 100);
  recorder_destroy(recorder);
  cr_assert_eq(access(in_scratch("new/deep/case.yaml"), F_OK), 0);
}

Test(recorder, an_earlier_run_is_removed_and_other_files_are_not)
{
  struct scene scene = some_scene();
  struct recorder *recorder;
  bool replaced;
  const char *const old[] = {"run.json", "particles.csv", "frames/00000000.png", "frames/123456789.png"};
  const char *const foreign[] = {"notes.txt", "frames/film.png", "frames/00000000.jpg"};
  cr_assert(file_make_directory(in_scratch("frames"), &status));
  for (int k = 0; k < 4; k++) write_file(in_scratch(old[k]), "old");
  for (int k = 0; k < 3; k++) write_file(in_scratch(foreign[k]), "kept");
  cr_assert(recorder_open(&recorder, &scene, scratch, &replaced, &status), "%s", status.message);
  recorder_destroy(recorder);
  cr_assert(replaced);
  for (int k = 0; k < 4; k++) cr_expect_eq(access(in_scratch(old[k]), F_OK), -1, "%s", old[k]);
  for (int k = 0; k < 3; k++) cr_expect_eq(access(in_scratch(foreign[k]), F_OK), 0, "%s", foreign[k]);
}

Test(recorder, a_folder_that_cannot_be_made_is_refused_with_the_system_s_reason)
{
  cr_assert_not(file_make_directory("/proc/no/such/folder", &status));
  cr_expect_eq(status.code, DELBM_IO);
  cr_expect_str_eq(status.message, "cannot make folder /proc/no: No such file or directory");
}

Test(recorder, a_folder_under_a_file_is_an_input_output_error)
{
  struct scene scene = some_scene();
  struct recorder *recorder;
  bool replaced;
  write_file(in_scratch("file"), "");
  cr_assert_not(recorder_open(&recorder, &scene, in_scratch("file/run"), &replaced, &status));
  cr_assert_eq(status.code, DELBM_IO);
  cr_assert_not_null(strstr(status.message, "Not a directory"), "%s", status.message);
  cr_assert_null(recorder);
}

#ifdef DELBM_PNG

#include <png.h>

/* A flow of `nx` x `ny` cells at rest, and two discs outside of it. */
struct some_flow {
  struct picture picture;
  struct some_discs discs;
  double *ux, *uy;
};

static struct picture *some_flow(struct some_flow *flow, int nx, int ny)
{
  size_t cells = (size_t)nx * (size_t)ny;
  flow->ux = calloc(cells, sizeof(double));
  flow->uy = calloc(cells, sizeof(double));
  struct discs *discs = some_discs(&flow->discs);
  for (int k = 0; k < DISCS; k++) discs->x[k] = -100;
  flow->picture = (struct picture){.size = {nx, ny}, .ux = flow->ux, .uy = flow->uy, .discs = discs};
  return &flow->picture;
}

/* A picture read back. */
struct read_back {
  png_image image;
  uint8_t *pixels;
};

static struct read_back read_back(const char *path)
{
  struct read_back back = {.image = {.version = PNG_IMAGE_VERSION}};
  cr_assert(png_image_begin_read_from_file(&back.image, path));
  back.image.format = PNG_FORMAT_RGB;
  back.pixels = malloc(PNG_IMAGE_SIZE(back.image));
  cr_assert(png_image_finish_read(&back.image, NULL, back.pixels, 0, NULL));
  return back;
}

static struct read_back draw(const struct picture *picture)
{
  char *path = in_scratch("frame.png");
  cr_assert(picture_write(picture, path, &status), "%s", status.message);
  return read_back(path);
}

/* The colour as 0xRRGGBB at pixel (x, y) from the lower left. */
static unsigned colour_at(const struct read_back *back, int x, int y)
{
  const uint8_t *pixel = back->pixels + 3 * ((back->image.height - 1 - (size_t)y) * back->image.width + (size_t)x);
  return (unsigned)pixel[0] << 16 | (unsigned)pixel[1] << 8 | pixel[2];
}

static int lightness(unsigned colour)
{
  return (int)(colour >> 16) + (int)(colour >> 8 & 0xff) + (int)(colour & 0xff);
}

static void assert_pixels(int nx, int ny, unsigned width, unsigned height)
{
  struct some_flow flow;
  struct read_back back = draw(some_flow(&flow, nx, ny));
  cr_assert_eq(back.image.width, width, "%u pixels for %d cells", back.image.width, nx);
  cr_assert_eq(back.image.height, height, "%u pixels for %d cells", back.image.height, ny);
}

Test(picture, has_one_pixel_a_cell_up_to_the_largest_picture)
{
  assert_pixels(400, 30, 400, 30);
  assert_pixels(30, 1600, 30, 1600);
}

Test(picture, of_a_large_domain_averages_squares_of_cells)
{
  assert_pixels(1601, 5, 801, 3);
  assert_pixels(10, 4001, 4, 1334);
}

Test(picture, of_a_small_domain_is_magnified)
{
  assert_pixels(399, 100, 798, 200);
  assert_pixels(1, 1, 800, 800);
}

Test(picture, shows_a_disc_in_its_colour_with_its_turned_mark_and_outline)
{
  struct some_flow flow;
  struct picture *picture = some_flow(&flow, 400, 300);
  struct discs *discs = &flow.discs.discs;
  discs->x[0] = 100;
  discs->y[0] = 50;
  struct read_back back = draw(picture);
  cr_assert_eq(colour_at(&back, 104, 54), PICTURE_MARK);
  cr_assert_eq(colour_at(&back, 95, 54), PICTURE_DISC);
  cr_assert_eq(colour_at(&back, 104, 45), PICTURE_DISC);
  cr_assert_lt(lightness(colour_at(&back, 109, 50)), lightness(PICTURE_MARK) / 2);
  discs->angle[0] = M_PI / 2;
  back = draw(picture);
  cr_assert_eq(colour_at(&back, 104, 54), PICTURE_DISC);
  cr_assert_eq(colour_at(&back, 95, 54), PICTURE_MARK);
}

/* The colours at the ends and in the middle of the scale of discs. */
enum { LOW = 0x3b5bff, MIDDLE = 0x35e27e, HIGH = 0xffffff };

Test(picture, of_discs_with_values_colours_each_by_its_own_and_leaves_out_the_mark)
{
  struct some_flow flow;
  struct picture *picture = some_flow(&flow, 400, 300);
  struct discs *discs = &flow.discs.discs;
  double values[DISCS] = {0, 3};
  for (int k = 0; k < DISCS; k++) {
    discs->x[k] = 100 + 100 * k;
    discs->y[k] = 50;
  }
  picture->values = values;
  picture->values_end = 3;
  struct read_back back = draw(picture);
  cr_expect_eq(colour_at(&back, 104, 54), LOW, "%06x, where a mark would be", colour_at(&back, 104, 54));
  cr_expect_eq(colour_at(&back, 200, 50), HIGH, "%06x", colour_at(&back, 200, 50));
  picture->values_end = 6;
  back = draw(picture);
  cr_expect_eq(colour_at(&back, 200, 50), MIDDLE, "%06x", colour_at(&back, 200, 50));
  /* without values_end the scale of the flow applies */
  picture->values_end = 0;
  picture->maximum = 6;
  back = draw(picture);
  cr_expect_eq(colour_at(&back, 200, 50), MIDDLE, "%06x", colour_at(&back, 200, 50));
}

/* Colour at a place after some steps, in a case with two driven discs: R = 8 from (100, 75) and R = 16 from (300, 150),
 * both rising at 0.1 cells/step, in a box 300 high. */
static unsigned colour_in_run(enum frame_discs kind, int64_t steps, int x, int y)
{
  struct scene scene = scene_box(400, 300, 0.05, SIDES_CLOSED);
  struct simulation *simulation;
  struct recorder *recorder;
  bool replaced;
  scene_add_disc(&scene, 8, 1, 100, 75);
  scene_add_disc(&scene, 16, 1, 300, 150);
  for (int k = 0; k < DISCS; k++) {
    scene.particles.discs[k].motion = DISC_DRIVEN;
    scene.particles.discs[k].velocity[1] = 0.1;
  }
  scene.title = scene.name = NULL;
  scene.run.steps = scene.output.frames.every = steps;
  scene.output.frames.discs = kind;
  scene.output.frames.maximum = 0.2;
  cr_assert(simulation_create(&simulation, &scene, &status), "%s", status.message);
  cr_assert(recorder_open(&recorder, &scene, scratch, &replaced, &status), "%s", status.message);
  cr_assert(simulation_advance(simulation, steps, &status), "%s", status.message);
  cr_assert(recorder_record(recorder, simulation, true, &status), "%s", status.message);
  recorder_destroy(recorder);
  simulation_destroy(simulation);
  scene_clear(&scene);
  char name[40];
  snprintf(name, sizeof name, "frames/%08d.png", (int)steps);
  struct read_back back = read_back(in_scratch(name));
  const unsigned colour = colour_at(&back, x, y);
  free(back.pixels);
  return colour;
}

Test(picture, of_a_run_shows_initial_heights_whenever_speeds_and_radii)
{
  const unsigned quarter = 0x22bdf5;
  cr_expect_eq(colour_in_run(FRAME_DISCS_HEIGHT, 10, 100, 76), quarter);
  cr_expect_eq(colour_in_run(FRAME_DISCS_HEIGHT, 200, 100, 95), quarter, "20 cells higher, in the colour of the start");
  cr_expect_eq(colour_in_run(FRAME_DISCS_HEIGHT, 10, 300, 151), MIDDLE);
  cr_expect_eq(colour_in_run(FRAME_DISCS_SPEED, 10, 100, 76), MIDDLE, "0.1 on the scale of speed, which ends at 0.2");
  cr_expect_eq(colour_in_run(FRAME_DISCS_RADIUS, 10, 100, 76), MIDDLE);
  cr_expect_eq(colour_in_run(FRAME_DISCS_RADIUS, 10, 300, 151), HIGH);
  cr_expect_eq(colour_in_run(FRAME_DISCS_PLAIN, 10, 97, 79), PICTURE_DISC);
}

Test(picture, shows_a_disc_across_a_periodic_side_on_both)
{
  struct some_flow flow;
  struct picture *picture = some_flow(&flow, 400, 300);
  flow.discs.discs.x[0] = 399;
  flow.discs.discs.y[0] = 50;
  struct read_back back = draw(picture);
  cr_assert_eq(colour_at(&back, 395, 54), PICTURE_DISC);
  cr_assert_neq(colour_at(&back, 4, 45), PICTURE_DISC);
  picture->periodic[0] = true;
  back = draw(picture);
  cr_assert_eq(colour_at(&back, 395, 54), PICTURE_DISC);
  cr_assert_eq(colour_at(&back, 4, 45), PICTURE_DISC);
}

Test(picture, is_lighter_where_the_flow_is_faster_and_has_y_upwards)
{
  struct some_flow flow;
  struct picture *picture = some_flow(&flow, 400, 300);
  for (int i = 0; i < 400; i++) flow.ux[i] = -0.1 * i / 399; /* in the lowest row alone */
  struct read_back back = draw(picture);
  cr_assert_lt(lightness(colour_at(&back, 300, 299)), 20);
  for (int i = 20; i < 400; i += 20)
    cr_assert_gt(lightness(colour_at(&back, i, 0)), lightness(colour_at(&back, i - 20, 0)));
}

Test(picture, has_the_colours_of_its_maximum)
{
  struct some_flow flow;
  struct picture *picture = some_flow(&flow, 400, 300);
  flow.uy[0] = 0.05;
  struct read_back own = draw(picture);
  picture->maximum = 0.1;
  struct read_back fixed = draw(picture);
  flow.uy[0] = 0.1;
  struct read_back full = draw(picture);
  cr_assert_eq(colour_at(&own, 0, 0), colour_at(&full, 0, 0));
  cr_assert_lt(lightness(colour_at(&fixed, 0, 0)), lightness(colour_at(&full, 0, 0)));
}

Test(picture, of_rigid_rotation_is_of_one_colour_and_of_its_sign)
{
  struct some_flow flow;
  struct picture *picture = some_flow(&flow, 400, 300);
  picture->quantity = FRAME_VORTICITY;
  picture->maximum = 0.004;
  for (int j = 0; j < 300; j++)
    for (int i = 0; i < 400; i++) {
      flow.ux[j * 400 + i] = -0.001 * j;
      flow.uy[j * 400 + i] = 0.001 * i;
    }
  struct read_back back = draw(picture);
  unsigned colour = colour_at(&back, 200, 150);
  cr_assert_gt(colour >> 16, colour & 0xff, "counter-clockwise is orange");
  cr_assert_eq(colour_at(&back, 0, 0), colour);
  cr_assert_eq(colour_at(&back, 399, 0), colour);
  cr_assert_eq(colour_at(&back, 399, 299), colour);
}

Test(picture, drawn_twice_has_the_same_bytes)
{
  struct some_flow flow;
  struct picture *picture = some_flow(&flow, 500, 300);
  flow.discs.discs.x[0] = 77.7;
  flow.discs.discs.y[0] = 33.3;
  for (int k = 0; k < 500 * 300; k++) flow.ux[k] = 0.1 * sin(0.001 * k);
  size_t first_length, second_length;
  draw(picture);
  char *first = contents(in_scratch("frame.png"), &first_length);
  draw(picture);
  char *second = contents(in_scratch("frame.png"), &second_length);
  cr_assert_eq(first_length, second_length);
  cr_assert_eq(memcmp(first, second, first_length), 0);
}

Test(picture, in_an_unwritable_place_is_an_input_output_error)
{
  struct some_flow flow;
  struct picture *picture = some_flow(&flow, 20, 20);
  write_file(in_scratch("file"), "");
  cr_assert_not(picture_write(picture, in_scratch("file/frame.png"), &status));
  cr_assert_eq(status.code, DELBM_IO);
  cr_assert_eq(access(in_scratch("frame.png.tmp"), F_OK), -1);
}

#endif
