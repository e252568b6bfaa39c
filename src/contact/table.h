/* The contact table: one entry for each pair of discs, and for each disc and side, that may come into contact before the
 * pair list is built anew. Entries keep their state as long as the list; a new table takes over the states.
 *
 * Order. Structure of arrays; the pairs by (a, b), then the sides by (a, side). Entries are processed in blocks of
 * CONTACT_BLOCK; the entries of sides start with a block of their own. */
#ifndef DELBM_CONTACT_TABLE_H
#define DELBM_CONTACT_TABLE_H

#include "contact/law.h"
#include "contact/pairs.h"
#include "contact/state.h"

enum { CONTACT_BLOCK = BODY_PAIRS };

struct contact_table {
  size_t pairs, sides;        /* entries of each kind */
  size_t pair_blocks, blocks; /* side k is entry CONTACT_BLOCK pair_blocks + k */
  bool has_spin;              /* friction, lubrication, or shapes that are not round: impulses have torques */
  bool limited;               /* sub-steps may be too few for the forces: with a fixed number, or areas by cells */

  /* constants, [entry] */
  uint32_t *a, *b;                           /* discs; b from contact_sides on: a side */
  double *radius[2];                         /* a side: infinite */
  double *strength;                          /* of the spring (law_spring.h) */
  double *damper;                            /* eta; by rate: eta over the root of dF_s/d delta */
  double *inverse_mass;                      /* of relative motion, without fluid */
  double *slip_compliance, *roll_compliance; /* has_spin: c_t and c_r without fluid */
  double *friction;                          /* has_spin: Coulomb's coefficient; 0 at sides that are not walls */
  double *max_moment;                        /* has_spin: largest rolling torque over F_n */
  double *rolling_damper; /* has_spin: damping coefficient of rolling over the root of dF_s/d delta */

  /* states, [entry]: struct contact_state */
  double *stored, *impulse, *spring_impulse, *approach_speed, *shear, *shear_stiffness, *moment, *moment_stiffness;
  uint8_t *live; /* the state is not that of a new contact */

  /* of the step, [entry] */
  uint8_t *is_near;                      /* may act in the step */
  uint8_t *near;                         /* these entries of each block, counted from its first */
  double *cells_area;                    /* with area by cells */
  double *film;                          /* with lubrication: resistance (lubrication_block.h) */
  double *fx, *fy, *torque_a, *torque_b; /* impulse on b in the sub-step; torques (has_spin) about a and about b */

  uint8_t *near_count; /* [block] */

  /* The ends of entries by disc: of disc member[m], end[first[m]] .. end[first[m + 1] - 1] = 2 entry + (1 at b) */
  uint32_t *member, *end;
  size_t *first;
  size_t members;

  void *block, *ends; /* memory of the arrays of entries; of `end` */
  size_t block_capacity, end_capacity;
  size_t *count; /* [discs + 1] */
};

bool table_create(struct contact_table *table, size_t discs, struct status *status);
void table_destroy(struct contact_table *table);

/* Entries for the pairs of the list, and for sides with a gap below that of the list, with the saved states; by one
 * thread. Constants are set by table_fill. */
bool table_build(struct contact_table *table, const struct scene *scene, const struct discs *discs,
                 const struct pair_list *pairs, const struct contact_states *saved, struct status *status);

/* Sets the constants of the entries of a block. */
void table_fill(struct contact_table *table, const struct scene *scene, const struct discs *discs,
                const struct contact_law *law, size_t block);

/* Overlap of an entry at the discs' positions; negative: a gap. */
double table_depth(const struct contact_table *table, const struct scene *scene, const struct discs *discs, size_t e);

/* Replaces *states by the states of live entries. */
bool table_states(const struct contact_table *table, struct contact_states *states, struct status *status);

static inline size_t table_first(size_t block)
{
  return block * CONTACT_BLOCK;
}

/* Number of entries of a block. */
static inline int table_entries(const struct contact_table *t, size_t block)
{
  const size_t end = block < t->pair_blocks ? t->pairs : t->pair_blocks * CONTACT_BLOCK + t->sides;
  const size_t left = end - table_first(block);
  return left < CONTACT_BLOCK ? (int)left : CONTACT_BLOCK;
}

static inline bool table_is_of_sides(const struct contact_table *t, size_t block)
{
  return block >= t->pair_blocks;
}

#endif
