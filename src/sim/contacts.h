/* Contacts: the forces between discs that a search has found near each other, and of the sides; their impulse over the
 * step.
 *
 * The exchange has left each disc's response K and its change of velocity without contacts. Contacts add K J,
 * with J their impulse. Stiff ones are followed in n sub-steps: within the step a disc accelerates at a constant rate
 * but for contacts, whose lens areas are exact, so that the last sub-step ends at the very velocity that the solve
 * gives for the impulse handed to it. n follows from the stiffest contact of the step; with n = 1 discs stay where they
 * are and their motion (sim/motion.h) does all.
 *
 * Each contact keeps an account (contact/account.h), from step to step in contact_memory.h, that holds it to giving back no
 * more than it took. Areas by cells are known once a step: in sub-steps they are followed as those of lenses.
 *
 * Each contact's impulse is written to the contact, by whichever thread has it, and one thread then adds them to the
 * discs in the order of the list: no races, and the same bits for any number of threads. A short list is followed by
 * one thread alone, which does the same in the same order. Sides that are not periodic act on discs as walls, so that
 * none leaves the box. */
#ifndef DELBM_SIM_CONTACTS_H
#define DELBM_SIM_CONTACTS_H

#include "contact/law.h"
#include "contact/linked_cell.h"
#include "sim/meeting.h"
#include "sim/stages.h"

struct contacts {
  const struct scene *scene;
  struct stages plan;
  struct contact_law law;
  struct pair_list pairs;
  struct linked_cell linked; /* with search: linked-cell */
  struct contact *list;      /* pairs, then sides */
  size_t count, capacity;
  int substeps; /* of this step */

  struct contact_memory memory;
  bool placed; /* discs have just been put where they are: a new contact holds the energy of its overlap */

  /* with sub-steps: the discs that are followed through them */
  uint32_t *followed;
  size_t followed_count;
  uint8_t *is_followed;   /* [disc] */
  struct places within;   /* of followed discs only */
  struct wrench *impulse; /* [disc] in a sub-step */
  double last_substep;    /* length of the last sub-step; 0 before the first */
  int most_substeps;      /* of any step */
  bool leave;             /* after the search (team.h) */
};

bool contacts_create(struct contacts *contacts, const struct scene *scene, const struct stages *plan,
                     const struct discs *discs, struct status *status);
void contacts_destroy(struct contacts *contacts);

/* Saves or restores what a step leaves to the next, for so many discs. */
bool contacts_store(struct contacts *contacts, size_t discs, struct store *store, struct status *status);

/* Discs have been put elsewhere than they came by themselves. */
void contacts_placed(struct contacts *contacts);

/* The stage: leaves the discs' contact_fx and contact_fy, and where sub-steps have brought them. Called by all threads of
 * a parallel region or outside of one. Fails when memory runs out, or contacts need more sub-steps than
 * a case may ask for. */
bool stage_contact(struct contacts *contacts, const struct occupation *occupation, const struct exchange *exchange,
                   struct discs *discs, struct team *team);

#endif
