/* Contacts: the forces between discs that a search has found near each other, and of the sides; their impulse over the
 * step.
 *
 * The exchange has left each disc's response A^-1 and its change of velocity without contacts. Contacts add A^-1 J,
 * with J their impulse. Stiff ones are followed in n sub-steps: within the step a disc accelerates at a constant rate
 * but for contacts, whose lens areas are exact, so that the last sub-step ends at the very velocity that the solve
 * gives for the impulse handed to it. n follows from the stiffest contact of the step; with n = 1 discs stay where they
 * are and their motion (sim/motion.h) does all.
 *
 * Each contact's force is written to the contact, by whichever thread has it, and one thread then adds them to the
 * discs in the order of the list: no races, and the same bits for any number of threads. A short list is followed by
 * one thread alone, which does the same in the same order. Sides that are not periodic act on discs as walls, so that
 * none leaves the box. */
#ifndef DELBM_SIM_CONTACTS_H
#define DELBM_SIM_CONTACTS_H

#include "contact/law.h"
#include "contact/linked_cell.h"
#include "coupling/exchange.h"
#include "sim/plan.h"

static const uint32_t contact_with_side = UINT32_MAX;

struct contact {
  uint32_t a, b; /* discs; b may be contact_with_side */
  enum side_name side;
  double inverse_mass; /* 1/m_a + 1/m_b; 0: nothing to do */
  double damping;      /* eta */
  double cells_area;
  double fx, fy; /* on b in this sub-step; on a the opposite */
};

/* Where discs are within a step: [disc]. */
struct places {
  double *x, *y, *vx, *vy;
};

struct contacts {
  const struct scene *scene;
  struct plan plan;
  struct contact_law law;
  struct pair_list pairs;
  struct linked_cell linked; /* with search: linked-cell */
  struct contact *list;      /* pairs, then sides */
  size_t count, capacity;
  int substeps; /* of this step */

  /* with sub-steps: the discs that are followed through them */
  uint32_t *followed;
  size_t followed_count;
  uint8_t *is_followed; /* [disc] */
  struct places within; /* of followed discs only */
  double *fx, *fy;      /* [disc] force in a sub-step */
  double last_substep;  /* length of the last sub-step; 0 before the first */
  int most_substeps;    /* of any step */
};

bool contacts_create(struct contacts *contacts, const struct scene *scene, const struct plan *plan,
                     const struct discs *discs, struct status *status);
void contacts_destroy(struct contacts *contacts);

/* Saves or restores what a step leaves to the next. */
bool contacts_store(struct contacts *contacts, struct store *store, struct status *status);

/* The stage: leaves the discs' contact_fx and contact_fy, and where sub-steps have brought them. Called by all threads of
 * a parallel region or outside of one. Fails when memory runs out, or contacts need more sub-steps than
 * a case may ask for. */
bool stage_contact(struct contacts *contacts, const struct occupation *occupation, const struct exchange *exchange,
                   struct discs *discs, struct team *team);

#endif
