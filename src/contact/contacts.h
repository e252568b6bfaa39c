/* The contact stage: forces between discs, and of the sides on discs, and their impulse over the step. The method stands in
 * contacts.c. */
#ifndef DELBM_CONTACT_CONTACTS_H
#define DELBM_CONTACT_CONTACTS_H

#include "contact/law.h"
#include "contact/pairs.h"

/* What of the stage a scene needs. */
struct contact_needs {
  bool pairs;    /* two discs, one of them free, can touch */
  bool sides;    /* a free disc can touch a side */
  bool substeps; /* contacts may be stiff enough to need several sub-steps */
};

struct contact;

struct contacts {
  const struct scene *scene;
  struct contact_needs needs;
  struct contact_law law;
  double within; /* gap from which on a contact cannot act in the coming step */
  struct pair_list pairs;
  struct contact *list; /* those that may act: pairs, then sides */
  size_t count, capacity;
  int substeps; /* of this step */

  struct contact_states states;
  bool placed; /* discs have just been put where they are: new contacts hold the energy of their overlap */

  double *scratch; /* areas by cells: of each thread */
  size_t scratch_size, scratch_capacity;

  /* the discs of contacts in the list, as they are in sub-steps */
  uint32_t *moving;
  size_t moving_count;
  uint8_t *is_moving;     /* [disc] */
  struct disc_motions at; /* of those discs */
  struct wrench *impulse; /* [disc] in a sub-step */
  double last_substep;    /* length of the last sub-step; 0 before the first */
  int max_substeps;       /* of any step */
  bool leave;             /* after the list is made (team.h) */
};

bool contacts_create(struct contacts *contacts, const struct scene *scene, struct contact_needs needs,
                     const struct discs *discs, struct status *status);
void contacts_destroy(struct contacts *contacts);

/* Saves or restores what a step leaves to the next, for so many discs. */
bool contacts_store(struct contacts *contacts, size_t discs, struct store *store, struct status *status);

/* Discs have been put elsewhere than they came by themselves. */
void contacts_placed(struct contacts *contacts);

/* Fills the discs' contact_fx, contact_fy and contact_torque, and moves discs through sub-steps. Called by all threads of a
 * parallel region or outside of one. Fails when memory runs out, or contacts need more sub-steps than a case may ask for. */
bool stage_contact(struct contacts *contacts, const struct occupation *occupation, const struct exchange *exchange,
                   struct discs *discs, struct team *team);

/* Where disc i is at the end of a step through sub-steps; false where it took none. */
static inline bool contacts_moved(const struct contacts *c, size_t i, double position[2])
{
  if (c->substeps == 1 || !c->is_moving[i]) return false;
  position[0] = c->at.x[i];
  position[1] = c->at.y[i];
  return true;
}

#endif
