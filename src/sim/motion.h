/* Contacts and motion: the forces of the pairs that occupation found and of the sides, the discs'
 * new velocities, their new places.
 *
 * The exchange has left each disc's response A^-1 and its change of velocity without contacts. Contacts add A^-1 J,
 * with J their impulse over the step. Stiff ones are followed in n sub-steps: within the step a disc accelerates at a
 * constant rate but for contacts, whose lens areas are exact, so that the last sub-step ends at the very velocity that
 * the solve gives for the impulse handed to it. n follows from the stiffest contact of the step; with n = 1 this is x'
 * = x + V'.
 *
 * One thread follows the contacts, in the order of the list; all of them finish the discs, each its own. Sides that are
 * not periodic act on discs as walls, so that none leaves the box. */
#ifndef DELBM_SIM_MOTION_H
#define DELBM_SIM_MOTION_H

#include "contact/law.h"
#include "contact/linked_cell.h"
#include "coupling/exchange.h"
#include "sim/plan.h"

static const uint32_t contact_with_side = UINT32_MAX;

struct contact {
  uint32_t a, b; /* discs; b may be contact_with_side */
  enum side_name side;
  double inverse_mass; /* 1/m_a + 1/m_b */
  double cells_area;
};

/* A disc within reach of a contact, followed through the sub-steps of one step. */
struct trial {
  uint32_t disc;
  double x, y, vx, vy, fx, fy;
};

struct motion {
  const struct scene *scene;
  struct plan plan;
  struct contact_law law;
  struct pair_list pairs;
  struct linked_cell linked; /* with search: linked-cell */
  struct contact *contacts;
  size_t contact_count, contact_capacity;
  struct trial *trials;
  size_t trial_count, trial_capacity;
  uint32_t *trial_of;  /* of each disc, or no_trial */
  int substeps;        /* of this step */
  double last_substep; /* length of the last sub-step; 0 before the first */
  int most_substeps;   /* of any step */
};

bool motion_create(struct motion *motion, const struct scene *scene, const struct plan *plan, const struct discs *discs,
                   struct status *status);
void motion_destroy(struct motion *motion);

/* Saves or restores what a step leaves to the next. */
bool motion_store(struct motion *motion, struct store *store, struct status *status);

/* The stage; called by all threads of a parallel region or outside of one. Fails when a disc's speed is not finite or
 * above Mach 0.6, or when memory runs out. */
void stage_contact(struct motion *motion, const struct occupation *occupation, struct exchange *exchange,
                   struct discs *discs, int64_t step, struct team *team);

#endif
