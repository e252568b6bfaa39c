#include "cli/commands.h"
#include "cli/report.h"
#include "cli/tables.h"

#include "output/file.h"

static bool write_json(const struct analysis *analysis, const char *path, struct status *status)
{
  struct replacement file;
  if (!replacement_begin(&file, path, status)) return false;
  analysis_json(analysis, file.stream);
  return replacement_commit(&file, status);
}

static bool report(const struct analysis *analysis, const struct arguments *arguments, struct status *status)
{
  analysis_print(analysis, stdout);
  if (arguments->json && !write_json(analysis, arguments->json, status)) return false;
  return !arguments->tables || !analysis->has_settling ||
         tables_write(&analysis->settling, *arguments->operands, status);
}

static int analyse(struct arguments *arguments)
{
  struct status status;
  struct analysis analysis;
  if (!analysis_create(&analysis, &arguments->scene, *arguments->operands, &status)) return report_error(&status);
  const bool ok = report(&analysis, arguments, &status);
  analysis_destroy(&analysis);
  return ok ? DELBM_OK : report_error(&status);
}

const struct command command_analyse = {
    .name = "analyse",
    .purpose = "report what the discs of a finished run did",
    .operand_name = "DIR",
    .operand = OPERAND_RESULTS,
    .about =
        "Reports what a run's discs did, from case.yaml, particles.csv and run.json in DIR, one figure a line:\n"
        "\n"
        "  one free disc        terminal speed, drag, Reynolds and Strouhal numbers             body.*\n"
        "  fixed, driven discs  drag, lift and torque, mean of each, Reynolds number            body.*\n"
        "  two discs settling   times and speeds of drafting, kissing and tumbling              pair.*\n"
        "  many discs settling  interface, sediment, concentration, mixing                      settling.*\n"
        "\n"
        "Speeds of body.* are relative to the fluid: to the stream of an inlet, to fluid at rest where walls close "
        "the\n"
        "box, else to the mean velocity of the fluid at the end of the run. The terminal speed is the mean over the\n"
        "last part of the way, of five diameters or more, whose thirds agree within 0.5 %. Where there is no terminal "
        "speed or "
        "no\n"
        "sediment yet, or where forces on fixed or driven discs are not steady, a line that begins with # says so.",
    .options = {{"json", "FILE", "also writes the figures, and the series of settling, to FILE", .kind = OPTION_TEXT,
                 .target = offsetof(struct arguments, json)},
                {"tables", NULL,
                 "also writes the series of settling to DIR/settling.csv (interface, sediment's surface, Lacey's\n"
                 "mixing index, mean height of five bands) and DIR/profile.csv (by height: concentration, mixing\n"
                 "index lambda)",
                 .kind = OPTION_FLAG, .target = offsetof(struct arguments, tables)},
                {"help", NULL, "this text", .kind = OPTION_HELP}},
    .run = analyse,
};
