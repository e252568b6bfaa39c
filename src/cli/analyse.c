#include "cli/commands.h"
#include "cli/options.h"
#include "cli/tables.h"

#include "output/file.h"

#include <stdlib.h>

enum { OPTION_JSON = OPTION_OWN, OPTION_TABLES };

const struct option analyse_options[] = {{"json", required_argument, NULL, OPTION_JSON},
                                         {"tables", no_argument, NULL, OPTION_TABLES},
                                         {"help", no_argument, NULL, OPTION_HELP},
                                         {0}};

static void print_help(void)
{
  puts(
      "usage: delbm analyse DIR [--json FILE] [--tables]\n"
      "\n"
      "Reports what a run's discs did, from case.yaml, particles.csv and run.json in DIR, one figure a line:\n"
      "\n"
      "  one free disc        terminal speed, drag, Reynolds and Strouhal numbers             body.*\n"
      "  held discs           drag, lift and torque, mean of each, Reynolds number            body.*\n"
      "  two discs settling   times and speeds of drafting, kissing and tumbling              pair.*\n"
      "  many discs settling  interface, sediment, concentration, mixing                      settling.*\n"
      "\n"
      "Speeds of body.* are relative to the fluid: to the stream of an inlet, to fluid at rest where walls close the\n"
      "box, else to the mean velocity of the fluid at the end of the run. The terminal speed is the mean over the\n"
      "last stretch of five diameters or more whose thirds agree within 0.5 %. Where there is no terminal speed or no\n"
      "sediment yet, or where forces on held discs are not steady, a line that begins with # says so.\n"
      "\n"
      "  --json FILE  also writes the figures, and the series of settling, to FILE\n"
      "  --tables     also writes the series of settling to DIR/settling.csv (interface, sediment's surface, Lacey's\n"
      "               mixing index, mean height of five bands) and DIR/profile.csv (by height: concentration, mixing\n"
      "               index lambda)\n"
      "  --help       this text");
}

struct request {
  const char *directory;
  const char *json; /* NULL: none */
  bool tables;
};

static bool write_json(const struct analysis *analysis, const char *path, struct status *status)
{
  struct replacement file;
  if (!replacement_begin(&file, path, status)) return false;
  analysis_json(analysis, file.stream);
  return replacement_commit(&file, status);
}

static bool report(const struct analysis *analysis, const struct request *request, struct status *status)
{
  analysis_print(analysis, stdout);
  if (request->json && !write_json(analysis, request->json, status)) return false;
  return !request->tables || !analysis->has_settling || tables_write(&analysis->settling, request->directory, status);
}

static int analyse_scene(const struct scene *scene, const struct request *request)
{
  struct status status;
  struct analysis analysis;
  if (!analysis_create(&analysis, scene, request->directory, &status)) return report_error(&status);
  const bool ok = report(&analysis, request, &status);
  analysis_destroy(&analysis);
  return ok ? DELBM_OK : report_error(&status);
}

int command_analyse(int argc, char **argv)
{
  struct request request = {0};
  for (int option; (option = option_next(argc, argv, analyse_options)) != OPTION_END;) {
    if (option == OPTION_HELP) print_help();
    if (option == OPTION_HELP) return DELBM_OK;
    if (option == OPTION_BAD) return DELBM_USAGE;
    if (option == OPTION_JSON) request.json = optarg;
    if (option == OPTION_TABLES) request.tables = true;
  }
  request.directory = option_operand(argc, argv, "DIR");
  if (!request.directory) return DELBM_USAGE;
  struct scene scene = {0};
  const struct settings none = {0};
  int code = read_case(&scene, request.directory, &none, NULL);
  if (code == DELBM_OK) code = analyse_scene(&scene, &request);
  scene_clear(&scene);
  return code;
}
