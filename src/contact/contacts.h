/* The contact stage: impulses over a step between discs, and between discs and sides (method: contacts.c). */
#ifndef DELBM_CONTACT_CONTACTS_H
#define DELBM_CONTACT_CONTACTS_H

#include "contact/contact_kernel.h"

/* The parts of the stage that a scene needs. */
struct contact_needs {
  bool pairs;    /* two discs, one of them free, can touch */
  bool sides;    /* a free disc can touch a side */
  bool substeps; /* more than one sub-step may be necessary */
};

struct contacts {
  const struct scene *scene;
  struct contact_needs needs;
  struct contact_law law;
  struct lubrication lubrication;
  double *films; /* [disc] with lubrication: sum of the resistances of its entries in the step */
  const struct contact_kernel *kernel;
  double within; /* gap from which an entry cannot act in the coming step */
  struct pair_list pairs;
  struct contact_table table;
  struct contact_states saved; /* states to be taken over by the next table */
  bool table_is_current;       /* the states are in the table, not in `saved` */
  bool placed; /* discs placed since the last step: new contacts start with the energy of their overlap */

  double *scratch; /* [thread][scratch_size] for areas by cells */
  size_t scratch_size, scratch_capacity;

  struct contact_rates rates; /* of this step */
  int substeps;               /* of this step */
  double last_substep;        /* length of the last sub-step; 0 before the first */
  uint8_t *is_moving;         /* [disc] by sub-steps */
  struct disc_motions at;     /* [disc], of moving discs */

  int max_substeps;     /* over all steps */
  double max_overlap;   /* over all steps: overlap over the smaller radius */
  bool leave;           /* decision after the table is built (team.h) */
  bool leave_too_stiff; /* decision after the sub-steps are counted */
};

static inline bool contacts_lubricate(const struct contacts *c)
{
  return c->lubrication.cutoff > 0;
}

bool contacts_create(struct contacts *contacts, const struct scene *scene, struct contact_needs needs,
                     const struct discs *discs, struct status *status);
void contacts_destroy(struct contacts *contacts);

/* Saves or restores the state between two steps, for `discs` discs. */
bool contacts_store(struct contacts *contacts, size_t discs, struct store *store, struct status *status);

/* To be called when the caller has placed discs. */
void contacts_placed(struct contacts *contacts);

/* Sets contact_fx, contact_fy and contact_torque of the discs; advances the positions in `at` by the sub-steps.
 * `occupation`: NULL with linked cells and area by lens. Called by all threads of a parallel region or outside of one.
 * Fails when memory runs out or more than 10^6 sub-steps are needed. */
bool stage_contact(struct contacts *contacts, const struct occupation *occupation, const struct exchange *exchange,
                   struct discs *discs, struct team *team);

/* Centre (x, y) and angle of disc i after the sub-steps; false for a disc without sub-steps. */
static inline bool contacts_moved(const struct contacts *c, size_t i, double place[3])
{
  if (c->substeps == 1 || !c->is_moving[i]) return false;
  place[0] = c->at.x[i];
  place[1] = c->at.y[i];
  place[2] = c->at.angle[i];
  return true;
}

#endif
