/* Runs at the edge of what the method can do, each with the files that `delbm run` would write, in a scratch folder, and
 * looked through for what is not a number. */
#ifndef DELBM_BENCH_EDGE_H
#define DELBM_BENCH_EDGE_H

#include "map.h"
#include "sim/simulation.h"

/* What all runs of a benchmark share. */
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
  /* how it ended */
  bool diverged;
  int64_t end;
  struct simulation_report last;
};

/* Fails when the run ended by anything but its end or an error that says where it diverged, or when a file holds what
 * is not a number. */
bool edge_run(struct edge *edge, struct scene *scene, struct edge_run *run, struct status *status);

/* Choices of the rates: s_e and s_q, or what they follow from. */
struct edge_operator {
  const char *name;
  double e;     /* 0: s_nu */
  double q;     /* 0: s_nu, or from magic */
  double magic; /* 0: q as given */
  double fast;  /* q of fast fluid; 0: q everywhere */
};

enum { EDGE_OPERATORS = 6 };
extern const struct edge_operator edge_operators[EDGE_OPERATORS];
struct rates edge_rates(const struct edge_operator *choice, double viscosity);

/* The maps, one file per kind of edge. */
typedef bool edge_maps(struct edge *edge, struct status *status);
edge_maps edge_fluid, edge_discs, edge_contacts, edge_crowds;

#endif
