/* Runs at the limits of the method. Each writes the files of `delbm run` to a scratch folder, which are checked for
 * NAN and infinity. */
#ifndef DELBM_BENCH_EDGE_H
#define DELBM_BENCH_EDGE_H

#include "map.h"
#include "sim/simulation.h"

/* Context of all runs of a benchmark. */
struct edge {
  const struct bench_report *report;
  char folder[64];
  int runs, diverged;
};

bool edge_open(struct edge *edge, const struct bench_report *report, struct status *status);
void edge_close(struct edge *edge);

/* Called at the start and every `every` steps; the run ends when it returns false. */
typedef bool edge_watch(struct simulation *simulation, void *context);

struct edge_run {
  int64_t steps, every;
  edge_watch *watch;
  void *context;
  /* result */
  bool diverged;
  int64_t end;
  struct simulation_report last;
};

/* Fails unless the run completes or reports where it diverged, and if a file contains a NAN or an infinity. */
bool edge_run(struct edge *edge, struct scene *scene, struct edge_run *run, struct status *status);

/* A choice of the rates s_e and s_q, direct or by the magic parameter. */
struct edge_operator {
  const char *name;
  double e;     /* 0: s_nu */
  double q;     /* 0: s_nu, or from magic */
  double magic; /* 0: the member q */
  double fast;  /* s_q of fast fluid; 0: q at every speed */
};

enum { EDGE_OPERATORS = 6 };
extern const struct edge_operator edge_operators[EDGE_OPERATORS];
struct rates edge_rates(const struct edge_operator *choice, double viscosity);

/* Maps of one file edge_*.c. */
typedef bool edge_maps(struct edge *edge, struct status *status);
edge_maps edge_fluid, edge_discs, edge_contacts, edge_crowds;

#endif
