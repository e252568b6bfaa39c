/* The arithmetic of the contact stage: passes over a block of the contact table, compiled per instruction set
 * (contact_block.c, with the equations). */
#ifndef DELBM_CONTACT_CONTACT_KERNEL_H
#define DELBM_CONTACT_CONTACT_KERNEL_H

#include "contact/lubrication.h"
#include "contact/substeps.h"
#include "contact/table.h"
#include "coupling/exchange.h"

/* [disc] */
struct disc_motions {
  double *x, *y, *angle, *vx, *vy, *omega;
};

/* Arguments of a pass. */
struct contact_pass {
  struct contact_table *table;
  const struct scene *scene;
  const struct contact_law *law;
  const struct shape_kind *kind;
  const struct response *response; /* [disc] */
  struct disc_motions at;
  double within;                         /* gap below which an entry may act in the step */
  double moved;                          /* length of the last sub-step, by which the discs have moved */
  double h;                              /* length of this sub-step */
  double duration;                       /* of the impulse */
  bool has_cells;                        /* areas by cells */
  const struct lubrication *lubrication; /* NULL: none */
  const double *films;                   /* [disc] with lubrication: sum of the resistances of its entries */
};

struct contact_kernel {
  /* Lists the near entries of a block, and resets the state of the others. */
  void (*select)(const struct contact_pass *pass, size_t block);
  /* Rates of the near entries, at the largest overlap that each may reach in the step. */
  void (*rates)(const struct contact_pass *pass, size_t block, struct contact_rates *max);
  /* With lubrication: resistances of the near entries, 0 of others. */
  void (*films)(const struct contact_pass *pass, size_t block);
  /* Impulses of the near entries over pass->duration; raises *max_overlap to the largest overlap over the
   * smaller radius. */
  void (*impulses)(const struct contact_pass *pass, size_t block, double *max_overlap);
};

/* Kernel for the instruction set, as in solid_kernel_find. */
const struct contact_kernel *contact_kernel_find(const char *name);

#endif
