#include "bench.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* The processor's name as Linux has it, or "unknown". */
static void processor_name(char *name, size_t size)
{
  char line[256];
  FILE *file = fopen("/proc/cpuinfo", "r");
  snprintf(name, size, "unknown");
  while (file && fgets(line, sizeof line, file)) {
    const char *colon = strchr(line, ':');
    if (strncmp(line, "model name", 10) != 0 || !colon) continue;
    snprintf(name, size, "%s", colon + 2);
    name[strcspn(name, "\n\"\\")] = '\0';
    break;
  }
  if (file) fclose(file);
}

void bench_describe_machine(const struct bench_report *report)
{
  char name[256];
  const char *bind = getenv("OMP_PROC_BIND"), *places = getenv("OMP_PLACES");
  processor_name(name, sizeof name);
  printf("%s, %d threads, OMP_PROC_BIND=%s, OMP_PLACES=%s, compiled by %s\n", name, omp_get_max_threads(),
         bind ? bind : "unset", places ? places : "unset", __VERSION__);
  if (report->json)
    fprintf(report->json,
            "\"machine\": {\"processor\": \"%s\", \"threads\": %d, \"compiler\": \"%s\", \"flags\": \"%s\"}", name,
            omp_get_max_threads(), __VERSION__, DELBM_FLAGS);
}
